"""A performance with known truth."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes
from reperform.nodes.products.mesh import MeshSequence, TextureAtlas


class SkeletonSequence(NamedTuple):
    """Joint positions over time."""

    joints: Annotated[np.ndarray, Axes("frame", "joint", "3", unit="m")]
    # -1 for the root; parents come before children
    parents: Annotated[np.ndarray, Axes("joint", dtype="int32")]
    names: Annotated[np.ndarray, Axes("joint", dtype="str")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class BoneRotations(NamedTuple):
    """How far every joint's bones are turned from rest, in the world, over time."""

    rotation: Annotated[np.ndarray, Axes("frame", "joint", "3", "3")]
    # -1 for the root; parents come before children
    parents: Annotated[np.ndarray, Axes("joint", dtype="int32")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class Contacts(NamedTuple):
    """Which foot is planted on the ground."""

    # columns: left, right
    planted: Annotated[np.ndarray, Axes("frame", "2", dtype="bool")]


class Performance(NamedTuple):
    """What a virtual actor really did: mesh, what is painted on it, joints, contacts and the bones' rotations."""

    mesh: MeshSequence
    texture: TextureAtlas
    skeleton: SkeletonSequence
    contacts: Contacts
    bones: BoneRotations
