"""Pictures: what cameras saw, and what belongs to the performer in them."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class Footage(NamedTuple):
    """Synchronous pictures of all cameras of one take, RGB."""

    images: Annotated[np.ndarray, Axes("frame", "camera", "y", "x", "3", dtype="uint8", unit="1/255")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class CleanPlate(NamedTuple):
    """The empty set as each camera saw it: mean picture and its spread, RGB."""

    mean: Annotated[np.ndarray, Axes("camera", "y", "x", "3", dtype="float32", unit="1/255")]
    deviation: Annotated[np.ndarray, Axes("camera", "y", "x", "3", dtype="float32", unit="1/255")]


class Mattes(NamedTuple):
    """Probability that a pixel shows the performer (255 = certain)."""

    alpha: Annotated[np.ndarray, Axes("frame", "camera", "y", "x", dtype="uint8", unit="1/255")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class Film(NamedTuple):
    """A finished film: one picture per frame, RGB, and the coverage of the performer in it."""

    images: Annotated[np.ndarray, Axes("frame", "y", "x", "3", dtype="uint8", unit="1/255")]
    coverage: Annotated[np.ndarray, Axes("frame", "y", "x", dtype="uint8", unit="1/255")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]
