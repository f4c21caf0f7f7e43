"""Surfaces."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class Occupancy(NamedTuple):
    """Probability field on a grid: centre of voxel (i, j, k) = origin + voxel * (i, j, k); axes x, y, z."""

    probability: Annotated[np.ndarray, Axes("frame", "x*", "y*", "z*")]
    origin: Annotated[np.ndarray, Axes("frame", "3", unit="m")]
    voxel: Annotated[np.ndarray, Axes(unit="m")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class Surfaces(NamedTuple):
    """A triangle mesh per frame, each with a topology of its own; faces counter-clockwise from outside."""

    vertices: Annotated[np.ndarray, Axes("frame", "vertex*", "3", unit="m")]
    faces: Annotated[np.ndarray, Axes("frame", "face*", "3", dtype="int32")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class MeshSequence(NamedTuple):
    """4D: one topology over all frames (and, once aligned, over all takes)."""

    vertices: Annotated[np.ndarray, Axes("frame", "vertex", "3", unit="m")]
    faces: Annotated[np.ndarray, Axes("face", "3", dtype="int32")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class TextureAtlas(NamedTuple):
    """A picture painted on a mesh: u right, v up, (0, 0) the bottom-left corner of the image."""

    uv: Annotated[np.ndarray, Axes("texel", "2")]
    # per face of the mesh, which three of `uv` its corners take
    faces_uv: Annotated[np.ndarray, Axes("face", "3", dtype="int32")]
    image: Annotated[np.ndarray, Axes("y", "x", "3", dtype="uint8", unit="1/255")]
