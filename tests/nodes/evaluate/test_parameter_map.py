"""The report on spaces whose map is known; more in tests/nodes/motion_graph/test_space_weights.py."""

import numpy as np
import pytest

from reperform.nodes.evaluate.parameter_map import parameter_map


def test_all_of_one_parameter_can_be_reached_where_the_inverse_is_right(circling):
    space = circling(8, 0.1, 1.0)
    report = parameter_map(space)
    value = dict(zip(report.name.tolist(), report.value[0].tolist(), strict=True))
    assert value["reachable"] == 1
    assert (value["height lower"], value["height upper"]) == pytest.approx((0, 0.2))
    assert report.unit.tolist() == ["1", "m", "m", "1", "1"]


def test_a_wrong_inverse_is_found_out(circling):
    space = circling(8, 0.1, 1.0)
    stuck = space._replace(inverse=np.full((2, 1), 0.5))
    # within 2 % of the middle only, of 21 values
    assert parameter_map(stuck).value[0, 0] == pytest.approx(1 / 21)
