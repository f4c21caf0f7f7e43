"""Inverses of maps that are known in closed form."""

import numpy as np
import pytest

from reperform.nodes.kernels.control_cells import cells_of
from reperform.nodes.kernels.motion_parameters import Travelled, measure
from reperform.nodes.kernels.parameter_map import controls_at, invert, orientation, sample_cells

CONTROLS = {
    1: np.array([[0.0], [0.35], [1.0]]),
    2: np.array([[0.0, 0.2], [1.0, 0.0], [0.9, 1.0], [0.1, 0.9]]),
    3: np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float),
}
PARTS = {1: 20, 2: 12, 3: 4}


def bent(control: np.ndarray) -> np.ndarray:
    """A smooth map without folds."""
    first = 2.0 * control[:, :1] + 0.8 * control[:, :1] ** 2
    return np.concatenate([first, control[:, 1:] + 0.1 * control[:, :1] * control[:, 1:]], axis=1)


@pytest.mark.parametrize("d", CONTROLS)
@pytest.mark.parametrize(("method", "limit"), [("monotone", 0.02), ("rbf", 0.02), ("polynomial", 0.03)])
def test_what_is_asked_is_done(d, method, limit):
    weights, controls, small = sample_cells(CONTROLS[d], cells_of(CONTROLS[d]), PARTS[d])
    assert weights.sum(axis=1) == pytest.approx(1)
    table = invert(method, bent(controls), controls, small)
    rng = np.random.default_rng(d)
    for control in rng.uniform(0.25, 0.75, (40, d)):
        wanted, found = bent(control[None])[0], np.empty(d)
        controls_at(wanted, table, found)
        assert np.abs(found - control).max() < limit
        assert (np.abs(bent(found[None])[0] - wanted) / (table.upper - table.lower)).max() < limit


def test_values_out_of_range_are_clamped():
    _, controls, small = sample_cells(CONTROLS[1], cells_of(CONTROLS[1]), 20)
    table = invert("monotone", bent(controls), controls, small)
    out = np.empty(1)
    for wanted, expected in ((-3.0, 0.0), (99.0, 1.0)):
        controls_at(np.array([wanted]), table, out)
        assert out[0] == pytest.approx(expected)


@pytest.mark.parametrize("d", CONTROLS)
def test_small_cells_fill_the_cells_they_are_cut_from(d):
    corners = cells_of(CONTROLS[d])
    _, controls, small = sample_cells(CONTROLS[d], corners, 4)
    whole = np.abs(orientation(CONTROLS[d], corners)).sum()
    assert np.abs(orientation(controls, small)).sum() == pytest.approx(whole)
    assert np.abs(orientation(controls, small)).min() > 0


def test_parameters_of_a_walk_round_a_circle():
    """Twelve steps of a polygon: chords of a circle of radius 2 m, gone round at 0.5 rad/s, and a rise."""
    radius, turn, count = 2.0, 0.25, 12
    chord = 2 * radius * np.sin(turn / 2)
    step = [chord * np.sin(turn / 2), chord * np.cos(turn / 2), turn]
    travelled = Travelled(
        np.tile(step, (1, count, 1)), np.full((1, count), 0.5), np.array([[0.9, 1.0, 1.3, *[0.9] * 9]])
    )
    one, hand = np.ones((1, 1)), np.array([[0.3, 1.4, 0.6]])
    assert measure("speed", travelled, one, hand, 0) == pytest.approx(radius * turn / 0.5)
    assert measure("turning", travelled, one, hand, 0) == pytest.approx(0.5)
    assert measure("height", travelled, one, hand, 0) == pytest.approx(0.4)
    assert measure("length", travelled, one, hand, 0) == pytest.approx(2 * radius * np.sin(turn * count / 2))
    reach = [float(measure(f"reach_{axis}", travelled, one, hand, 4)[0]) for axis in "xyz"]
    angle = 4 * turn
    ground = radius * np.array([1 - np.cos(angle), np.sin(angle)])
    c, s = np.cos(angle), np.sin(angle)
    assert reach == pytest.approx([ground[0] + 0.3 * c + 0.6 * s, 1.4, ground[1] - 0.3 * s + 0.6 * c])
