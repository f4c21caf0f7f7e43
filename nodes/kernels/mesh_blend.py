"""Blending meshes of one topology: linearly, or by rotation and stretch of every face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse
from numba import njit
from scipy.sparse.linalg import SuperLU

from reperform.nodes.kernels.laplacian import factorise
from reperform.nodes.kernels.mesh_geometry import face_areas

# Pull towards the linear blend, relative to the mean diagonal: it holds what differences leave free (the
# place of each connected piece) and is too weak to bend anything.
_HOLD = 1e-8
# Bounds of the cotangent weights, so that slivers neither rule nor let go.
_WEIGHT = (0.05, 5.0)
# Neighbouring faces whose rotations differ by less than this are sure of their branch, radians.
_ALIKE = 0.5


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
class PosePair:
    """Two meshes made ready to be blended at many weights."""

    first: np.ndarray
    second: np.ndarray
    # per face: rotation and stretch of each mesh from the reference, and the rotation vector between them
    rotation: np.ndarray
    turn: np.ndarray
    stretch: np.ndarray
    other_stretch: np.ndarray


@dataclass(frozen=True)
class MeshBlender:
    """What one topology needs to blend: built once, then called."""

    faces: np.ndarray
    # edge vectors and unit normal of each reference face as columns, and the inverse of that matrix
    frame: np.ndarray
    inverse_frame: np.ndarray
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
        u, v = points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]
        normal = np.cross(u, v)
        solid = face_areas(points, faces) > 1e-12
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
        frame = np.stack([u, v, normal], axis=2)
        frame[~solid] = np.eye(3)
        weights = _edge_weights(points, faces) * solid[:, None]
        matrix = _weighted_laplacian(faces, weights, len(points))
        hold = _HOLD * float(matrix.diagonal().mean())
        factor = factorise(matrix + hold * scipy.sparse.eye(len(points)))
        return cls(faces, frame, np.linalg.inv(frame), weights, _face_neighbours(faces), factor, hold)

    def pair(self, first: np.ndarray, second: np.ndarray, near: PosePair | None = None) -> PosePair:
        """Take two poses (V, 3) of the topology apart into rotations and stretches of their faces.

        The rotation between them is a rotation vector per face whose branch is that of its neighbours, spread
        from the face that turns least: what turns by more than half a turn turns the same way everywhere.
        near: a pair a frame earlier or later; branches are then those of its faces, so that nothing flips from
        frame to frame.
        """
        a, b = np.ascontiguousarray(first, np.float64), np.ascontiguousarray(second, np.float64)
        rotation, stretch = _decompose(a, self.faces, self.inverse_frame)
        other, other_stretch = _decompose(b, self.faces, self.inverse_frame)
        turn = _relative_turn(rotation, other)
        if near is None:
            _unwrap(turn, self.neighbours)
        else:
            _follow(turn, near.turn)
        return PosePair(first, second, rotation, turn, stretch, other_stretch)

    def at(self, pair: PosePair, weight: float) -> np.ndarray:
        """The blended mesh (V, 3): `first` at weight 0 and `second` at weight 1.

        Per face F(w) = R_a exp(w log(R_a^T R_b)) ((1 - w) S_a + w S_b); then the vertices whose edges come
        closest to F(w) e_reference in weighted least squares. The centroid of every connected piece is that
        of the linear blend.
        """
        linear = (1.0 - weight) * pair.first.astype(np.float64) + weight * pair.second.astype(np.float64)
        right = _divergence(
            self.faces, self.weights, self.frame, pair.rotation, pair.turn, pair.stretch,
            pair.other_stretch, weight, len(linear),
        )  # fmt: skip
        return self.factor.solve(right + self.hold * linear).astype(pair.first.dtype)


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
def _decompose(
    points: np.ndarray, faces: np.ndarray, inverse_frame: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Rotation (F, 4), a unit quaternion, and symmetric stretch (F, 3, 3) of each face from the reference."""
    count = len(faces)
    rotation, stretch = np.empty((count, 4)), np.empty((count, 3, 3))
    gradient, frame, r, scratch = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for f in range(count):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        for k in range(3):
            frame[k, 0] = points[b, k] - points[a, k]
            frame[k, 1] = points[c, k] - points[a, k]
        frame[0, 2] = frame[1, 0] * frame[2, 1] - frame[2, 0] * frame[1, 1]
        frame[1, 2] = frame[2, 0] * frame[0, 1] - frame[0, 0] * frame[2, 1]
        frame[2, 2] = frame[0, 0] * frame[1, 1] - frame[1, 0] * frame[0, 1]
        norm = np.sqrt(frame[0, 2] ** 2 + frame[1, 2] ** 2 + frame[2, 2] ** 2)
        for k in range(3):
            frame[k, 2] /= max(norm, 1e-30)
        _product(frame, inverse_frame[f], gradient)
        _closest_rotation(gradient, r, scratch)
        to_quaternion(r, rotation[f])
        _to_matrix(rotation[f], r)
        for i in range(3):
            for j in range(3):
                stretch[f, i, j] = (
                    r[0, i] * gradient[0, j] + r[1, i] * gradient[1, j] + r[2, i] * gradient[2, j]
                )
    return rotation, stretch


