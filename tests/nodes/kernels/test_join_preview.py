import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, align, apply
from reperform.nodes.kernels.join_acceleration import frame_accelerations
from reperform.nodes.kernels.join_preview import captured_acceleration, preview_join
from reperform.nodes.kernels.path_frames import ease

HALF, M, N = 5, 12, 9


@pytest.fixture
def takes() -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(6)
    rest = random.normal(size=(101, 3)) * [0.3, 0.8, 0.2]
    time = np.arange(30)[:, None, None] / 25
    first = rest + time * [0.4, 0.0, 1.0] + 0.05 * np.sin(7 * time + rest[:, :1])
    second = rest + time * [0.1, 0.0, 1.2] + 0.04 * np.sin(6 * time + 1 + rest[:, 1:2])
    return first, apply(second, Placement(1.9, np.array([3.0, -2.0])))


def _preview(takes: tuple[np.ndarray, np.ndarray], enough: float = np.inf) -> tuple[float, ...]:
    captured = captured_acceleration(list(takes))
    return preview_join(*takes, M, N, HALF, np.ones(101), captured, enough)


def test_the_placement_is_that_of_the_window(takes: tuple[np.ndarray, np.ndarray]) -> None:
    window = np.arange(1 - HALF, HALF)
    weights = np.repeat(HALF - np.abs(window), 101)
    truth, _ = align(takes[0][M + window].reshape(-1, 3), takes[1][N + window].reshape(-1, 3), weights)
    yaw, x, z, _ = _preview(takes)
    assert yaw == pytest.approx(truth.yaw)
    np.testing.assert_allclose([x, z], truth.offset)


def test_the_jerk_is_what_the_linear_blend_does(takes: tuple[np.ndarray, np.ndarray]) -> None:
    yaw, x, z, jerk = _preview(takes)
    window = np.arange(-HALF, HALF + 1)
    weight = ease(HALF)[:, None, None]
    placed = apply(takes[1], Placement(yaw, np.array([x, z])))
    blend = np.concatenate([
        takes[0][M - HALF - 2 : M - HALF],
        (1 - weight) * takes[0][M + window] + weight * placed[N + window],
        placed[N + HALF + 1 : N + HALF + 3],
    ])  # fmt: skip
    ratios = [
        np.nanmax(frame_accelerations(blend, 1.0, q))
        / np.quantile(np.concatenate([frame_accelerations(take, 1.0, q)[1:-1] for take in takes]), 0.99)
        for q in (0.5, 0.99)
    ]
    assert jerk == pytest.approx(max(ratios), rel=1e-6)


def test_it_stops_where_it_is_too_hard(takes: tuple[np.ndarray, np.ndarray]) -> None:
    jerk = _preview(takes)[3]
    assert np.isinf(_preview(takes, 0.9 * jerk)[3])
    assert _preview(takes, 1.1 * jerk)[3] == jerk


def test_a_still_capture_has_a_floor() -> None:
    np.testing.assert_array_equal(captured_acceleration([np.zeros((5, 3, 3)), np.zeros((2, 3, 3))]), 1e-9)
