"""What blending does to pairs of poses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane import align, apply
from reperform.nodes.kernels.hybrid_blend import HybridFields, evaluate, linear_into, new_scratch
from reperform.nodes.kernels.hybrid_build import build_hybrid
from reperform.nodes.kernels.mesh_blend import MeshBlender
from reperform.nodes.kernels.mesh_geometry import edges, volume
from reperform.nodes.products.blend_measures import BlendErrors, PosePairs

METHODS = ("linear", "hybrid R=1", "hybrid R=3", "non-linear")
Blend = Callable[[float], np.ndarray]


@node(over="dataset")
def blend_errors(
    pairs: PosePairs,
    *,
    steps: Annotated[int, Param("1", 2, 1000, "weights tried: 0, 1 / steps, ..., 1")] = 40,
) -> BlendErrors:
    """Linear, hybrid (one and three corrections) and non-linear blends of every pair, against each other.

    Errors are distances of corresponding vertices to the non-linear blend, m; `size` is the larger vertical extent
    of both poses. Volumes and edge lengths are held against (1 - w) of the first pose's plus w of the second's.
    Hybrid corrections are kept on all vertices, in int16 codes.

    Raises ValueError where a pair's meshes do not fit their faces.
    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 table 1; 004 table 3.1 and fig 3.9).
    """
    weights = np.linspace(0.0, 1.0, steps + 1)
    faces = np.asarray(pairs.faces)
    measured = [
        _measure(first, second, middle, faces, weights)
        for first, second, middle in zip(
            np.asarray(pairs.first), np.asarray(pairs.second), np.asarray(pairs.middle), strict=True
        )
    ]
    by_weight, ends, truths, sizes = (np.array([row[k] for row in measured]) for k in range(4))
    return BlendErrors(
        pair=np.asarray(pairs.name),
        method=np.array(METHODS),
        weight=weights,
        vertices=np.asarray(pairs.first.shape[1], np.int32),
        size=sizes,
        average=by_weight[..., 0],
        largest=by_weight[..., 1],
        rms=by_weight[..., 2],
        volume=by_weight[..., 3],
        strain=by_weight[..., 4],
        end=ends,
        truth=truths,
    )


def blends(first: np.ndarray, second: np.ndarray, faces: np.ndarray) -> dict[str, Blend]:
    """The methods as functions of the second pose's weight."""
    blender = MeshBlender.build(first, faces)
    pair = blender.pair(first, second)
    found: dict[str, Blend] = {}
    for method, levels in zip(METHODS[1:3], (1, 2), strict=True):
        fields = hybrid_of_pair(blender, first, second, levels)
        found[method] = lambda w, fields=fields: _written(evaluate, fields, w, new_scratch(fields))  # type: ignore[misc]
    found[METHODS[0]] = lambda w: _written(linear_into, fields, w)
    found[METHODS[3]] = lambda w: blender.at(pair, w)
    return {method: found[method] for method in METHODS}


def hybrid_of_pair(blender: MeshBlender, first: np.ndarray, second: np.ndarray, levels: int) -> HybridFields:
    """Corrections of two poses on all vertices, 2^levels - 1 of them."""
    pair = blender.pair(first, second)
    inputs = np.stack([first, second])[:, None]
    return build_hybrid(inputs, lambda w: blender.blend(pair, w)[None], 0.0, levels, levels, "int16").fields


def _written(
    function: Callable[..., None], fields: HybridFields, weight: float, *scratch: np.ndarray
) -> np.ndarray:
    out = np.empty((fields.inputs.shape[2] // 3, 3), np.float32)
    function(fields, 0, np.array([1.0 - weight, weight]), out, *scratch)
    return out


def _measure(
    first: np.ndarray, second: np.ndarray, middle: np.ndarray, faces: np.ndarray, weights: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    methods = list(blends(first, second, faces).values())
    made = np.array([[blend(w) for w in weights.tolist()] for blend in methods], np.float64)
    gap = np.linalg.norm(made - made[-1], axis=3)
    v, e = _interpolated(volume, first, second, faces, weights), edges(faces)
    lengths = _interpolated(_lengths, first, second, e, weights)
    by_weight = np.stack(
        [
            gap.mean(axis=2),
            gap.max(axis=2),
            np.sqrt(np.square(gap).mean(axis=2)),
            np.abs(volume(made, faces) / v - 1.0),
            np.abs(_lengths(made, e) / np.maximum(lengths, 1e-12) - 1.0).mean(axis=2),
        ],
        axis=-1,
    )
    end = np.linalg.norm(made[:, [0, -1]] - np.stack([first, second]), axis=3).max(axis=(1, 2))
    truth = np.full((len(methods), 2), np.nan)
    if np.isfinite(middle).all():
        halves = [blend(0.5).astype(np.float64) for blend in methods]
        off = [
            np.linalg.norm(apply(middle.astype(np.float64), align(h, middle)[0]) - h, axis=1) for h in halves
        ]
        truth = np.array([[distance.mean(), distance.max()] for distance in off])
    return by_weight, end, truth, float(max(np.ptp(first[:, 1]), np.ptp(second[:, 1])))


def _lengths(points: np.ndarray, ends: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(points[..., ends[:, 0], :] - points[..., ends[:, 1], :], axis=-1))


def _interpolated(
    quantity: Callable[[np.ndarray, np.ndarray], np.ndarray],
    first: np.ndarray,
    second: np.ndarray,
    topology: np.ndarray,
    weights: np.ndarray,
) -> np.ndarray:
    a, b = quantity(first.astype(np.float64), topology), quantity(second.astype(np.float64), topology)
    return np.asarray(np.multiply.outer(1.0 - weights, a) + np.multiply.outer(weights, b))
