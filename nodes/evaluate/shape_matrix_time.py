"""How long the shape matrix of many frames takes."""

from __future__ import annotations

import time
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.shape_histograms import ShapeHistograms
from reperform.nodes.similarity.shape import shape


@node(over="dataset", volatile=True, memory=2.0)
def shape_matrix_time(
    histograms: Dataset[ShapeHistograms],
    *,
    frames: Annotated[
        int, Param("1", 2, 20_000, "compared with one another; those wired are repeated")
    ] = 1500,
) -> Measures:
    """Wall time of similarity.shape over all pairs of so many frames, entry `matrix` s, one row.

    The frames of all takes are repeated, each time turned by one bin more, until there are enough; the time does
    not depend on what they hold.

    Source: definition.
    """
    share = np.concatenate([np.asarray(take.share) for take in histograms.values()])
    turned = [np.roll(share, k, axis=3) for k in range(-(-frames // len(share)))]
    first = next(iter(histograms.values()))
    many = ShapeHistograms(
        np.concatenate(turned)[:frames], np.zeros((frames, 3), np.float32), np.asarray(first.reach)
    )
    start = time.perf_counter()
    shape((many, many))
    seconds = time.perf_counter() - start
    return Measures(np.array([[seconds]]), np.array(["matrix"]), np.array(["s"]))
