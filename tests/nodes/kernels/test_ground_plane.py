import numpy as np
import pytest

from reperform.nodes.kernels import ground_plane


def test_a_known_placement_is_found_whatever_the_weights() -> None:
    rng = np.random.default_rng(3)
    points = rng.normal(size=(40, 3)) * [0.4, 1.1, 0.2] + [1.0, 0.9, -2.0]
    truth = ground_plane.Placement(2.4, np.array([0.7, -1.9]))
    moved = ground_plane.apply(points, ground_plane.inverse(truth))
    found, cost = ground_plane.align(points, moved, rng.uniform(0.1, 3.0, size=40))
    assert found.yaw == pytest.approx(2.4, abs=1e-12)
    np.testing.assert_allclose(found.offset, truth.offset, atol=1e-12)
    assert cost < 1e-24


def test_it_is_the_minimum_among_many_placements() -> None:
    rng = np.random.default_rng(5)
    points, moved = rng.normal(size=(15, 3)), rng.normal(size=(15, 3))
    weights = rng.uniform(size=15)
    best, cost = ground_plane.align(points, moved, weights)
    for _ in range(200):
        other = ground_plane.Placement(
            best.yaw + rng.normal(scale=0.2), best.offset + rng.normal(scale=0.1, size=2)
        )
        gap = points - ground_plane.apply(moved, other)
        assert cost <= weights @ (gap**2).sum(1) + 1e-12


def test_compose_is_one_after_the_other_and_by_hand() -> None:
    quarter = ground_plane.Placement(np.pi / 2, np.array([1.0, 0.0]))
    # R_y(90 deg) takes +x to -z
    np.testing.assert_allclose(
        ground_plane.apply(np.array([[2.0, 5.0, 0.0]]), quarter), [[1.0, 5.0, -2.0]], atol=1e-12
    )
    other = ground_plane.Placement(-0.4, np.array([0.2, 3.0]))
    points = np.random.default_rng(0).normal(size=(6, 3))
    np.testing.assert_allclose(
        ground_plane.apply(points, ground_plane.compose(quarter, other)),
        ground_plane.apply(ground_plane.apply(points, other), quarter),
        atol=1e-12,
    )


def test_points_on_one_vertical_line_are_not_turned() -> None:
    points = np.array([[1.0, 0.0, 2.0], [1.0, 1.0, 2.0]])
    placement, _ = ground_plane.align(points + [0.5, 0.0, 0.0], points)
    assert placement.yaw == 0.0
    np.testing.assert_allclose(placement.offset, [0.5, 0.0])


def test_wrong_shapes_and_weights_are_refused() -> None:
    with pytest.raises(ValueError, match="one length"):
        ground_plane.align(np.zeros((3, 3)), np.zeros((4, 3)))
    with pytest.raises(ValueError, match="positive sum"):
        ground_plane.align(np.zeros((3, 3)), np.zeros((3, 3)), np.zeros(3))
