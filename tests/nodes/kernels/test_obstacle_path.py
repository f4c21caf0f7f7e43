import numpy as np
import pytest

from reperform.nodes.kernels.bezier import curve_of, through
from reperform.nodes.kernels.obstacle_path import Obstacles, around_obstacles, clearance

LINE = curve_of(through(np.array([[0.0, 0.0], [1.0, 6.0]])))


def test_distances_to_a_circle_and_to_a_turned_box():
    obstacles = Obstacles(np.array([[5.0, 1.0, 0.5]]), np.array([[0.0, 0.0, 2.0, 0.5, np.pi / 2]]))
    # turned by 90 degrees, the box is 0.5 m wide either way along x and 2 m along z
    places = np.array([[5.0, 2.0], [1.5, 0.3], [0.2, 3.0], [0.8, 2.4], [0.1, 0.4]])
    distance, way = clearance(obstacles, places)
    np.testing.assert_allclose(distance, [0.5, 1.0, 1.0, 0.5, -0.4], atol=1e-12)
    np.testing.assert_allclose(way[[0, 1, 2, 4]], [[0, 1], [1, 0], [0, 1], [1, 0]], atol=1e-12)


def test_the_way_out_is_the_gradient_of_the_distance():
    obstacles = Obstacles(np.array([[1.0, -0.4, 0.3]]), np.array([[-1.0, 0.5, 0.6, 0.2, 0.7]]))
    places = np.random.default_rng(3).uniform(-3, 3, (60, 2))
    _, way = clearance(obstacles, places)
    slope = np.stack(
        [
            (clearance(obstacles, places + d)[0] - clearance(obstacles, places - d)[0]) / 2e-6
            for d in 1e-6 * np.eye(2)
        ],
        axis=1,
    )
    np.testing.assert_allclose(way, slope, atol=1e-5)


def test_the_way_keeps_its_ends_and_the_margin_and_is_little_longer():
    obstacles = Obstacles(np.array([[0.45, 3.0, 0.4]]), np.array([[0.75, 4.6, 0.2, 0.2, 0.5]]))
    bent = around_obstacles(LINE, obstacles, 0.35)
    np.testing.assert_allclose(bent.point[[0, -1]], LINE.point[[0, -1]], atol=1e-9)
    assert clearance(obstacles, bent.point)[0].min() > 0.33
    assert bent.length < 1.15 * LINE.length


def test_where_nothing_is_near_the_curve_stays():
    assert around_obstacles(LINE, Obstacles(np.array([[4.0, 3.0, 0.5]])), 0.35) is LINE


def test_an_end_inside_an_obstacle_is_refused():
    with pytest.raises(ValueError, match=r"ends must be 0.35 m"):
        around_obstacles(LINE, Obstacles(np.array([[0.1, 0.2, 0.3]])), 0.35)
