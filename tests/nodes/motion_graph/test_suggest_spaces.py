import numpy as np
import pytest

from reperform.nodes.motion_graph.suggest_spaces import suggest_spaces
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.similarity.vertex_velocity import vertex_velocity


@pytest.fixture(scope="module")
def pairs(takes) -> dict[tuple[str, str], Dissimilarity]:
    meshes, _ = takes
    return {(a, b): vertex_velocity((meshes[a], meshes[b])) for a in meshes for b in meshes}


def test_walks_and_hops_are_told_apart_wherever_they_begin(pairs):
    made = suggest_spaces(pairs)
    label = dict(zip(made.takes.tolist(), made.label.tolist(), strict=True))
    assert label["low"] == label["high"]
    assert label["slow"] == label["fast"] == label["left"] == label["right"] == 0
    assert label["low"] == 1
    assert made.distance == pytest.approx(made.distance.T)


def test_the_order_of_takes_has_no_say(pairs):
    turned = {pair: pairs[pair] for pair in reversed(list(pairs))}
    one, two = suggest_spaces(pairs), suggest_spaces(turned)
    groups = [
        {frozenset(made.takes[made.label == k].tolist()) for k in range(made.label.max() + 1)}
        for made in (one, two)
    ]
    assert groups[0] == groups[1]


def test_a_cut_of_ones_own_counts(pairs):
    assert len(set(suggest_spaces(pairs, cut=1e-6).label)) == 6
    assert len(set(suggest_spaces(pairs, cut=10.0).label)) == 1


def test_phase_and_pace_make_no_difference():
    """Moments of one circle, shifted and at 1.5 the pace, are on it; a circle of half its size is not."""
    places = {
        "circle": np.exp(2j * np.pi * np.arange(40) / 40),
        "later": np.exp(2j * np.pi * (np.arange(30) * 1.5 + 13) / 40),
        "small": 0.5 * np.exp(2j * np.pi * (np.arange(40) + 5) / 40),
    }
    made = suggest_spaces(
        {
            (a, b): Dissimilarity(np.abs(p[:, None] - q[None]).astype(np.float32))
            for a, p in places.items()
            for b, q in places.items()
        }
    )
    assert made.label.tolist() == [0, 0, 1]
    assert made.distance[0, 1] < 0.1
    assert made.distance[0, 2] == pytest.approx(0.5, abs=0.02)


def test_errors_say_what_to_do(pairs):
    with pytest.raises(ValueError, match="two takes or more"):
        suggest_spaces({("slow", "slow"): pairs["slow", "slow"]})
    with pytest.raises(ValueError, match="missing fast, slow"):
        suggest_spaces({("slow", "fast"): pairs["slow", "fast"]})
