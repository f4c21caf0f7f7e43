"""The reach along a surface: its scale, its indifference to bending, and that a false join lessens it."""

import numpy as np
import pytest

from reperform.nodes.kernels.geodesic_reach import geodesic_reach


def _tube(centres, radius=0.05, around=12):
    """A closed tube round a line of centres (N, 3), its rings level with the plane x z or turned with the line."""
    step = np.gradient(centres, axis=0)
    step /= np.linalg.norm(step, axis=1, keepdims=True)
    side = np.cross(step, [0, 0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, step)
    angle = np.linspace(0, 2 * np.pi, around, endpoint=False)
    rings = centres[:, None] + radius * (
        np.cos(angle)[:, None] * side[:, None] + np.sin(angle)[:, None] * up[:, None]
    )
    points = np.concatenate([rings.reshape(-1, 3), centres[[0, -1]]])
    faces, last = [], len(centres) - 1
    for r in range(last):
        for a in range(around):
            b = (a + 1) % around
            i, j, k, m = r * around + a, r * around + b, (r + 1) * around + a, (r + 1) * around + b
            faces += [[i, k, j], [j, k, m]]
    for a in range(around):
        b = (a + 1) % around
        faces += [[len(points) - 2, a, b], [len(points) - 1, last * around + b, last * around + a]]
    return points, np.array(faces)


def _arc(turn, count=60):
    """A line 1.044 long that turns by so much about the vertical and rises, so that it begins at its lowest end."""
    s = np.linspace(0, 1, count)
    level = [0 * s, s] if turn == 0 else [(1 - np.cos(turn * s)) / turn, np.sin(turn * s) / turn]
    return np.column_stack([level[0], 0.3 * s, level[1]])


def test_it_does_not_depend_on_size():
    points, faces = _tube(_arc(0.3))
    assert geodesic_reach(3.7 * points, faces) == pytest.approx(geodesic_reach(points, faces))


def test_bending_hardly_matters():
    straight, bent = (geodesic_reach(*_tube(_arc(turn)), count=2) for turn in (0.0, 2.0))
    assert bent == pytest.approx(straight, rel=0.06)


def test_the_first_two_points_of_a_tube_are_its_ends():
    points, faces = _tube(_arc(0.0))
    size = 1.044 * 12 / 2 * np.sin(2 * np.pi / 12) * 0.05**2
    assert geodesic_reach(points, faces, count=1) == pytest.approx(1.094 / size ** (1 / 3), rel=0.06)


def test_a_false_join_lessens_it():
    points, faces = _tube(_arc(5.5))
    apart = geodesic_reach(points, faces, count=1)
    # two triangles from one end of the ring to the other
    bridge = np.array([[3, 12 * 59 + 3, 12 * 59 + 4], [3, 12 * 59 + 4, 4]])
    assert geodesic_reach(points, np.concatenate([faces, bridge]), count=1) < 0.8 * apart
