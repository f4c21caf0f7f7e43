import numpy as np
import pytest

from reperform.nodes.kernels.implicit_body import (
    Part,
    distance_grid,
    isosurface,
    nearest_part,
    part_bounds,
    part_coordinates,
    part_distance,
)
from reperform.nodes.kernels.mesh_geometry import volume


def ball(radius: float = 0.2, centre: tuple[float, float, float] = (0.1, 0.3, -0.05), **more) -> Part:
    up = (centre[0] + 0.3, centre[1] + 1, centre[2] + 0.2)
    return Part("ball", "skin", ("hips",), centre, up, radii=(radius,) * 3, **more)


def rod(**more) -> Part:
    return Part(
        "rod",
        "skin",
        ("hips",),
        (0.1, 0.2, 0.0),
        (0.4, 0.6, 0.3),
        half_u=(0.05, 0.05),
        half_w=(0.05, 0.05),
        **more,
    )


def test_the_distance_to_a_ball_is_exact():
    points = np.random.default_rng(0).uniform(-1, 1, (200, 3))
    expected = np.linalg.norm(points - (0.1, 0.3, -0.05), axis=1) - 0.2
    np.testing.assert_allclose(part_distance(points, ball()), expected, atol=1e-9)


def test_the_distance_to_a_round_rod_is_that_of_a_cylinder_with_flat_ends():
    part = rod()
    t, u, w = part_coordinates(np.random.default_rng(1).uniform(-0.5, 1, (300, 3)), part)
    points = np.random.default_rng(1).uniform(-0.5, 1, (300, 3))
    length = np.linalg.norm(np.subtract(part.end, part.start))
    across, along = np.hypot(u, w) - 0.05, np.maximum(-t, t - 1) * length
    expected = np.minimum(np.maximum(across, along), 0) + np.hypot(
        np.maximum(across, 0), np.maximum(along, 0)
    )
    np.testing.assert_allclose(part_distance(points, part), expected, atol=1e-9)


def test_an_ellipse_is_zero_on_itself_and_has_unit_slope_there():
    part = Part(
        "leg", "skin", ("hips",), (0, 0, 0), (0, 1, 0), half_u=(0.1, 0.1), half_w=(0.2, 0.2),
        shift_u=(0.03, 0.03), shift_w=(-0.02, -0.02),
    )  # fmt: skip
    angle = np.linspace(0, 6, 17)
    ring = np.column_stack([0.1 * np.cos(angle) + 0.03, np.full(17, 0.5), 0.2 * np.sin(angle) - 0.02])
    normal = np.column_stack([np.cos(angle) / 0.1, np.zeros(17), np.sin(angle) / 0.2])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    np.testing.assert_allclose(part_distance(ring, part), 0, atol=1e-12)
    np.testing.assert_allclose(part_distance(ring + 1e-4 * normal, part), 1e-4, rtol=0.01)


def test_folds_wave_the_section():
    part = rod(folds=5, fold_depth=(0.2, 0.2))
    t, u, w = part_coordinates(np.array([[0.25, 0.4, 0.15]]), part)
    assert t[0] == pytest.approx(0.5)
    angle = 2 * np.pi * np.arange(5) / 5
    frame = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    assert frame.shape == (5, 2) and u.shape == w.shape == (1,)
    distances = part_distance(np.random.default_rng(2).uniform(0, 0.6, (500, 3)), part)
    plain = part_distance(np.random.default_rng(2).uniform(0, 0.6, (500, 3)), rod())
    assert (np.sign(distances) != np.sign(plain)).any()
    assert np.abs(distances - plain).max() < 0.03


def test_bounds_hold_every_near_point():
    part = rod(shift_u=(0.02, -0.01), folds=3, fold_depth=(0.0, 0.3))
    low, high = part_bounds(part, 0.05)
    points = np.random.default_rng(3).uniform(-1, 1.5, (4000, 3))
    near = part_distance(points, part) < 0.05
    assert ((points[near] >= low) & (points[near] <= high)).all()


def test_the_surface_of_a_ball_has_its_volume_and_faces_outwards():
    lower, upper = np.array([-0.2, 0.0, -0.35]), np.array([0.4, 0.6, 0.25])
    vertices, faces = isosurface(distance_grid([ball()], lower, upper, 0.01), lower, 0.01)
    assert volume(vertices, faces) == pytest.approx(4 / 3 * np.pi * 0.2**3, rel=0.01)
    np.testing.assert_allclose(np.linalg.norm(vertices - (0.1, 0.3, -0.05), axis=1), 0.2, atol=5e-4)


def test_union_carving_and_floor():
    lower, upper = np.array([-0.5, -0.3, -0.5]), np.array([0.6, 0.7, 0.5])
    one, two = ball(), ball(0.15, (0.3, 0.35, 0.0), blend=0.02)

    def size(*parts: Part, floor: bool = False) -> float:
        vertices, faces = isosurface(distance_grid(parts, lower, upper, 0.01, floor), lower, 0.01)
        return float(volume(vertices, faces))

    both = size(one, two)
    assert max(size(one), size(two)) < both < size(one) + size(two)
    hole = ball(0.15, (0.3, 0.35, 0.0), blend=0.001, carve=True)
    assert size(one, hole) == pytest.approx(both - size(two), rel=0.05)
    sunk = ball(0.2, (0.0, 0.0, 0.0))
    assert size(sunk, floor=True) == pytest.approx(0.5 * size(sunk), rel=0.06)


def test_the_nearest_part_wins_and_a_hollow_belongs_to_nobody():
    one, two = ball(), ball(0.1, (0.5, 0.3, 0.0))
    owner, distances = nearest_part(np.array([[0.3, 0.3, -0.05], [0.41, 0.3, 0.0]]), [one, two])
    assert owner.tolist() == [0, 1] and distances.shape == (2, 2)
    hollow = ball(0.19, carve=True)
    _, distances = nearest_part(np.array([[0.1, 0.3, -0.05]]), [one, hollow])
    assert distances[0, 0] == pytest.approx(0.19)
