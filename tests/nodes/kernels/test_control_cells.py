"""Weights in cells and on their lattices, against the definition."""

import numpy as np
import pytest

from reperform.nodes.kernels.control_cells import (
    blend_weights,
    cells_of,
    framed,
    lattice,
    lattice_point,
    locate,
)

CONTROLS = {
    1: np.array([[0.4], [1.0], [0.0]]),
    2: np.array([[0.0, 0.1], [1.0, 0.0], [0.3, 1.0], [0.9, 0.8], [0.45, 0.4]]),
    3: np.array([[x, y, z + 0.1 * x] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float),
}


@pytest.mark.parametrize("d", CONTROLS)
def test_weights_give_back_the_control(d):
    control = CONTROLS[d]
    cells = framed(control, cells_of(control))
    rng = np.random.default_rng(d)
    for _ in range(60):
        wanted = rng.dirichlet(np.ones(len(control))) @ control
        out = np.empty(len(control))
        blend_weights(wanted, cells, np.empty(d + 1), out)
        assert out.min() >= 0
        assert out.sum() == pytest.approx(1)
        assert out @ control == pytest.approx(wanted, abs=1e-9)
        assert (out > 1e-9).sum() <= d + 1


def test_examples_keep_their_weight_and_outside_is_clamped():
    control = CONTROLS[2]
    cells = framed(control, cells_of(control))
    out = np.empty(5)
    for k in range(5):
        blend_weights(control[k], cells, np.empty(3), out)
        assert out == pytest.approx(np.eye(5)[k])
    blend_weights(np.array([4.0, -1.0]), cells, np.empty(3), out)
    assert out.min() >= 0
    assert out.sum() == pytest.approx(1)


def test_examples_in_one_line_span_no_plane():
    with pytest.raises(ValueError, match="at least 3 takes"):
        cells_of(np.array([[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]]))


@pytest.mark.parametrize("d", CONTROLS)
@pytest.mark.parametrize("halves", [1, 2, 4])
def test_points_between_lattice_points_blend_to_themselves(d, halves):
    corners = cells_of(CONTROLS[d])
    cells = framed(CONTROLS[d], corners)
    weights, places = lattice(corners, halves)
    assert weights[: len(CONTROLS[d])] == pytest.approx(np.eye(len(CONTROLS[d])))
    assert len(np.unique(weights.round(9), axis=0)) == len(weights)
    rng = np.random.default_rng(halves)
    for k in range(80):
        shares = rng.dirichlet(np.ones(len(CONTROLS[d])) * 0.5) if k else np.eye(len(CONTROLS[d]))[0]
        wanted = shares @ CONTROLS[d]
        corner, place, share = np.empty(d + 1), np.empty(d + 1, np.int64), np.empty(d + 1)
        cell = locate(wanted, cells, corner)
        expected = corner @ np.eye(len(CONTROLS[d]))[corners[cell]]
        lattice_point(corner, halves, place, share)
        chosen = places[cell, place]
        assert (chosen >= 0).all()
        assert share.min() >= -1e-12
        assert share.sum() == pytest.approx(1)
        assert share @ weights[chosen] == pytest.approx(expected, abs=1e-9)
        # neighbours on the lattice: no two further apart than one step in any weight
        used = weights[chosen[share > 1e-9]]
        assert np.ptp(used, axis=0).max() <= 1 / halves + 1e-9
