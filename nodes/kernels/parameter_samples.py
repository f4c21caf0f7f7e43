"""The map from blend weights to motion parameters, measured on blends."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from reperform.nodes.kernels.blend_ready import ReadyBlends
from reperform.nodes.kernels.control_cells import blend_weights, framed
from reperform.nodes.kernels.mesh_blend import MeshBlender
from reperform.nodes.kernels.motion_parameters import Travelled, measure
from reperform.nodes.kernels.parameter_map import (
    Method,
    ParameterMap,
    controls_at,
    invert,
    orientation,
    sample_cells,
)  # fmt: skip
from reperform.nodes.kernels.space_inputs import SpaceInputs

# samples to an edge of a cell for 1, 2, 3 parameters: weights 0.05 apart (0.1 in three dimensions)
PARTS = {1: 20, 2: 20, 3: 10}
_PROBES = 200
# a smaller cell may not be flatter than this share of the mean
_FOLD = 1e-3

Sampler = Callable[[np.ndarray], np.ndarray]


def reach_marker(vertices: np.ndarray, hand: int) -> tuple[int, int]:
    """The vertex that reaches and the pose at which it does: where inputs (N, K, V, 3) differ most."""
    spread = vertices.var(axis=0).sum(axis=-1)
    vertex = hand if hand >= 0 else int(np.argmax(spread.max(axis=0)))
    return vertex, int(np.argmax(spread[:, vertex]))


def measured_map(
    inputs: SpaceInputs,
    faces: np.ndarray,
    parameters: Sequence[str],
    marker: tuple[int, int],
    hands: tuple[int, int],
    nonlinear: bool,
) -> Sampler:
    """Parameters (S, d) of blends by weights (S, N); hands: the vertices that reach_width lies between."""
    travelled = Travelled(
        inputs.motion, inputs.seconds, inputs.vertices[..., 1].mean(axis=2, dtype=np.float64)
    )
    vertex, pose = marker
    reaching = vertex >= 0
    posed = [np.ascontiguousarray(mesh, np.float64) for mesh in inputs.vertices[:, max(pose, 0)]]
    blends = ReadyBlends(MeshBlender.build(posed[0], faces), posed) if reaching and nonlinear else None

    def sample(weights: np.ndarray) -> np.ndarray:
        marks = np.zeros((3, len(weights), 3))
        if blends is not None:
            marks = np.stack([blends.at(row)[[vertex, *hands]] for row in weights], axis=1)
        elif reaching:
            marks = np.stack([weights @ np.stack(posed)[:, mark] for mark in (vertex, *hands)])
        reached, *gripping = marks
        columns = [
            np.linalg.norm(gripping[0] - gripping[1], axis=1)
            if name == "reach_width"
            else measure(name, travelled, weights, reached, pose)
            for name in parameters
        ]
        return np.stack(columns, axis=1)

    return sample


def check_invertible(
    sampler: Sampler,
    control: np.ndarray,
    corners: np.ndarray,
    parameters: Sequence[str],
    method: Method,
    who: str,
) -> tuple[np.ndarray, np.ndarray, ParameterMap]:
    """Sampled weights (S, N), parameters (S, d) and the inverse map.

    Raises ValueError where the map folds: two different blends would do the same.
    """
    weights, controls, small = sample_cells(control, corners, PARTS[control.shape[1]])
    values = sampler(weights)
    span = np.ptp(values, axis=0)
    share = orientation((values - values.min(axis=0)) / span, small) / orientation(controls, small)
    if (share <= _FOLD * abs(share.mean())).any():
        where = controls[small[int(np.argmin(share))]].mean(axis=0)
        raise ValueError(
            f"{who}: the map from weights to {', '.join(parameters)} cannot be inverted: it folds at control "
            f"{', '.join(f'{u:.2f}' for u in where)} (0 lowest, 1 highest), where different blends do the same; leave "
            "out takes that repeat a value, or choose other parameters"
        )
    return weights, values, invert(method, values, controls, small)


def inverse_error(
    sampler: Sampler, control: np.ndarray, corners: np.ndarray, table: ParameterMap
) -> np.ndarray:
    """|f(f^-1(p)) - p| over the range at blends between the samples: (d, 2) mean, greatest."""
    d = control.shape[1]
    cells = framed(control, corners)
    rng = np.random.default_rng(0)
    shares = rng.dirichlet(np.ones(d + 1), _PROBES)
    chosen = cells.corners[rng.integers(0, len(corners), _PROBES)]
    weights = np.zeros((_PROBES, len(control)))
    np.put_along_axis(weights, chosen.astype(np.int64), shares, axis=1)
    wanted = sampler(weights)
    found, scratch, controls = np.zeros_like(weights), np.empty(d + 1), np.empty(d)
    for k in range(_PROBES):
        controls_at(wanted[k], table, controls)
        blend_weights(controls, cells, scratch, found[k])
    error = np.abs(sampler(found) - wanted) / (table.upper - table.lower)
    return np.stack([error.mean(axis=0), error.max(axis=0)], axis=1)
