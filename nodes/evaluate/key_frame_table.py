"""Key-framed synthesis summed up."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.product import Dataset
from reperform.nodes.products.key_frame_table import KeyFrameTable
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.target_grid import TargetGrid


@node(over="dataset")
def key_frame_table(
    grids: Dataset[TargetGrid], errors: Dataset[Measures], times: Dataset[Measures]
) -> KeyFrameTable:
    """One row per character and key-frame sequence, over all its targets.

    grids, errors (of `evaluate.target_errors`) and times (of `evaluate.target_time`): one per character, in one order.
    Least, root mean square and greatest of the errors of met targets; shares; seconds.

    Raises ValueError where they are not of the same characters.
    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 table III).
    Departure: relative errors, infeasible and undecided shares and the proved gap stand beside the seed's columns.
    """
    rows = []
    for (character, grid), missed, time in zip(grids.items(), errors.values(), times.values(), strict=True):
        sequences = list(map(str, np.asarray(grid.keys)))
        shape = (len(sequences), len(grid.distance) * len(grid.duration))
        values = np.asarray(missed.value)
        if values.shape[0] != shape[0] * shape[1] or len(time.value) != shape[0]:
            raise ValueError(
                f"evaluate.key_frame_table: {character} has {shape[0]} sequences of {shape[1]} targets, got "
                f"{values.shape[0]} rows of errors and {len(time.value)} of times: wire all three in one order"
            )
        named = dict(zip(map(str, np.asarray(missed.name)), values.T.reshape(-1, *shape), strict=True))
        clock = dict(zip(map(str, np.asarray(time.name)), np.asarray(time.value).T, strict=True))
        for k, keys in enumerate(sequences):
            entry = {name: column[k] for name, column in named.items()}
            rows.append(
                (
                    _shown(character), keys, *_span(entry["smoothness"])[::2], *_span(entry["distance"]),
                    *_span(entry["duration"]), *_span(entry["relative distance"])[1:],
                    *_span(entry["relative duration"])[1:], entry["infeasible"].mean(), entry["undecided"].mean(),
                    _span(entry["gap"])[2], clock["prepare"][k], clock["target"][k],
                )
            )  # fmt: skip
    return KeyFrameTable(*(np.array(column) for column in zip(*rows, strict=True)))


def _shown(character: str) -> str:
    """The value of a matrix variable where that is what names the character."""
    return character.rpartition("=")[2].rstrip("]")


def _span(values: np.ndarray) -> tuple[float, float, float]:
    """Least, root mean square and greatest of what was measured; nan where nothing was."""
    known = values[np.isfinite(values)]
    if len(known) == 0:
        return np.nan, np.nan, np.nan
    return float(known.min()), float(np.sqrt((known**2).mean())), float(known.max())
