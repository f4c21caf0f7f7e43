"""Shape-colour dissimilarity of frames that need not share a topology."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.signatures import Signatures, common_planes, merged, signatures
from reperform.nodes.kernels.temporal_filter import filter_diagonals
from reperform.nodes.kernels.turned_transport import exact_distances, turned, turned_transport
from reperform.nodes.product import Pair
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.shape_colour import ShapeColourHistograms

# cells by which the turns to be tried are chosen, first many turns by few cells, then few turns by more
_ROUGH, _MIDDLE = 24, 64
# the second margin's share of the first one's
_CLOSER = 0.2
# cells from which distances of all bins are bounded, where these are solved
_BOUNDING = 160

ColourWeight = Annotated[
    float, Param("m", 0.0, 100.0, "how far apart the two ends of a colour channel count")
]
Turns = Annotated[int, Param("1", 1, 360, "equal turns about the vertical among which the best counts")]


@node(over="pair", memory=0.5)
def shape_colour(
    histograms: Pair[ShapeColourHistograms],
    *,
    colour_weight: ColourWeight = 1.0,
    clusters: Annotated[
        int, Param("1", 0, 2000, "points that stand for a frame's filled bins; 0: all bins, exactly")
    ] = 256,
    turns: Turns = 20,
    margin: Annotated[
        float, Param("1", 1.0, 100.0, "turns are tried whose rough distance is under this times the least")
    ] = 1.15,
    filter_frames: Annotated[
        int, Param("frame", 0, 25, "frames before and after over which the matrix is averaged in time")
    ] = 0,
) -> Dissimilarity:
    """How far shape and colour of every frame of one take are from those of the other, in metres: (frame_a,
    frame_b).

        c(a, b) = min over turns of EMD(H(a), H(b turned)),   |x - y|^2 + colour_weight^2 |rgb_x - rgb_y|^2 the
        squared distance over which a share of the surface is moved

    EMD is the least mean distance over which the surface must be moved to make one histogram of the other. All
    filled bins of both takes, one of them at all turns, are cut by common planes into `clusters` cells; each frame,
    at each turn, is represented by what its cells hold, and EMD between those is exact. It is within delta_a +
    delta_b of the full one, delta the mean distance of bins from the points that stand for them. The turns worth
    trying are chosen by rougher cuts. With 0 clusters, EMD of all filled bins is solved, at every turn that a lower
    bound does not rule out: the least is proved.

    Raises ValueError where the histograms differ in bins or reach.

    Source: 000 section 4.1, eq 1; Rubner, Tomasi and Guibas 2000, IJCV 40.
    Departure: cells in place of all bins, which costs a thousandth; turning points in place of counting
    finer bins again.
    """
    a, b = histograms
    if not (np.array_equal(a.bins, b.bins) and np.isclose(a.reach, b.reach)):
        raise ValueError(
            f"similarity.shape_colour: both takes need one set of bins and reach (m), got {np.asarray(a.bins)}, "
            f"{float(a.reach):g} and {np.asarray(b.bins)}, {float(b.reach):g}: make both with the same parameters "
            "of similarity.shape_colour_histogram"
        )
    same = equal_takes(a, b)
    if clusters:
        first, second = (shape_colour_signatures(take, colour_weight) for take in histograms)
        every = turned(second, turns)
        rough, middle, fine = (_level(first, every, count) for count in (_ROUGH, _MIDDLE, clusters))
        margins = (margin, 1 + _CLOSER * (margin - 1))
        distance = turned_transport(rough, middle, fine, turns, margins, same)
    else:
        rows, columns = len(a.share), len(b.share)
        pairs = np.stack(
            np.triu_indices(rows, 1) if same else np.divmod(np.arange(rows * columns), columns), axis=1
        )
        distance = np.zeros((rows, columns))
        distance[tuple(pairs.T)] = exact_distances(*all_bins(a, b, colour_weight, turns), turns, pairs)
    if same:
        distance += distance.T
    return Dissimilarity(filter_diagonals(distance, filter_frames).astype(np.float32))


def all_bins(
    a: ShapeColourHistograms, b: ShapeColourHistograms, colour_weight: float, turns: int
) -> tuple[tuple[Signatures, Signatures], tuple[Signatures, Signatures]]:
    """All filled bins of two takes, the second at every turn, and both by cells from which distances are bounded."""
    first, every = (
        shape_colour_signatures(a, colour_weight),
        turned(shape_colour_signatures(b, colour_weight), turns),
    )
    return (first, every), _level(first, every, _BOUNDING)


def _level(take: Signatures, every: Signatures, count: int) -> tuple[Signatures, Signatures]:
    """A take and the turned other one by `count` common cells."""
    planes = common_planes((take, every), count)
    return merged(take, planes), merged(every, planes)


def shape_colour_signatures(histograms: ShapeColourHistograms, colour_weight: float) -> Signatures:
    """Every frame's filled bins as points (x, y, z, colour_weight times red, green, blue), m, with their shares."""
    points = [
        np.column_stack([point, colour_weight * colour])
        for point, colour in zip(histograms.point, histograms.colour, strict=True)
    ]
    return signatures(list(histograms.share), points)


def equal_takes(a: ShapeColourHistograms, b: ShapeColourHistograms) -> bool:
    """Whether both are one take."""
    return len(a.share) == len(b.share) and all(
        np.array_equal(x, y)
        for field in ("bin", "share", "point", "colour")
        for x, y in zip(getattr(a, field), getattr(b, field), strict=True)
    )
