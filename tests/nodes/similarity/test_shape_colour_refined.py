import numpy as np
import pytest

from reperform.nodes.kernels.transitions import find_transitions
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.shape_colour import ShapeColourHistograms
from reperform.nodes.ragged import Ragged
from reperform.nodes.similarity.shape_colour import shape_colour
from reperform.nodes.similarity.shape_colour_refined import shape_colour_refined

TURNS = 4


def _take(phases: np.ndarray, entries: int = 24) -> ShapeColourHistograms:
    """A cloud that swings, each frame at its phase."""
    rng = np.random.default_rng(7)
    rest, swing, other = rng.normal(size=(3, entries, 3)) * (0.2, 0.5, 0.3)
    colour = rng.random((entries, 3)).astype(np.float32)
    share = rng.random(entries) + 0.1
    points = [(rest + np.sin(p) * swing + np.cos(p) * other).astype(np.float32) for p in phases]
    frames = len(phases)
    return ShapeColourHistograms(
        Ragged([np.arange(entries, dtype=np.int32)] * frames),
        Ragged([share / share.sum()] * frames),
        Ragged(points),
        Ragged([colour] * frames),
        np.zeros((frames, 3), np.float32),
        np.array([5, 10, 20, 10, 10, 10], np.int32),
        np.float32(1.2),
    )


@pytest.fixture(scope="module")
def pair() -> tuple[ShapeColourHistograms, ShapeColourHistograms]:
    return _take(0.35 * np.arange(24)), _take(0.9 + 0.41 * np.arange(27) + 0.004 * np.arange(27) ** 2)


def _cheapest(distance: np.ndarray) -> set[tuple[int, int]]:
    found = find_transitions(distance, 3, 3, 3, spread=3)
    return set(zip(found.m.tolist(), found.n.tolist(), strict=True))


def test_its_cheapest_transitions_are_those_of_the_exact_matrix(pair) -> None:
    exact = shape_colour(pair, clusters=0, turns=TURNS).distance
    cells = shape_colour(pair, clusters=10, turns=TURNS).distance
    made = shape_colour_refined(
        Dissimilarity(cells), pair, transitions=3, half_length=3, turns=TURNS
    ).distance
    assert _cheapest(made) == _cheapest(exact) != _cheapest(cells)
    solved = np.isclose(made, exact, rtol=1e-6)
    # windows of 5 along the diagonal, and not the whole matrix
    assert 3 * 5 <= solved.sum() < 0.5 * exact.size
    others = (made / cells)[~solved]
    np.testing.assert_allclose(others, np.median((exact / cells)[solved]), rtol=0.05)
    np.testing.assert_allclose(others, others[0], rtol=1e-5)


def test_within_one_take_it_stays_symmetric(pair) -> None:
    take = pair[1]
    cells = shape_colour((take, take), clusters=3, turns=TURNS)
    made = shape_colour_refined(
        cells, (take, take), transitions=2, half_length=3, apart=8, turns=TURNS
    ).distance
    np.testing.assert_array_equal(made, made.T)
    np.testing.assert_array_equal(np.diag(made), 0)


def test_refuses_the_matrix_of_other_takes(pair) -> None:
    with pytest.raises(ValueError, match=r"must be 24 x 27, as the takes, got 2 x 3"):
        shape_colour_refined(Dissimilarity(np.ones((2, 3))), pair)
