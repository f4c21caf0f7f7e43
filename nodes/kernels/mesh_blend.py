"""Blending meshes of one topology: linearly, or by rotation and stretch of every face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse
from numba import njit
from scipy.sparse.linalg import SuperLU

from reperform.nodes.kernels.face_poses import FaceFrames, decompose, face_frames
from reperform.nodes.kernels.laplacian import factorise
from reperform.nodes.kernels.quaternion import between, from_vector, multiply, to_matrix
from reperform.nodes.kernels.turn_branch import follow, relative_turns, unwrap

# Pull towards the linear blend, relative to the mean diagonal: it holds what differences leave free (the
# place of each connected piece) and is too weak to bend anything.
_HOLD = 1e-8
# Bounds of the cotangent weights, so that slivers neither rule nor let go.
_WEIGHT = (0.05, 5.0)
# The mean of more than two rotations: most steps, and the square of the step (radians) that is small enough.
_STEPS, _STILL = 12, 1e-16


def blend_linear(meshes: list[np.ndarray], weights: np.ndarray) -> np.ndarray:
    """Weighted mean of vertices: sum_i w_i x_i; a mesh of weight 1 comes back to the bit.

    meshes: N arrays (V, 3), m; weights: (N,) that sum to 1.
    """
    chosen = np.flatnonzero(weights == 1.0)
    if len(chosen):
        return meshes[int(chosen[0])].copy()
    total = sum(float(w) * x.astype(np.float64) for w, x in zip(weights, meshes, strict=True))
    return np.asarray(total).astype(meshes[0].dtype)


@dataclass(frozen=True)
class PoseSet:
    """N meshes made ready to be blended at many weights."""

    meshes: tuple[np.ndarray, ...]
    # which of them the rotations are counted from: the one nearest to all others
    anchor: int
    # per face: rotation of the anchor from the reference (F, 4), rotation vectors from there to every mesh
    # (N, F, 3) and stretches of every mesh (N, F, 3)
    rotation: np.ndarray
    turns: np.ndarray
    stretches: np.ndarray


@dataclass(frozen=True)
class MeshBlender:
    """What one topology needs to blend: built once, then called."""

    faces: np.ndarray
    frames: FaceFrames
    weights: np.ndarray
    neighbours: np.ndarray
    factor: SuperLU
    hold: float

    @classmethod
    def build(cls, reference: np.ndarray, faces: np.ndarray) -> MeshBlender:
        """Factor the operator of one topology.

        reference: (V, 3) any pose of it, m; faces: (F, 3).
        Raises ValueError where a face names a vertex that is not there.
        """
        points = np.ascontiguousarray(reference, np.float64)
        faces = np.ascontiguousarray(faces, np.int32)
        if len(faces) == 0 or faces.min() < 0 or faces.max() >= len(points):
            raise ValueError(
                f"blend: faces must name vertices 0 .. {len(points) - 1}, got {faces.shape} faces"
            )
        frames = face_frames(points, faces)
        weights = _edge_weights(points, faces) * frames.solid[:, None]
        matrix = _weighted_laplacian(faces, weights, len(points))
        hold = _HOLD * float(matrix.diagonal().mean())
        factor = factorise(matrix + hold * scipy.sparse.eye(len(points)))
        return cls(faces, frames, weights, _face_neighbours(faces), factor, hold)

    def poses(self, meshes: Sequence[np.ndarray], near: PoseSet | None = None) -> PoseSet:
        """Take N poses (V, 3) of the topology apart into rotations and stretches of their faces.

        Rotation vectors are counted from the pose nearest to all others, on the branch of neighbouring faces,
        spread from the face that turns least: what turns by more than half a turn turns the same way everywhere.
        near: the same poses a frame earlier or later; branches are then those of its faces, so that nothing
        flips from frame to frame.
        Raises ValueError where a mesh has other vertices than the topology, or there is none.
        """
        _check_meshes(meshes, near, self.factor.shape[0])
        parts = [
            decompose(np.ascontiguousarray(mesh, np.float64), self.faces, self.frames.axes, self.frames.edges)
            for mesh in meshes
        ]
        rotations = [rotation for rotation, _ in parts]
        anchor = _nearest_to_all(rotations) if near is None else near.anchor
        turns = np.zeros((len(meshes), len(self.faces), 3))
        for k, rotation in enumerate(rotations):
            if k == anchor:
                continue
            turns[k] = relative_turns(rotations[anchor], rotation)
            if near is None:
                unwrap(turns[k], self.neighbours)
            else:
                follow(turns[k], near.turns[k])
        stretches = np.stack([stretch for _, stretch in parts])
        return PoseSet(tuple(meshes), anchor, rotations[anchor], turns, stretches)

    def blend(self, poses: PoseSet, weights: np.ndarray) -> np.ndarray:
        """The blended mesh (V, 3) at weights (N,) that sum to 1.

        Per face F(w) = R(w) sum_i w_i S_i, where R(w) is the mean rotation: sum_i w_i log(R(w)^T R_i) = 0 (for
        two poses R_a exp(w log(R_a^T R_b))); then the vertices whose edges come closest to F(w) e_reference in
        weighted least squares. The centroid of every connected piece is that of the linear blend. The order of
        the poses has no say; poses of weight 0 have none either.

        Source: Moakher 2002, SIAM Journal on Matrix Analysis (mean of rotations).
        """
        weights = np.ascontiguousarray(weights, np.float64)
        linear = np.zeros(poses.meshes[0].shape)
        for weight, mesh in zip(weights.tolist(), poses.meshes, strict=True):
            linear += weight * mesh
        right = _divergence(
            self.faces, self.weights, self.frames.turn, self.frames.edges, poses.rotation, poses.turns,
            poses.stretches, weights, len(linear),
        )  # fmt: skip
        return self.factor.solve(right + self.hold * linear).astype(poses.meshes[0].dtype)

    def pair(self, first: np.ndarray, second: np.ndarray, near: PoseSet | None = None) -> PoseSet:
        """Two poses made ready: `poses` of both."""
        return self.poses((first, second), near)

    def at(self, pair: PoseSet, weight: float) -> np.ndarray:
        """The blended mesh (V, 3) of two poses: the first at weight 0 and the second at weight 1."""
        return self.blend(pair, np.array([1.0 - weight, weight]))


def _check_meshes(meshes: Sequence[np.ndarray], near: PoseSet | None, count: int) -> None:
    if len(meshes) == 0 or any(mesh.shape != (count, 3) for mesh in meshes):
        shapes = ", ".join(str(mesh.shape) for mesh in meshes) or "none"
        raise ValueError(f"blend: meshes must have the topology's ({count}, 3) vertices, got {shapes}")
    if near is not None and len(near.meshes) != len(meshes):
        raise ValueError(f"blend: near must hold {len(meshes)} poses as well, got {len(near.meshes)}")


def _nearest_to_all(rotations: Sequence[np.ndarray]) -> int:
    """Index of the pose from which all others turn least, summed over faces; of two, the first."""
    if len(rotations) < 3:
        return 0
    total = np.zeros((len(rotations), len(rotations)))
    for i, one in enumerate(rotations):
        for j, other in enumerate(rotations[:i]):
            cosine = np.minimum(np.abs(np.einsum("fk,fk->f", one, other)), 1.0)
            total[i, j] = total[j, i] = float(np.arccos(cosine).sum())
    return int(np.argmin(total.sum(axis=1)))


def _edge_weights(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Half the cotangent opposite each edge (01, 12, 20), kept positive: the operator must be definite."""
    columns = []
    for apex, one, two in ((2, 0, 1), (0, 1, 2), (1, 2, 0)):
        u = points[faces[:, one]] - points[faces[:, apex]]
        v = points[faces[:, two]] - points[faces[:, apex]]
        sine = np.linalg.norm(np.cross(u, v), axis=1)
        columns.append(0.5 * np.einsum("fk,fk->f", u, v) / np.maximum(sine, 1e-30))
    return np.clip(np.stack(columns, axis=1), *_WEIGHT)


