"""Weights of a parametric space for what is asked of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.kernels.control_cells import blend_weights, framed
from reperform.nodes.kernels.parameter_map import ParameterMap, controls_at
from reperform.nodes.kernels.parameter_values import values_at
from reperform.nodes.products.parametric import ParametricSpace

# what is done may miss what is asked by this share of the range before it counts as out of reach
_MISS = 0.02


def parameter_table(space: ParametricSpace) -> ParameterMap:
    """The inverse map of a space, for kernels.parameter_map.controls_at."""
    fields = (space.lower, space.upper, space.grid, space.inverse)
    return ParameterMap(*(np.array(field) for field in fields))


def weights_for(space: ParametricSpace, wanted: Sequence[float]) -> np.ndarray:
    """Blend weights (N,) of the motion whose parameters are `wanted` (one each, in the space's units).

    What cannot be reached is done as nearly as the space can, unless the space refuses that.
    Raises ValueError where the number of parameters is wrong, or a value out of reach is refused.
    """
    names = [str(name) for name in np.asarray(space.parameters)]
    asked = np.array(wanted, np.float64)
    if asked.shape != (len(names),):
        raise ValueError(f"motion_graph.space: {', '.join(names)} are controlled, got {len(wanted)} values")
    control = np.empty(len(names))
    controls_at(asked, parameter_table(space), control)
    inputs = np.asarray(space.control, np.float64)
    weights = np.empty(len(inputs))
    blend_weights(control, framed(inputs, np.asarray(space.cells)), np.empty(len(names) + 1), weights)
    if bool(np.asarray(space.refuse)):
        _require_reached(space, names, asked, weights)
    return weights


def done(space: ParametricSpace, weights: np.ndarray) -> np.ndarray:
    """Parameters (S, d) of blends with weights (S, N), between those that were measured."""
    inputs = np.asarray(space.control)
    sampled, value = np.asarray(space.sample_weight) @ inputs, np.asarray(space.sample_value)
    return values_at(np.atleast_2d(weights) @ inputs, sampled, value)


def _require_reached(
    space: ParametricSpace, names: list[str], asked: np.ndarray, weights: np.ndarray
) -> None:
    lower, upper = np.asarray(space.lower), np.asarray(space.upper)
    nearest = done(space, weights)[0]
    if (np.abs(nearest - asked) > _MISS * (upper - lower)).any():
        ranges = zip(names, asked, lower, upper, nearest, np.asarray(space.units), strict=True)
        listed = "; ".join(
            f"{name} {value:.2f} of {low:.2f} .. {high:.2f} {unit}, nearest {near:.2f}"
            for name, value, low, high, near, unit in ranges
        )
        raise ValueError(
            f"motion_graph.space: out of reach: {listed}; ask for less, add takes, or outside: clamp"
        )
