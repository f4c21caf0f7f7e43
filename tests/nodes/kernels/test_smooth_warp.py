import numpy as np
import pytest

from reperform.nodes.kernels.smooth_warp import smooth_warp

STALLS = np.array(
    [
        (3, 10),
        (4, 11),
        (5, 11),
        (6, 11),
        (7, 12),
        (7, 13),
        (7, 14),
        (8, 15),
        (9, 16),
        (10, 17),
        (11, 17),
        (12, 18),
    ]
)


def test_a_path_in_step_comes_back_as_it_is():
    path = np.column_stack([np.arange(4, 16), np.arange(20, 32)])
    np.testing.assert_allclose(smooth_warp(path), path, atol=1e-9)


def test_ends_are_kept_and_time_never_runs_backwards():
    warp = smooth_warp(STALLS)
    np.testing.assert_array_equal(warp[[0, -1]], STALLS[[0, -1]])
    assert (np.diff(warp, axis=0) >= 0).all()
    assert np.abs(warp - STALLS).max() < 2.0


def test_it_bends_less_than_what_was_found_and_keeps_the_captured_rate_where_it_leaves_and_enters():
    warp = smooth_warp(STALLS)
    assert np.abs(np.diff(warp, 2, axis=0)).max() < 0.5 * np.abs(np.diff(STALLS, 2, axis=0)).max()
    assert abs(warp[1, 0] - warp[0, 0] - 1.0) < 0.15
    assert abs(warp[-1, 1] - warp[-2, 1] - 1.0) < 0.15


def test_it_is_the_same_run_backwards():
    mirrored = (STALLS[-1] - STALLS[::-1])[:, ::-1]
    there, back = smooth_warp(STALLS), smooth_warp(mirrored)
    np.testing.assert_allclose((STALLS[-1] - there[::-1])[:, ::-1], back, atol=1e-12)


def test_a_path_that_runs_backwards_is_refused():
    with pytest.raises(ValueError, match="never runs backwards"):
        smooth_warp(np.array([(3, 4), (2, 5), (3, 6)]))
