import numpy as np
import pytest

from reperform.nodes.evaluate.parameter_map import parameter_map
from reperform.nodes.motion_graph.space import space
from reperform.nodes.motion_graph.space_weights import done, weights_for
from reperform.nodes.products.parametric import ParametricSpace


@pytest.fixture(scope="module")
def both(takes) -> ParametricSpace:
    return space(
        *takes, takes=("right", "left", "slow", "fast"), parameters=("turning", "speed"), outside="refuse"
    )


def test_what_is_asked_is_done(both):
    for asked in ([0.0, 0.9], [0.3, 1.15], [-0.2, 1.2], [0.8, 1.1]):
        weights = weights_for(both, asked)
        assert weights.sum() == pytest.approx(1)
        assert done(both, weights[None])[0] == pytest.approx(asked, abs=0.02)


def test_out_of_reach_is_refused_or_clamped(both):
    # within both ranges, but not together
    with pytest.raises(ValueError, match=r"out of reach: turning 0\.75 .* speed 1\.45"):
        weights_for(both, [0.75, 1.45])
    with pytest.raises(ValueError, match=r"speed 3\.00"):
        weights_for(both, [0.0, 3.0])
    willing = both._replace(refuse=np.asarray(False))
    weights = weights_for(willing, [0.0, 3.0])
    assert weights.min() >= 0
    assert done(willing, weights[None])[0, 1] == pytest.approx(both.upper[1], abs=0.02)
    with pytest.raises(ValueError, match="turning, speed are controlled, got 1"):
        weights_for(both, [0.1])


def test_the_report_says_how_far_a_space_reaches(both, takes):
    report = parameter_map(both)
    value = dict(zip(report.name.tolist(), report.value[0].tolist(), strict=True))
    # two triangles over the diagonals of a box: half of it, and the rim that counts as near
    assert 0.45 < value["reachable"] < 0.65
    assert value["turning lower"] == pytest.approx(-0.5, abs=0.01)
    assert value["speed upper"] == pytest.approx(1.5, abs=0.01)
    assert value["speed error"] <= value["speed worst"] < 0.03
    line = parameter_map(space(*takes, takes=("slow", "fast")))
    assert line.value[0, 0] == 1
