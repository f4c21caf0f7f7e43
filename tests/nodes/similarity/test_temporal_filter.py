import numpy as np
import pytest

from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.similarity.temporal_filter import temporal_filter


def _matrix(seed, rows, columns):
    return np.random.default_rng(seed).random((rows, columns)).astype(np.float32)


def test_adaptive_is_the_least_weighted_mean_over_windows():
    d = _matrix(0, 7, 9)
    filtered = temporal_filter(Dissimilarity(d), shortest=2, longest=4).distance
    for r, c in ((3, 4), (0, 5), (6, 2)):
        means = []
        for half in (2, 3, 4):
            inside = [k for k in range(-half, half + 1) if 0 <= r + k < 7 and 0 <= c + k < 9]
            weight = np.array([half - abs(k) for k in inside])
            means.append(weight @ [d[r + k, c + k] for k in inside] / weight.sum())
        np.testing.assert_allclose(filtered[r, c], min(means), rtol=1e-6)


def test_plain_is_the_mean_along_the_diagonal():
    d = _matrix(1, 6, 5)
    filtered = temporal_filter(Dissimilarity(d), kind="plain", longest=2).distance
    np.testing.assert_allclose(filtered[2, 2], np.mean([d[k, k] for k in range(5)]), rtol=1e-6)


def test_keeps_constants_and_never_grows_with_longer_windows():
    constant = Dissimilarity(np.full((8, 6), 0.3, np.float32))
    for kind in ("plain", "adaptive"):
        np.testing.assert_allclose(temporal_filter(constant, kind=kind).distance, 0.3, rtol=1e-6)
    d = Dissimilarity(_matrix(2, 12, 12))
    short, long = (temporal_filter(d, shortest=1, longest=n).distance for n in (3, 6))
    assert (long <= short + 1e-7).all()


def test_refuses_windows_upside_down():
    with pytest.raises(ValueError, match="must not be below shortest"):
        temporal_filter(Dissimilarity(_matrix(0, 3, 3)), shortest=5, longest=4)
