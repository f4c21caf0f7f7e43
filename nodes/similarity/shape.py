"""Shape dissimilarity of frames that need not share a topology."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.azimuth_correlation import azimuth_spectrum, least_azimuth_distance
from reperform.nodes.kernels.temporal_filter import filter_diagonals
from reperform.nodes.product import Pair
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.shape_histograms import ShapeHistograms


@node(over="pair", memory=1.0)
def shape(
    histograms: Pair[ShapeHistograms],
    *,
    radial_power: Annotated[
        float, Param("1", 0.0, 4.0, "weight of a shell grows with this power of its radius")
    ] = 1.0,
    filter_frames: Annotated[
        int, Param("frame", 0, 25, "frames before and after over which the matrix is averaged in time")
    ] = 0,
) -> Dissimilarity:
    """How far the shape of every frame of one take is from that of every frame of the other: (frame_a,
    frame_b).

    D(a, b)^2 = min over phi of sum_r w_r |H_r(a) - H_r(b turned by phi)|^2, histograms scaled to length 1
    under the weights w_r ~ r^radial_power, so 0 is the same shape and sqrt(2) nothing in common. All turns
    of all pairs at once by FFT over azimuth. With filter_frames = n the matrix is then averaged along its
    diagonals, S(a, b) = mean over k = -n .. n of D(a + k, b + k), which tells motions of one pose apart.

    Raises ValueError where the histograms differ in bins or reach.

    Source: 003 section 3.2.2, eq 12; temporal filter: Huang, Hilton and Starck, IJCV 2010.
    Departure: sum of squares in place of absolute values, which the FFT needs (the turn is found among all
    bins, not by exhaustive search).
    """
    a, b = histograms
    if a.share.shape[1:] != b.share.shape[1:] or not np.isclose(a.reach, b.reach):
        raise ValueError(
            "shape: both takes need one set of bins (radial, polar, azimuth) and reach (m), got "
            f"{a.share.shape[1:]}, {float(a.reach):g} and {b.share.shape[1:]}, {float(b.reach):g}: "
            "make both with the same parameters of similarity.shape_histogram"
        )
    radial, azimuth = a.share.shape[1], a.share.shape[3]
    weight = ((np.arange(radial) + 0.5) / radial) ** radial_power
    distance = least_azimuth_distance(
        azimuth_spectrum(a.share, weight), azimuth_spectrum(b.share, weight), azimuth
    )
    return Dissimilarity(filter_diagonals(distance, filter_frames).astype(np.float32))