def _weighted_laplacian(faces: np.ndarray, weights: np.ndarray, n: int) -> scipy.sparse.csr_matrix:
    i = faces[:, [0, 1, 2]].ravel()
    j = faces[:, [1, 2, 0]].ravel()
    half = scipy.sparse.coo_matrix((weights.ravel(), (i, j)), shape=(n, n)).tocsr()
    adjacency = half + half.T
    return scipy.sparse.diags(np.asarray(adjacency.sum(axis=1)).ravel()) - adjacency


def _face_neighbours(faces: np.ndarray) -> np.ndarray:
    """The face across each edge (01, 12, 20), (F, 3); -1 on a border or where more than two faces meet."""
    ends = np.sort(
        np.stack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]], axis=1).reshape(-1, 2), axis=1
    )
    _, edge, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(edge.ravel(), kind="stable")
    first = np.concatenate([[0], np.cumsum(count)[:-1]])
    twice = np.flatnonzero(count == 2)
    one, two = order[first[twice]], order[first[twice] + 1]
    across = np.full(len(ends), -1, np.int32)
    across[one], across[two] = two // 3, one // 3
    return across.reshape(-1, 3)


@njit(cache=True, nogil=True)
def _mean_rotation(
    anchor: np.ndarray,
    turns: np.ndarray,
    f: int,
    weights: np.ndarray,
    v: np.ndarray,
    work: np.ndarray,
    q: np.ndarray,
) -> None:
    """The quaternion q of face f's mean rotation: from the weighted mean of rotation vectors by Newton's steps."""
    blended = 0
    for k in range(3):
        v[k] = 0.0
    for i in range(len(weights)):
        blended += weights[i] != 0.0
        for k in range(3):
            v[k] += weights[i] * turns[i, f, k]
    from_vector(v, 1.0, work[0])
    multiply(anchor, work[0], q)
    if blended < 2 or len(weights) == 2:
        return
    step, side = work[1], work[2]
    for _ in range(_STEPS):
        for k in range(3):
            step[k] = 0.0
        for i in range(len(weights)):
            if weights[i] == 0.0:
                continue
            from_vector(turns[i, f], 1.0, work[0])
            multiply(anchor, work[0], work[3])
            between(q, work[3], side)
            _guided(side, turns[i, f], v)
            for k in range(3):
                step[k] += weights[i] * side[k]
        from_vector(step, 1.0, work[0])
        multiply(q, work[0], work[3])
        q[:] = work[3]
        for k in range(3):
            v[k] += step[k]
        if step[0] * step[0] + step[1] * step[1] + step[2] * step[2] < _STILL:
            return