@njit(cache=True, nogil=True)
def _product(a: np.ndarray, b: np.ndarray, out: np.ndarray) -> None:
    for i in range(3):
        for j in range(3):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]


@njit(cache=True, nogil=True)
def _closest_rotation(matrix: np.ndarray, r: np.ndarray, c: np.ndarray) -> None:
    """Polar factor by Newton's iteration with Higham's scaling; gradients with unit normals have det > 0."""
    r[:] = matrix
    change = 1.0
    for _ in range(30):
        for i in range(3):
            p, q = (i + 1) % 3, (i + 2) % 3
            for j in range(3):
                s, t = (j + 1) % 3, (j + 2) % 3
                c[i, j] = r[p, s] * r[q, t] - r[p, t] * r[q, s]
        det = r[0, 0] * c[0, 0] + r[0, 1] * c[0, 1] + r[0, 2] * c[0, 2]
        if det < 1e-30:
            r[:] = np.eye(3)
            return
        square, inverse_square = 0.0, 0.0
        for i in range(3):
            for j in range(3):
                c[i, j] *= 1.0 / det
                square += r[i, j] * r[i, j]
                inverse_square += c[i, j] * c[i, j]
        # near a rotation the plain iteration converges quadratically
        gamma = 1.0 if change < 0.1 else np.sqrt(np.sqrt(inverse_square / square))
        change = 0.0
        for i in range(3):
            for j in range(3):
                new = 0.5 * (gamma * r[i, j] + c[i, j] / gamma)
                change += (new - r[i, j]) * (new - r[i, j])
                r[i, j] = new
        if change < 1e-18:
            return


@njit(cache=True, nogil=True)
def to_quaternion(r: np.ndarray, q: np.ndarray) -> None:
    """Write the unit quaternion (w, x, y, z) of the rotation matrix r into q, up to its sign."""
    trace = r[0, 0] + r[1, 1] + r[2, 2]
    if trace > 0.0:
        q[0] = 1.0 + trace
        q[1], q[2], q[3] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    else:
        i = 0
        if r[1, 1] > r[0, 0]:
            i = 1
        if r[2, 2] > r[i, i]:
            i = 2
        j, k = (i + 1) % 3, (i + 2) % 3
        q[0] = r[k, j] - r[j, k]
        q[1 + i] = 1.0 + r[i, i] - r[j, j] - r[k, k]
        q[1 + j], q[1 + k] = r[j, i] + r[i, j], r[k, i] + r[i, k]
    norm = np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    for k in range(4):
        q[k] /= norm


@njit(cache=True, nogil=True)
def _to_matrix(q: np.ndarray, r: np.ndarray) -> None:
    w, x, y, z = q[0], q[1], q[2], q[3]
    r[0, 0], r[0, 1], r[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    r[1, 0], r[1, 1], r[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    r[2, 0], r[2, 1], r[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@njit(cache=True, nogil=True)
def _multiply(p: np.ndarray, q: np.ndarray, out: np.ndarray) -> None:
    out[0] = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]
    out[1] = p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2]
    out[2] = p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1]
    out[3] = p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]


