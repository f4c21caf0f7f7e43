"""A body that bends by different angles: linear blends shrink it, corrected ones do not."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.blend.cell_fields import cell_fields
from reperform.nodes.blend.correct_space import correct_space
from reperform.nodes.kernels.control_cells import blend_weights, cells_of, framed
from reperform.nodes.kernels.hybrid_build import nonlinear_blends
from reperform.nodes.products.parametric import ParametricSpace
from reperform.nodes.synthesis.cell_corrections import add_corrections, cell_corrections

EPSILON, POSES = 0.004, 3


def bending(control: np.ndarray) -> ParametricSpace:
    """Controls (N, d) bend the upper half sideways and, where there is a second one, ahead; more from pose to pose."""
    mesh = trimesh.creation.icosphere(subdivisions=2)
    rest = np.asarray(mesh.vertices) * [0.2, 0.8, 0.15] + [0, 0.85, 0]
    rest[:, 0] += 0.05 * rest[:, 1] ** 2
    made = np.empty((len(control), POSES, *rest.shape), np.float32)
    for i, row in enumerate(control):
        for k in range(POSES):
            points = rest.copy()
            for angle, axis in zip((row - 0.4) * (0.8 + 0.3 * k), ((0, 1), (2, 1)), strict=False):
                turn = 2.0 * angle * np.clip(points[:, 1] - 0.6, 0, 1)
                c, s, up = np.cos(turn), np.sin(turn), points[:, 1] - 0.6
                side = points[:, axis[0]].copy()
                points[:, axis[0]], points[:, 1] = c * side + s * up, 0.6 + c * up - s * side
            made[i, k] = points
    empty = {name: np.zeros(0) for name in ParametricSpace._fields}
    return ParametricSpace(
        **empty
        | {
            "takes": np.array([f"take{i}" for i in range(len(control))]),
            "vertices": made,
            "control": control,
            "cells": cells_of(control),
            "faces": np.asarray(mesh.faces, np.int32),
        }
    )


def blended(space: ParametricSpace, control, pose: float, corrected) -> np.ndarray:
    """(V, 3) in float32, linear, with corrections."""
    cells, d = framed(space.control, space.cells), space.control.shape[1]
    weights, scratch = np.empty(len(space.takes)), np.empty(d + 1)
    blend_weights(np.array(control, float), cells, scratch, weights)
    before = int(pose)
    after = (before + 1) % POSES
    part = pose - before
    flat = np.tensordot(weights, (1 - part) * space.vertices[:, before] + part * space.vertices[:, after], 1)
    flat = flat.astype(np.float32).ravel()
    if corrected is not None:
        add_corrections(
            cell_fields(corrected), cells, np.array(control, float), pose, 1.0, scratch, scratch.copy(), flat
        )
    return flat.reshape(-1, 3)


@pytest.fixture(scope="module")
def line() -> ParametricSpace:
    return bending(np.array([[0.0], [1.0], [0.45]]))


@pytest.fixture(scope="module")
def square() -> ParametricSpace:
    return bending(np.array([[0.0, 0.0], [1.0, 0.1], [0.1, 1.0], [1.0, 0.9]]))


def distance(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.linalg.norm(one - other, axis=-1).max())


@pytest.mark.parametrize("control", [0.0, 0.45, 1.0])
def test_takes_stay_exact_to_the_bit(line, control: float):
    made = correct_space(line, epsilon=EPSILON, levels=2)
    for pose in (0.0, 1.0, 1.3, 2.6):
        np.testing.assert_array_equal(
            blended(line, [control], pose, made), blended(line, [control], pose, None)
        )


def test_blends_come_near_to_the_non_linear_ones(line):
    made = correct_space(line, epsilon=EPSILON, levels=0, deepest=5)
    assert made.error.max() <= 1.1 * EPSILON
    exact = nonlinear_blends(line.vertices[[2, 1]], line.faces, line.vertices[0, 0])
    for share in (0.25, 0.5, 0.7):
        control = 0.45 + 0.55 * share
        wanted = exact(np.array([1 - share, share]))
        linear = max(distance(blended(line, [control], k, None), wanted[k]) for k in range(POSES))
        corrected = max(distance(blended(line, [control], k, made), wanted[k]) for k in range(POSES))
        assert corrected < 1.3 * EPSILON
        assert linear > 2.0 * corrected


def test_between_poses_and_round_the_end_corrections_are_mixed(line):
    made = correct_space(line, epsilon=EPSILON, levels=1)
    ends = [blended(line, [0.7], k, made) for k in (2.0, 0.0)]
    np.testing.assert_allclose(blended(line, [0.7], 2.25, made), 0.75 * ends[0] + 0.25 * ends[1], atol=1e-6)


@pytest.mark.parametrize("epsilon", [EPSILON, 1e-5])
def test_cells_agree_where_they_meet(square, epsilon: float):
    """As nearly as what they leave out: each side by epsilon."""
    made = correct_space(square, epsilon=epsilon, levels=1, codes="int16")
    one, two = made.cells.tolist()
    common = sorted(set(one) & set(two))
    assert len(common) == 2
    across = np.array([1.0, -1.0]) * 1e-9
    gap = 0.0
    for share in (0.2, 0.5, 0.8):
        control = share * square.control[common[0]] + (1 - share) * square.control[common[1]]
        sides = [blended(square, control + sign * across, 1.0, made) for sign in (1, -1)]
        gap = max(gap, distance(*sides))
    assert gap < 2.1 * epsilon


def test_corrections_of_another_space_are_refused(line, square):
    made = correct_space(square, epsilon=EPSILON, levels=1)
    assert cell_corrections([line, square], {"bent": made}, "linear") == ((), ())
    found = cell_corrections([line, square], {"bent": made}, "hybrid")
    assert [len(own) for own in found] == [0, 2]
    with pytest.raises(ValueError, match="corrections 'bent' must be of a space that is played"):
        cell_corrections([line], {"bent": made}, "hybrid")
    with pytest.raises(ValueError, match="blending must be linear where no corrections are given"):
        cell_corrections([line], {}, "hybrid")
