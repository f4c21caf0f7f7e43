"""How well meshes blend."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class PosePairs(NamedTuple):
    """Pairs of poses of one topology to be blended; the true pose half way is nan where it is not known."""

    name: Annotated[np.ndarray, Axes("pair", dtype="str")]
    first: Annotated[np.ndarray, Axes("pair", "vertex", "3", unit="m")]
    second: Annotated[np.ndarray, Axes("pair", "vertex", "3", unit="m")]
    middle: Annotated[np.ndarray, Axes("pair", "vertex", "3", unit="m")]
    faces: Annotated[np.ndarray, Axes("face", "3", dtype="int32")]


class BlendErrors(NamedTuple):
    """What each method of blending does to each pair, at many weights."""

    pair: Annotated[np.ndarray, Axes("pair", dtype="str")]
    method: Annotated[np.ndarray, Axes("method", dtype="str")]
    weight: Annotated[np.ndarray, Axes("weight", dtype="float64")]
    vertices: Annotated[np.ndarray, Axes(dtype="int32")]
    # height of the model: the larger vertical extent of both poses
    size: Annotated[np.ndarray, Axes("pair", dtype="float64", unit="m")]
    # distance of vertices to those of the non-linear blend
    average: Annotated[np.ndarray, Axes("pair", "method", "weight", dtype="float64", unit="m")]
    largest: Annotated[np.ndarray, Axes("pair", "method", "weight", dtype="float64", unit="m")]
    rms: Annotated[np.ndarray, Axes("pair", "method", "weight", dtype="float64", unit="m")]
    # |volume / interpolated volume of both poses - 1|, and the mean of |edge / interpolated edge - 1|
    volume: Annotated[np.ndarray, Axes("pair", "method", "weight", dtype="float64")]
    strain: Annotated[np.ndarray, Axes("pair", "method", "weight", dtype="float64")]
    # largest distance to the poses themselves at both ends
    end: Annotated[np.ndarray, Axes("pair", "method", dtype="float64", unit="m")]
    # mean and largest distance to the true pose half way, laid on it on the ground
    truth: Annotated[np.ndarray, Axes("pair", "method", "2", dtype="float64", unit="m")]


class BlendTable(NamedTuple):
    """Blending methods side by side: greatest errors against the non-linear blend, and time per frame."""

    sequence: Annotated[np.ndarray, Axes("row", dtype="str")]
    vertices: Annotated[np.ndarray, Axes("row", dtype="int32")]
    method: Annotated[np.ndarray, Axes("row", dtype="str")]
    # of the model's height
    share: Annotated[np.ndarray, Axes("row", dtype="float64", unit="1")]
    largest: Annotated[np.ndarray, Axes("row", dtype="float64", unit="m")]
    rms: Annotated[np.ndarray, Axes("row", dtype="float64", unit="m")]
    volume: Annotated[np.ndarray, Axes("row", dtype="float64", unit="1")]
    strain: Annotated[np.ndarray, Axes("row", dtype="float64", unit="1")]
    truth: Annotated[np.ndarray, Axes("row", dtype="float64", unit="m")]
    seconds: Annotated[np.ndarray, Axes("row", dtype="float64", unit="s")]


class ThresholdCurves(NamedTuple):
    """Error and memory of a blend space against the threshold under which nothing is corrected."""

    epsilon: Annotated[np.ndarray, Axes("epsilon", dtype="float64", unit="m")]
    # corrections per pose: 2^levels - 1
    references: Annotated[np.ndarray, Axes("level", dtype="int32")]
    error: Annotated[np.ndarray, Axes("level", "epsilon", dtype="float64", unit="m")]
    stored: Annotated[np.ndarray, Axes("level", "epsilon", dtype="float64", unit="byte")]
    # the same corrections on all vertices in float32
    dense: Annotated[np.ndarray, Axes("level", dtype="float64", unit="byte")]
    # share of the surface that is corrected
    corrected: Annotated[np.ndarray, Axes("level", "epsilon", dtype="float64")]
