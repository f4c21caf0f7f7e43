import numpy as np
import pytest
from scipy.stats import spearmanr

from reperform.nodes.evaluate.rank_correlation import rank_correlation
from reperform.nodes.products.motion import Dissimilarity


def matrices(seed: int, **shapes: tuple[int, int]) -> dict[tuple[str, str], Dissimilarity]:
    rng = np.random.default_rng(seed)
    return {
        (pair[0], pair[1]): Dissimilarity(rng.uniform(size=shape).astype(np.float32))
        for pair, shape in shapes.items()
    }


def test_pooled_and_single_pairs_agree_with_scipy():
    ours, theirs = matrices(0, ab=(5, 7), ba=(7, 5)), matrices(1, ab=(5, 7), ba=(7, 5))
    found = rank_correlation(ours, theirs)
    assert found.name.tolist() == ["all", "mean", "least"]
    flat = [np.concatenate([m.distance.ravel() for m in side.values()]) for side in (ours, theirs)]
    single = [spearmanr(ours[p].distance.ravel(), theirs[p].distance.ravel()).statistic for p in ours]
    expected = [spearmanr(*flat).statistic, np.mean(single), np.min(single)]
    np.testing.assert_allclose(found.value[0], expected)


def test_any_rising_function_of_the_reference_has_correlation_one():
    theirs = matrices(2, ab=(6, 4), aa=(6, 6))
    ours = {pair: Dissimilarity(np.exp(3 * m.distance)) for pair, m in theirs.items()}
    np.testing.assert_allclose(rank_correlation(ours, theirs).value, 1.0)


def test_a_frame_against_itself_does_not_count():
    theirs = matrices(3, aa=(5, 5))
    changed = theirs["a", "a"].distance + 100 * np.eye(5, dtype=np.float32)
    found = rank_correlation({("a", "a"): Dissimilarity(changed)}, theirs)
    np.testing.assert_allclose(found.value, 1.0)


def test_a_constant_matrix_has_no_correlation():
    theirs = matrices(4, ab=(3, 3))
    flat = {("a", "b"): Dissimilarity(np.ones((3, 3), np.float32))}
    assert np.isnan(rank_correlation(flat, theirs).value[0, 0])


def test_other_pairs_and_shapes_are_refused():
    with pytest.raises(ValueError, match="same pairs of takes, one lacks a-c"):
        rank_correlation(matrices(5, ab=(3, 3), ac=(3, 3)), matrices(6, ab=(3, 3)))
    with pytest.raises(ValueError, match="one shape"):
        rank_correlation(matrices(5, ab=(3, 3)), matrices(6, ab=(3, 4)))
