"""Whether transitions join the same phase of a gait in the same costume."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from scipy.ndimage import label

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.gait_phase import gait_phase
from reperform.nodes.product import Dataset
from reperform.nodes.products.measure_comparison import MeasureComparison
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import TextureAtlas
from reperform.nodes.products.performance import Contacts


@node(over="dataset", memory=0.5)
def transition_truth(
    comparison: MeasureComparison,
    contacts: Dataset[Contacts],
    textures: Dataset[TextureAtlas],
    *,
    tolerance: Annotated[
        float, Param("cycle", 0.0, 0.5, "by which the phases of both ends may differ")
    ] = 0.1,
    apart: Annotated[int, Param("frame", 0, 1000, "least time between both ends within one take")] = 10,
) -> Measures:
    """Precision and recall of each measure's transitions, one row, entries `precision NAME` and `recall NAME`, and
    `precision gain`, that of the first measure over the second.

    A transition is true where both ends are in one phase of the gait (from the true landings of the feet), within
    `tolerance`, and both takes have one picture painted on. Of each measure as many of its cheapest transitions
    count as there are true places, a place being one connected band of matching frames of an ordered pair of
    takes: precision is the share of them that are true, recall the share of places that one of them is in. nan
    where there is no true place.

    Source: 000 section 4.2, fig 4.
    Departure: counted against known phase and colours; 000 judges by eye.
    """
    takes = [str(take) for take in comparison.takes]
    phases = [gait_phase(np.asarray(contacts[take].planted)) for take in takes]
    pictures = [np.asarray(textures[take].image) for take in takes]
    half, places, count = int(comparison.half_length), {}, 0
    for a in range(len(takes)):
        for b in range(len(takes)):
            off = phases[a][:, None] - phases[b][None, :]
            match = np.abs(off - np.rint(off)) <= tolerance
            if a == b:
                frames = np.arange(len(phases[a]))
                match &= np.abs(frames[:, None] - frames[None, :]) >= apart
            if not np.array_equal(pictures[a], pictures[b]):
                match[:] = False
            # where no window fits, there is no place
            match[:half], match[len(match) - half :] = False, False
            match[:, :half], match[:, match.shape[1] - half :] = False, False
            bands, number = label(match, np.ones((3, 3)))
            places[a, b] = np.where(bands > 0, bands + count, 0)
            count += number
    values, names = [], []
    for k, name in enumerate(comparison.measures):
        hit = _places_hit(comparison, k, places, count)
        names += [f"precision {name}", f"recall {name}"]
        found = hit[hit > 0]
        values += [len(found) / len(hit), len(np.unique(found)) / count] if len(hit) else [np.nan, np.nan]
    if len(comparison.measures) > 1:
        names.append("precision gain")
        values.append(values[0] - values[2])
    return Measures(np.array([values], np.float64), np.array(names), np.full(len(names), "1"))


def _places_hit(
    comparison: MeasureComparison, measure: int, places: dict[tuple[int, int], np.ndarray], count: int
) -> np.ndarray:
    """The place of each of the `count` cheapest transitions of a measure; 0 where it is a false one."""
    chosen = np.flatnonzero(np.asarray(comparison.measure) == measure)
    cheap = chosen[np.argsort(np.asarray(comparison.cost)[chosen], kind="stable")][:count]
    return np.array(
        [
            places[int(comparison.source[t]), int(comparison.target[t])][
                int(comparison.source_frame[t]), int(comparison.target_frame[t])
            ]
            for t in cheap
        ],
        np.int64,
    )
