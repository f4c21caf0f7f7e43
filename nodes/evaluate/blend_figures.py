"""Figures of blending, from its errors."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.product import Dataset
from reperform.nodes.products.blend_measures import BlendErrors
from reperform.nodes.products.measures import Measures


@node(over="dataset")
def blend_figures(
    errors: Dataset[BlendErrors],
    *,
    pairs: Annotated[tuple[str, ...], Param("", about="the pairs that count; none: all")] = (),
) -> Measures:
    """Per pair the greatest value over all weights: one frame per pair, one entry per method and quantity.

    Entries are `METHOD share` (largest vertex error over the model's height), `METHOD volume`, `METHOD strain`,
    `METHOD end` (m) and `METHOD truth` (mean distance to the true middle, m).

    Raises ValueError where a pair is not there.
    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 table 1).
    """
    known = [str(name) for product in errors.values() for name in np.asarray(product.pair)]
    missing = sorted(set(pairs) - set(known))
    if missing:
        raise ValueError(f"evaluate.blend_figures: no pair {missing[0]!r}; there are {', '.join(known)}")
    names: list[str] = []
    units: list[str] = []
    rows: list[list[float]] = []
    for product in errors.values():
        for k, pair in enumerate(np.asarray(product.pair)):
            if not pairs or str(pair) in pairs:
                entries = _entries(product, k)
                names, units = [name for name, _, _ in entries], [unit for _, unit, _ in entries]
                rows.append([value for _, _, value in entries])
    return Measures(np.array(rows, np.float64), np.array(names), np.array(units))


def _entries(errors: BlendErrors, k: int) -> list[tuple[str, str, float]]:
    found = []
    for m, method in enumerate(map(str, np.asarray(errors.method))):
        found += [
            (f"{method} share", "1", float(errors.largest[k, m].max() / errors.size[k])),
            (f"{method} volume", "1", float(errors.volume[k, m].max())),
            (f"{method} strain", "1", float(errors.strain[k, m].max())),
            (f"{method} end", "m", float(errors.end[k, m])),
            (f"{method} truth", "m", float(errors.truth[k, m, 0])),
        ]
    return found
