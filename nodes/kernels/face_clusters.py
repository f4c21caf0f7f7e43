"""Faces in clusters that move much alike, and poses of clusters in place of poses of faces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from reperform.nodes.kernels.deformation_metric import Poses, Reference, angle_of_chord, turns
from reperform.nodes.kernels.mesh_geometry import face_cross

# metres that a normal counts as in the distance between faces: it keeps apart what is close but faces away
_NORMAL = 0.1


class ClusterPoses(NamedTuple):
    """Poses of clusters, with what each frame may be wrong by."""

    rotation: np.ndarray  # (T, 4, K) float32: mean rotation from the reference, w x y z
    ground: np.ndarray  # as in Poses
    bound: np.ndarray  # (T,) radians


def bisect_faces(vertices: np.ndarray, faces: np.ndarray, count: int) -> np.ndarray:
    """A cluster for each face, (F,) int32 in 0 .. count - 1, of about equal area.

    vertices (V, 3), m; faces (F, 3); count is cut to the number of faces. The part with the most area is split,
    until there are enough, at the area's median along the principal axis of (centre, 0.1 m times normal).
    """
    points = np.asarray(vertices, np.float64)
    cross = face_cross(points, faces)
    area = np.maximum(np.linalg.norm(cross, axis=1), 1e-15)
    place = np.hstack([points[faces].mean(axis=1), _NORMAL * cross / area[:, None]])
    parts = [np.arange(len(faces))]
    total = [float(area.sum())]
    for _ in range(min(count, len(faces)) - 1):
        sizes = [t if len(p) > 1 else -1.0 for t, p in zip(total, parts, strict=True)]
        largest = int(np.argmax(sizes))
        part = parts[largest]
        weight = area[part]
        away = place[part] - weight @ place[part] / weight.sum()
        axis = np.linalg.eigh((away * weight[:, None]).T @ away)[1][:, -1]
        order = np.argsort(away @ axis, kind="stable")
        summed = np.cumsum(weight[order])
        cut = int(np.clip(np.searchsorted(summed, 0.5 * summed[-1]) + 1, 1, len(part) - 1))
        parts[largest], more = part[order[:cut]], part[order[cut:]]
        parts.append(more)
        total[largest] = float(area[parts[largest]].sum())
        total.append(float(area[more].sum()))
    label = np.empty(len(faces), np.int32)
    for k, part in enumerate(parts):
        label[part] = k
    return label


def cluster_poses(
    poses: Poses, reference: Reference, label: np.ndarray, stretch_weight: float
) -> ClusterPoses:
    """The area-weighted mean rotation of each cluster, and the bound of what it hides.

    For frames i, j with `bound` e: |d(i, j) - d~(i, j)| <= e_i + e_j. By the triangle inequality for rotations
    each face is off by at most its angles to the means, by the turn that two stretches leave in a plane (at
    most asin(h_i h_j), h = (1 - r) / (1 + r), r the ratio of the stretches), and by its stretch, which is left
    out: at most sqrt(3) (exp(l_i + l_j) - 1) with l the largest log stretch.
    """
    rotation, bound = _means(
        poses.faces, reference.frame, label.astype(np.int32), reference.area, int(label.max()) + 1, stretch_weight
    )  # fmt: skip
    return ClusterPoses(rotation, poses.ground, bound)


def cluster_areas(reference: Reference, label: np.ndarray) -> np.ndarray:
    """The share of the area that each cluster has, (K,) float32."""
    return np.bincount(label, weights=reference.area.astype(np.float64)).astype(np.float32)


def cluster_distances(a: ClusterPoses, b: ClusterPoses, area: np.ndarray) -> np.ndarray:
    """d~(i, j) = sum over clusters of area times the angle between mean rotations, (Ta, Tb) float64, radians."""
    yaw = turns(a.ground, b.ground)
    return _distances(a.rotation, b.rotation, np.cos(0.5 * yaw), np.sin(0.5 * yaw), area)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _distances(
    p: np.ndarray, q: np.ndarray, cosine: np.ndarray, sine: np.ndarray, area: np.ndarray
) -> np.ndarray:
    out = np.empty((len(p), len(q)))
    one = np.float32(1.0)
    for i in range(len(p)):
        for j in range(len(q)):
            c, s = np.float32(cosine[i, j]), np.float32(sine[i, j])
            total = np.float32(0.0)
            for k in range(len(area)):
                w, x = c * q[j, 0, k] - s * q[j, 2, k], c * q[j, 1, k] + s * q[j, 3, k]
                y, z = c * q[j, 2, k] + s * q[j, 0, k], c * q[j, 3, k] - s * q[j, 1, k]
                dot = w * p[i, 0, k] + x * p[i, 1, k] + y * p[i, 2, k] + z * p[i, 3, k]
                sign = one if dot >= np.float32(0.0) else -one
                dw, dx = w - sign * p[i, 0, k], x - sign * p[i, 1, k]
                dy, dz = y - sign * p[i, 2, k], z - sign * p[i, 3, k]
                total += area[k] * angle_of_chord(dw * dw + dx * dx + dy * dy + dz * dz)
            out[i, j] = total
    return out


@njit(cache=True, nogil=True)
def _means(
    poses: np.ndarray, frame: np.ndarray, label: np.ndarray, area: np.ndarray, count: int, stretch_weight: float
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    frames, faces = len(poses), len(label)
    out, bound = np.zeros((frames, 4, count), np.float32), np.zeros(frames)
    turned, mean, guide = np.empty((faces, 4)), np.empty((count, 4)), np.empty((count, 4))
    biggest = np.empty(count)
    for t in range(frames):
        biggest[:] = -1.0
        for f in range(faces):
            # q times the conjugate of the reference's frame
            w, x, y, z = poses[t, 0, f], poses[t, 1, f], poses[t, 2, f], poses[t, 3, f]
            a, b, c, d = frame[f, 0], -frame[f, 1], -frame[f, 2], -frame[f, 3]
            turned[f, 0], turned[f, 1] = w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c
            turned[f, 2], turned[f, 3] = w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a
            if area[f] > biggest[label[f]]:
                biggest[label[f]] = area[f]
                guide[label[f]] = turned[f]
        for _ in range(2):
            mean[:] = 0.0
            for f in range(faces):
                k, dot = label[f], 0.0
                for n in range(4):
                    dot += turned[f, n] * guide[k, n]
                signed = area[f] if dot >= 0.0 else -area[f]
                for n in range(4):
                    mean[k, n] += signed * turned[f, n]
            for k in range(count):
                norm = np.sqrt(mean[k, 0] ** 2 + mean[k, 1] ** 2 + mean[k, 2] ** 2 + mean[k, 3] ** 2)
                for n in range(4):
                    guide[k, n] = mean[k, n] / norm if norm > 1e-12 else guide[k, n]
        for k in range(count):
            for n in range(4):
                out[t, n, k] = guide[k, n]
        for f in range(faces):
            dot = 0.0
            for n in range(4):
                dot += turned[f, n] * guide[label[f], n]
            off = 2.0 * np.arccos(min(1.0, abs(dot)))
            u11, u12, u22 = poses[t, 4, f], poses[t, 5, f], poses[t, 6, f]
            half, spread = 0.5 * (u11 + u22), np.sqrt((0.5 * (u11 - u22)) ** 2 + u12 * u12)
            share = min(1.0, spread / half)
            least = max(half - spread, 1e-6)
            stretch = max(np.log(half + spread), -np.log(least))
            off += 0.5 * np.arcsin(share * share)
            off += stretch_weight * 0.5 * np.sqrt(3.0) * (np.exp(2.0 * min(stretch, 10.0)) - 1.0)
            bound[t] += area[f] * off
    return out, bound
