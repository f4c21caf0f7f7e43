import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.foot_hold import contacts, hold_feet, hold_points, leg_fields
from reperform.nodes.kernels.mesh_geometry import volume

FPS = 25.0


@pytest.fixture(scope="module")
def body() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """An upright ellipsoid off the origin, and its lowest vertices as its only foot."""
    mesh = trimesh.creation.icosphere(subdivisions=3)
    rest = np.asarray(mesh.vertices) * [0.2, 0.85, 0.13] + [0.3, 0.86, -0.1]
    foot = np.where(rest[:, 1] < 0.05, 0, -1).astype(np.int8)
    return rest, np.asarray(mesh.faces), foot


def sliding(frames: int) -> np.ndarray:
    """A way (frames, 3) that never stands still, m."""
    t = np.arange(frames) / FPS
    return np.stack([0.05 * np.sin(3 * t), 0.01 * np.cos(5 * t), 0.1 * t - 0.03 * np.cos(4 * t)], axis=1)


def test_contacts_are_the_runs_of_each_foot() -> None:
    planted = np.array([[1, 0], [1, 1], [0, 1], [1, 0]], bool)
    assert [tuple(c) for c in contacts(planted)] == [(0, 0, 1), (0, 3, 3), (1, 1, 2)]


def test_a_held_point_stands_still_and_nothing_pops() -> None:
    way, planted = sliding(60), np.zeros(60, bool)
    planted[12:22] = planted[35:50] = True
    held = way + hold_points(way, planted, FPS)
    for first, last in ((12, 21), (35, 49)):
        assert np.ptp(held[first : last + 1], axis=0).max() < 1e-12
    # stopping what slides costs its speed; it is spread over several frames
    fastest = np.linalg.norm(np.diff(way, axis=0), axis=1).max()
    assert np.linalg.norm(np.diff(held, n=2, axis=0), axis=1).max() < fastest


def test_the_correction_dies_out_and_needs_no_more_than_the_slide() -> None:
    way, planted = sliding(80), np.zeros(80, bool)
    planted[30:40] = True
    shift = hold_points(way, planted, FPS, 0.12)
    assert np.linalg.norm(shift, axis=1).max() <= np.linalg.norm(np.ptp(way[30:40], axis=0))
    assert np.linalg.norm(shift[:10], axis=1).max() < 5e-4
    assert np.linalg.norm(shift[60:], axis=1).max() < 5e-4


def test_it_is_the_minimum_of_its_energy_among_all_shifts_that_hold() -> None:
    way, planted = sliding(30), np.zeros(30, bool)
    planted[[*range(5, 11), *range(18, 30)]] = True
    best = hold_points(way, planted, FPS, 0.2)

    def energy(shift: np.ndarray) -> float:
        return float((np.diff(shift, n=2, axis=0) ** 2).sum() + (0.2 * FPS) ** -4 * (shift**2).sum())

    random = np.random.default_rng(1)
    for _ in range(40):
        other = random.normal(0, 0.002, way.shape)
        other[5:11], other[18:30] = other[5], other[18]
        assert energy(best + other) >= energy(best)


def test_a_foot_that_already_stands_is_left_alone() -> None:
    planted = np.ones(9, bool)
    still = np.tile([0.2, 0.02, 1.0], (9, 1))
    assert np.abs(hold_points(still, planted, FPS)).max() < 1e-12
    assert (hold_points(sliding(9), ~planted, FPS) == 0).all()


def test_fields_are_one_on_the_foot_and_nothing_above_the_hip(
    body: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    rest, faces, foot = body
    (field,) = leg_fields(rest, faces, foot)
    assert field[foot == 0].min() > 0.99
    assert field[rest[:, 1] > 1.1].max() == 0.0
    ends = trimesh.Trimesh(rest, faces, process=False).edges_unique
    assert np.abs(field[ends[:, 0]] - field[ends[:, 1]]).max() < 0.3


def test_the_mesh_follows_its_held_foot_and_keeps_its_volume(
    body: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    rest, faces, foot = body
    vertices = (rest + sliding(50)[:, None]).astype(np.float32)
    planted = np.zeros((50, 1), bool)
    planted[10:25] = True
    held = hold_feet(vertices, foot, planted, leg_fields(rest, faces, foot), FPS)
    sole = held[10:25, foot == 0].astype(float)
    assert np.linalg.norm(np.diff(sole, axis=0), axis=2).max() * FPS < 0.01
    np.testing.assert_array_equal(held[:, rest[:, 1] > 1.1], vertices[:, rest[:, 1] > 1.1])
    assert np.abs(volume(held, faces) / volume(vertices, faces) - 1).max() < 0.01
    assert held.dtype == np.float32
