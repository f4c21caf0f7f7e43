"""Blending methods side by side."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.product import Dataset
from reperform.nodes.products.blend_measures import BlendErrors, BlendTable
from reperform.nodes.products.measures import Measures


@node(over="dataset")
def blend_table(errors: Dataset[BlendErrors], times: Dataset[Measures]) -> BlendTable:
    """The seeds' table of blending: per pair and method the greatest errors over all weights, and the time.

    errors and times: as many products, in one order; times as evaluate.blend_times gives them, a frame per pair.

    Raises ValueError where errors and times do not belong together.
    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 table 1; 004 table 3.1).
    """
    if len(errors) != len(times):
        raise ValueError(
            f"evaluate.blend_table: as many errors as times needed, got {len(errors)} and {len(times)}"
        )
    rows = []
    for product, measured in zip(errors.values(), times.values(), strict=True):
        if len(measured.value) != len(product.pair):
            raise ValueError(
                f"evaluate.blend_table: times of {len(measured.value)} pairs do not fit errors of "
                f"{len(product.pair)}: measure the same pairs, in the same order"
            )
        names = [str(name) for name in np.asarray(measured.name)]
        for k, pair in enumerate(np.asarray(product.pair)):
            for m, method in enumerate(map(str, np.asarray(product.method))):
                seconds = float(measured.value[k, names.index(method)])
                rows.append((str(pair), int(product.vertices), method, *_row(product, k, m), seconds))
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    columns[1] = columns[1].astype(np.int32)
    return BlendTable(*columns)


def _row(errors: BlendErrors, k: int, m: int) -> tuple[float, ...]:
    largest = float(errors.largest[k, m].max())
    return (
        largest / float(errors.size[k]),
        largest,
        float(errors.rms[k, m].max()),
        float(errors.volume[k, m].max()),
        float(errors.strain[k, m].max()),
        float(errors.truth[k, m, 0]),
    )