@njit(cache=True, nogil=True)
def _guided(side: np.ndarray, turn: np.ndarray, mean: np.ndarray) -> None:
    """Move a rotation vector to the branch nearest to turn - mean."""
    angle, along = 0.0, 0.0
    for k in range(3):
        angle += side[k] * side[k]
        along += side[k] * (turn[k] - mean[k])
    angle = np.sqrt(angle)
    if angle > 1e-9:
        turns = np.round((along / angle - angle) / (2 * np.pi))
        for k in range(3):
            side[k] *= (angle + 2 * np.pi * turns) / angle


@njit(cache=True, nogil=True)
def _divergence(
    faces: np.ndarray,
    weights: np.ndarray,
    frame: np.ndarray,
    edges: np.ndarray,
    anchor: np.ndarray,
    turns: np.ndarray,
    stretches: np.ndarray,
    blend: np.ndarray,
    n: int,
) -> np.ndarray:
    """Right side of the normal equations: weighted blended edge vectors, gathered at their ends, (n, 3)."""
    out = np.zeros((n, 3))
    q, turned, r, v, work = np.empty(4), np.empty(4), np.empty((3, 3)), np.empty(3), np.empty((4, 4))
    for f in range(len(faces)):
        _mean_rotation(anchor[f], turns, f, blend, v, work, q)
        multiply(q, frame[f], turned)
        to_matrix(turned, r)
        s0, s1, s2 = 0.0, 0.0, 0.0
        for i in range(len(blend)):
            s0 += blend[i] * stretches[i, f, 0]
            s1 += blend[i] * stretches[i, f, 1]
            s2 += blend[i] * stretches[i, f, 2]
        x1, y1 = s0 * edges[f, 0], s1 * edges[f, 0]
        x2, y2 = s0 * edges[f, 1] + s1 * edges[f, 2], s1 * edges[f, 1] + s2 * edges[f, 2]
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        for k in range(3):
            one, two = r[k, 0] * x1 + r[k, 1] * y1, r[k, 0] * x2 + r[k, 1] * y2
            ab, ca = weights[f, 0] * one, -weights[f, 2] * two
            bc = weights[f, 1] * (two - one)
            out[b, k] += ab - bc
            out[a, k] += ca - ab
            out[c, k] += bc - ca
    return out
