import numpy as np
import pytest

from reperform.nodes.blend.time_warp import time_warp
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.performance import Contacts

FACES = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
REST = np.random.default_rng(4).normal(size=(20, 3)) * [0.3, 0.9, 0.2]


def performed(phase: np.ndarray, yaw: float = 0.0) -> MeshSequence:
    """A body at moments (T,) of one motion that never repeats, placed anywhere."""
    bend = np.stack([np.sin(2.1 * phase), phase**2, np.cos(3.3 * phase)], axis=1)
    points = REST[None] + 0.4 * bend[:, None] * REST[None, :, [1, 2, 0]]
    placed = apply(points, Placement(yaw, np.array([1.0, -2.0])))
    return MeshSequence(placed.astype(np.float32), FACES, np.asarray(25.0, np.float32))


def test_the_pace_of_a_motion_is_found():
    slow, pace = np.linspace(0, 1, 61), np.linspace(0, 1, 37) ** 1.4
    warp = time_warp((performed(slow), performed(pace, 1.9)), velocity_weight=0.0)
    expected = 36 * slow ** (1 / 1.4)
    assert np.abs(warp.other - expected)[4:].max() < 1.0
    assert np.abs(warp.other - expected)[4:].mean() < 0.35
    assert warp.other[[0, -1]].tolist() == [0, 36]
    assert (np.diff(warp.other) > 0).all()
    assert warp.cost < 0.05


def test_keys_and_contacts_are_met_exactly():
    a, b = performed(np.linspace(0, 1, 41)), performed(np.linspace(0, 1, 31))
    assert time_warp((a, b), keys=("0.4:0.6", "1.2:0.8")).other[[10, 30]].tolist() == [15, 20]
    feet = [np.ones((n, 2), bool) for n in (41, 31)]
    feet[0][12:25, 0] = feet[1][7:20, 0] = False
    warp = time_warp((a, b), (Contacts(feet[0]), Contacts(feet[1])))
    assert warp.other[[11, 24]].tolist() == [6, 19]


def test_a_take_is_in_step_with_itself():
    take = performed(np.linspace(0, 1, 20))
    warp = time_warp((take, take))
    assert warp.other == pytest.approx(np.arange(20.0))
    assert warp.cost == pytest.approx(0, abs=1e-6)


def test_errors_say_what_to_do():
    a = performed(np.linspace(0, 1, 9))
    with pytest.raises(ValueError, match="FIRST:SECOND"):
        time_warp((a, a), keys=("0.1",))
    with pytest.raises(ValueError, match="FIRST:SECOND"):
        time_warp((a, a), keys=("a:b",))
    with pytest.raises(ValueError, match="must rise"):
        time_warp((a, a), keys=("0.2:0.1", "0.1:0.2"))
    with pytest.raises(ValueError, match="one topology"):
        time_warp((a, MeshSequence(a.vertices, FACES[:1], a.fps)))