@njit(cache=True, nogil=True)
def _relative_turn(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Rotation vectors of first^-1 second, angle in [0, pi], (F, 3)."""
    out, inverse, q = np.empty((len(first), 3)), np.empty(4), np.empty(4)
    for f in range(len(first)):
        inverse[0] = first[f, 0]
        for k in range(1, 4):
            inverse[k] = -first[f, k]
        _multiply(inverse, second[f], q)
        sign = -1.0 if q[0] < 0.0 else 1.0
        sine = np.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
        scale = 2.0 if sine < 1e-12 else 2.0 * np.arctan2(sine, sign * q[0]) / sine
        for k in range(3):
            out[f, k] = sign * scale * q[k + 1]
    return out


@njit(cache=True, nogil=True)
def _nearest_branch(turn: np.ndarray, f: int, guide: np.ndarray, g: int) -> float:
    """Move turn[f] to the branch, axis (angle + 2 pi k), nearest to guide[g]; returns how far they are then apart.

    Branches beyond three quarters of a turn are left alone: there the axis is noise.
    """
    angle, along = 0.0, 0.0
    for k in range(3):
        angle += turn[f, k] * turn[f, k]
        along += turn[f, k] * guide[g, k]
    angle = np.sqrt(angle)
    if angle > 1e-9:
        turns = np.round((along / angle - angle) / (2 * np.pi))
        if turns != 0.0 and abs(angle + 2 * np.pi * turns) < 1.5 * np.pi:
            for k in range(3):
                turn[f, k] *= (angle + 2 * np.pi * turns) / angle
    apart = 0.0
    for k in range(3):
        apart += (turn[f, k] - guide[g, k]) ** 2
    return np.sqrt(apart)


@njit(cache=True, nogil=True)
def _follow(turn: np.ndarray, near: np.ndarray) -> None:
    """Move every rotation vector to the branch of the same face a frame away."""
    for f in range(len(turn)):
        _nearest_branch(turn, f, near, f)


@njit(cache=True, nogil=True)
def _unwrap(turn: np.ndarray, neighbours: np.ndarray) -> None:
    """Move every rotation vector to the branch of its neighbours, the most alike first.

    Faces are met from the one that turns least; those unlike the face they are met from wait until nobody alike
    is left, so that a few crumpled faces do not turn whole limbs the wrong way.
    """
    count = len(turn)
    seen = np.zeros(count, np.bool_)
    alike, unlike = np.empty(count, np.int32), np.empty((3 * count, 2), np.int32)
    square = np.empty(count)
    for f in range(count):
        square[f] = turn[f, 0] ** 2 + turn[f, 1] ** 2 + turn[f, 2] ** 2
    head, tail, waiting, last, found = 0, 0, 0, 0, 0
    while found < count:
        if waiting < last:
            start, guide = unlike[waiting, 0], unlike[waiting, 1]
            waiting += 1
            if seen[start]:
                continue
            _nearest_branch(turn, start, turn, guide)
        else:
            start = np.argmin(square)
        seen[start] = True
        square[start] = np.inf
        found += 1
        alike[tail] = start
        tail += 1
        while head < tail:
            f = alike[head]
            head += 1
            for side in range(3):
                g = neighbours[f, side]
                if g < 0 or seen[g]:
                    continue
                if _nearest_branch(turn, g, turn, f) < _ALIKE:
                    seen[g] = True
                    square[g] = np.inf
                    found += 1
                    alike[tail] = g
                    tail += 1
                else:
                    unlike[last, 0], unlike[last, 1] = g, f
                    last += 1


@njit(cache=True, nogil=True)
def _divergence(
    faces: np.ndarray,
    weights: np.ndarray,
    reference: np.ndarray,
    rotation: np.ndarray,
    turn: np.ndarray,
    stretch: np.ndarray,
    other_stretch: np.ndarray,
    weight: float,
    n: int,
) -> np.ndarray:
    """Right side of the normal equations: weighted blended edge vectors, gathered at their ends, (n, 3)."""
    out = np.zeros((n, 3))
    q, part, r = np.empty(4), np.empty(4), np.empty((3, 3))
    edge, e = np.empty(3), np.empty((3, 3))
    for f in range(len(faces)):
        angle = np.sqrt(turn[f, 0] ** 2 + turn[f, 1] ** 2 + turn[f, 2] ** 2)
        half = 0.5 * weight * angle
        scale = 0.5 * weight if angle < 1e-12 else np.sin(half) / angle
        part[0] = np.cos(half)
        for k in range(3):
            part[k + 1] = scale * turn[f, k]
        _multiply(rotation[f], part, q)
        _to_matrix(q, r)
        for side in range(2):
            for i in range(3):
                edge[i] = 0.0
                for j in range(3):
                    s = (1.0 - weight) * stretch[f, i, j] + weight * other_stretch[f, i, j]
                    edge[i] += s * reference[f, j, side]
            for i in range(3):
                e[side, i] = r[i, 0] * edge[0] + r[i, 1] * edge[1] + r[i, 2] * edge[2]
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        for k in range(3):
            ab, ca = weights[f, 0] * e[0, k], -weights[f, 2] * e[1, k]
            bc = weights[f, 1] * (e[1, k] - e[0, k])
            out[b, k] += ab - bc
            out[a, k] += ca - ab
            out[c, k] += bc - ca
    return out
