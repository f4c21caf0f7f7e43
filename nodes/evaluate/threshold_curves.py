"""What a blend space costs and how far it is off, against its threshold."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.blend.corresponding_poses import chosen_takes, corresponding_poses
from reperform.nodes.blend.pair_frames import Pace
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.hybrid_blend import HybridFields
from reperform.nodes.kernels.hybrid_build import build_hybrid, nonlinear_blends, stored_bytes
from reperform.nodes.kernels.mesh_geometry import vertex_areas
from reperform.nodes.product import Dataset
from reperform.nodes.products.blend_measures import ThresholdCurves
from reperform.nodes.products.mesh import MeshSequence


@node(over="dataset", memory=2.0)
def threshold_curves(
    meshes: Dataset[MeshSequence],
    *,
    takes: Annotated[tuple[str, ...], Param("", about="the takes to blend, in order; none: all")] = (),
    epsilons: Annotated[tuple[float, ...], Param("m", 0.0, 1.0, "thresholds tried")] = (
        0.0,
        0.001,
        0.002,
        0.003,
        0.004,
        0.005,
        0.006,
        0.008,
        0.010,
        0.015,
        0.020,
        0.030,
    ),
    levels: Annotated[
        int, Param("1", 1, 6, "levels tried: 1, ..., levels; level L has 2^L - 1 corrections")
    ] = 3,
    pace: Annotated[Pace, Param(about="how frames of the takes correspond")] = "stretched",
) -> ThresholdCurves:
    """Largest error over all poses and weights, bytes, and the share of the surface that is corrected.

    `corrected` is the area of the first pose's vertices that have a correction, averaged over poses and
    corrections.

    Raises ValueError as blend.hybrid does.
    Source: 004 figs 3.10b, 3.11b and 3.12; 001 fig 4.
    """  # fmt: skip
    blended = chosen_takes(meshes, takes, "evaluate.threshold_curves")
    poses = corresponding_poses(blended, pace, True, "evaluate.threshold_curves")
    faces = np.asarray(next(iter(blended.values())).faces)
    exact = nonlinear_blends(poses, faces)
    known: dict[bytes, np.ndarray] = {}

    def remembered(weights: np.ndarray) -> np.ndarray:
        key = weights.tobytes()
        if key not in known:
            known[key] = exact(weights)
        return known[key]

    area = vertex_areas(poses[0, 0].astype(np.float64), faces)
    error, stored, dense, corrected = (np.zeros((levels, len(epsilons))) for _ in range(4))
    for level in range(levels):
        for k, epsilon in enumerate(epsilons):
            built = build_hybrid(poses, remembered, epsilon, level + 1, level + 1)
            error[level, k] = built.error.max()
            stored[level, k], dense[level, k] = stored_bytes(built.fields)
            corrected[level, k] = _share(built.fields, area)
    references = 2 ** np.arange(1, levels + 1, dtype=np.int32) - 1
    return ThresholdCurves(np.array(epsilons), references, error, stored, dense[:, 0], corrected)


def _share(fields: HybridFields, area: np.ndarray) -> float:
    begin = np.concatenate([[0.0], np.cumsum(np.repeat(area / 3.0, 3))])
    last = fields.first + np.diff(fields.begin)
    return float((begin[last] - begin[fields.first]).sum() / (area.sum() * fields.step.size))
