"""Corrections of linear blending while a character plays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from reperform.nodes.blend.cell_fields import cell_fields
from reperform.nodes.kernels.control_cells import Cells, locate
from reperform.nodes.kernels.hybrid_blend import HybridFields, correct_between
from reperform.nodes.products.parametric import ParametricSpace
from reperform.nodes.products.space_corrections import SpaceCorrections

Blending = Literal["linear", "hybrid"]


def cell_corrections(
    spaces: Sequence[ParametricSpace], corrections: Mapping[str, SpaceCorrections], blending: Blending
) -> tuple[tuple[HybridFields, ...], ...]:
    """Per space the corrections of its cells; empty where it has none or blending is linear.

    Raises ValueError where blending is hybrid and nothing is given, or something that belongs to no space.
    """
    found: list[tuple[HybridFields, ...]] = [()] * len(spaces)
    if blending == "linear":
        return tuple(found)
    if not corrections:
        raise ValueError(
            "blending must be linear where no corrections are given, got hybrid: add blend.correct_space"
        )
    for name, given in corrections.items():
        own = [s for s, space in enumerate(spaces) if _made_of(given, space)]
        if not own:
            raise ValueError(
                f"corrections {name!r} must be of a space that is played, got those of {', '.join(map(str, given.takes))} "
                f"in {int(given.poses)} poses: make them of the same step"
            )
        for s in own:
            found[s] = cell_fields(given)
    return tuple(found)


def _made_of(given: SpaceCorrections, space: ParametricSpace) -> bool:
    shape = (int(given.poses), int(given.vertices))
    same = np.array_equal(given.takes, space.takes) and np.array_equal(given.cells, space.cells)
    return same and space.vertices.shape[1:3] == shape


def add_corrections(
    fields: Sequence[HybridFields],
    cells: Cells,
    control: np.ndarray,
    pose: float,
    share: float,
    weights: np.ndarray,
    halved: np.ndarray,
    flat: np.ndarray,
) -> None:
    """flat (3 V,) += share of what the linear blend at a control (d,) and a pose between two lacks.

    The pose after the last is the first. weights, halved (d + 1,): overwritten.
    """
    one = fields[locate(control, cells, weights)]
    poses = one.inputs.shape[1]
    before = int(pose)
    correct_between(
        one, before % poses, (before + 1) % poses, float(pose) - before, weights, share, flat, halved
    )
