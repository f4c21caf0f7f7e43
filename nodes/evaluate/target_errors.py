"""What a grid of targets came to."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.target_grid import TargetGrid


@node(over="dataset")
def target_errors(grid: TargetGrid, smoothness: Measures) -> Measures:
    """One row per target; nan where an entry does not apply.

    `distance` m and `duration` s: |reached - asked| of met targets; `relative distance`, `relative duration`: the
    same over what was asked; `missed distance`, `missed duration`: of targets that cannot be met, to the nearest
    that can; `infeasible`: 1 where no walk meets it, 0 where one does; `undecided`: 1 where neither could be
    shown; `gap`: cost - bound of met targets; `smoothness` m: the greatest of the transitions taken by met ones.

    smoothness: one row per transition of the graph. Raises ValueError where it is of another graph.
    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 table III).
    Departure: infeasible targets are counted apart, not mixed into the errors.
    """
    rough = np.asarray(smoothness.value)[:, 0]
    taken = np.asarray(grid.taken)
    if taken.shape[-1] != len(rough):
        raise ValueError(
            f"evaluate.target_errors: smoothness must have a row per transition, {taken.shape[-1]}, got {len(rough)}: "
            f"measure the graph that the grid was made with"
        )
    status = np.asarray(grid.status)
    met = status == 1
    # a nanometre and a nanosecond are the arithmetic's
    far = abs(np.asarray(grid.reached_distance) - np.asarray(grid.distance)[None, :, None]).round(9)
    late = abs(np.asarray(grid.reached_duration) - np.asarray(grid.duration)[None, None]).round(9)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = far / np.asarray(grid.distance)[None, :, None], late / np.asarray(grid.duration)[None, None]
    worst = np.where(taken > 0, rough, -np.inf).max(axis=-1, initial=-np.inf)
    columns = {
        "distance": (np.where(met, far, np.nan), "m"),
        "duration": (np.where(met, late, np.nan), "s"),
        "relative distance": (np.where(met, shares[0], np.nan), "1"),
        "relative duration": (np.where(met, shares[1], np.nan), "1"),
        "missed distance": (np.where(met, np.nan, far), "m"),
        "missed duration": (np.where(met, np.nan, late), "s"),
        "infeasible": ((status == 0).astype(np.float64), "1"),
        "undecided": ((status == -1).astype(np.float64), "1"),
        "gap": (np.where(met, np.asarray(grid.cost) - np.asarray(grid.bound), np.nan), "1"),
        "smoothness": (np.where(met & np.isfinite(worst), worst, np.nan), "m"),
    }
    return Measures(
        np.stack([values.ravel() for values, _ in columns.values()], axis=1).astype(np.float64),
        np.array(list(columns)),
        np.array([unit for _, unit in columns.values()]),
    )
