"""What a parametric space can do, and how well it does what is asked."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.motion_graph.space_weights import done, weights_for
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.parametric import ParametricSpace

_GRID = 21


@node(over="take")
def parameter_map(space: ParametricSpace) -> Measures:
    """The reach of a space and the error of its inverse map, one row, entries per parameter NAME.

    `NAME lower`, `NAME upper` in its unit; `NAME error`, `NAME worst` the mean and greatest |f(f^-1(p)) - p| over the
    range, on blends that were not sampled. `reachable` is the share of the box of all ranges, 21 values to a side, that
    is done to 2 % of the range.

    Source: 004 section 3.2.3 (f(w) sampled, f^-1(p) fitted); 001 section 3.1.
    """
    lower, upper = (np.asarray(side, np.float64) for side in (space.lower, space.upper))
    axes = [np.linspace(low, high, _GRID) for low, high in zip(lower, upper, strict=True)]
    asked = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    willing = space._replace(refuse=np.asarray(False))
    weights = np.stack([weights_for(willing, row.tolist()) for row in asked])
    near = np.abs(done(space, weights) - asked) <= 0.02 * (upper - lower)
    values, names, units = [float(near.all(axis=1).mean())], ["reachable"], ["1"]
    error = np.asarray(space.inverse_error)
    rows = zip(
        np.asarray(space.parameters).tolist(),
        np.asarray(space.units).tolist(),
        lower,
        upper,
        error,
        strict=True,
    )
    for name, unit, low, high, (mean, worst) in rows:
        values += [float(low), float(high), float(mean), float(worst)]
        names += [f"{name} lower", f"{name} upper", f"{name} error", f"{name} worst"]
        units += [unit, unit, "1", "1"]
    return Measures(np.array([values]), np.array(names), np.array(units))
