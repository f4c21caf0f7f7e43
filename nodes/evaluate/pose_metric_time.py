"""What comparing poses by deformation gradients costs, face by face and by clusters."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.deformation_metric import exact_distances, prepare, reference_pose
from reperform.nodes.kernels.face_clusters import (
    bisect_faces,
    cluster_areas,
    cluster_distances,
    cluster_poses,
)
from reperform.nodes.kernels.mesh_geometry import vertex_areas
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence


@node(over="dataset", memory=1.0, volatile=True)
def pose_metric_time(
    meshes: Dataset[MeshSequence],
    *,
    clusters: Annotated[int, Param("1", 1, 20000, "groups of faces")] = 400,
    repeats: Annotated[int, Param("1", 1, 100, "runs of each, alternating; the fastest counts")] = 7,
) -> Measures:
    """Time per pair of prepared poses over all frames of the first two takes, one core.

    Entries `exact` and `clusters` (s per pair), `speedup` (their ratio), and what is done once per frame: `prepare`
    and `cluster` (s per frame). Clusters are made of the same prepared poses.

    Source: definition.
    """
    takes = [np.asarray(take.vertices) for take in list(meshes.values())[:2]]
    faces = np.asarray(next(iter(meshes.values())).faces)
    first = takes[0][0]
    reference = reference_pose(first, faces, vertex_areas(first, faces))
    label = bisect_faces(first, faces, clusters)
    area = cluster_areas(reference, label)
    poses = [prepare(vertices, reference) for vertices in takes]
    means = [cluster_poses(p, reference, label, 0.01) for p in poses]
    best = _fastest(
        [
            lambda: exact_distances(poses[0], poses[-1], reference.area, 0.01),
            lambda: cluster_distances(means[0], means[-1], area),
            lambda: prepare(takes[0], reference),
            lambda: cluster_poses(poses[0], reference, label, 0.01),
        ],
        repeats,
    )
    pairs, frames = len(takes[0]) * len(takes[-1]), len(takes[0])
    exact, quick = best[0] / pairs, best[1] / pairs
    values = [exact, quick, exact / quick, best[2] / frames, best[3] / frames]
    names = ["exact", "clusters", "speedup", "prepare", "cluster"]
    return Measures(np.array([values]), np.array(names), np.array(["s", "s", "1", "s", "s"]))


def _fastest(calls: list[Callable[[], object]], repeats: int) -> list[float]:
    """Seconds of the fastest run of each; the first, which compiles, does not count."""
    best = [np.inf] * len(calls)
    for run in range(repeats + 1):
        for k, call in enumerate(calls):
            start = time.perf_counter()
            call()
            if run > 0:
                best[k] = min(best[k], time.perf_counter() - start)
    return best
