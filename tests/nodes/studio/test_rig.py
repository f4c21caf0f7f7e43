import numpy as np
import pytest

from reperform.nodes.kernels.camera import centre, project
from reperform.nodes.studio.rig import rig


def stage(radius: float, height: float) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, 50)
    ring = np.column_stack([radius * np.sin(angle), 0 * angle, radius * np.cos(angle)])
    return np.concatenate([ring, ring + (0, height, 0)])


@pytest.mark.parametrize(
    ("radius", "width", "stage_radius"), [(4.0, 960, 1.5), (8.0, 640, 2.2), (3.0, 400, 0.4)]
)
def test_every_camera_keeps_the_stage_in_frame_and_one_fills_its_picture(radius, width, stage_radius):
    cameras = rig(radius=radius, width=width, picture_height=540, stage_radius=stage_radius)
    margins = []
    for k in range(8):
        pixels, depth = project(stage(stage_radius, 2.0), *(field[k] for field in cameras[:3]))
        assert (depth > 0).all()
        assert (pixels >= 0).all() and (pixels <= (width - 1, 539)).all()
        margins.append(min(pixels.min(), (np.array([width - 1, 539]) - pixels).min()))
    assert min(margins) < 0.03 * width


def test_an_even_rig_stands_on_its_circle_and_looks_inwards():
    cameras = rig(cameras=5, unevenness=0.0)
    eyes = np.array([centre(r, t) for r, t in zip(cameras.rotation, cameras.translation, strict=True)])
    np.testing.assert_allclose(np.hypot(eyes[:, 0], eyes[:, 2]), 4.0)
    np.testing.assert_allclose(eyes[:, 1], 2.4)
    azimuth = np.unwrap(np.arctan2(eyes[:, 0], eyes[:, 2]))
    np.testing.assert_allclose(np.diff(azimuth), 2 * np.pi / 5)
    for rotation, translation in zip(cameras.rotation, cameras.translation, strict=True):
        assert np.linalg.det(rotation) == pytest.approx(1)
        assert (rotation @ [0, 1.0, 0] + translation)[2] > 0
        # the horizon is level: the picture's x axis is horizontal
        assert abs(rotation[0, 1]) < 1e-12


def test_the_default_rig_has_no_symmetry_and_its_seed_decides():
    cameras = rig()
    eyes = np.array([centre(r, t) for r, t in zip(cameras.rotation, cameras.translation, strict=True)])
    distances = np.hypot(eyes[:, 0], eyes[:, 2])
    assert len(np.unique(np.round(distances, 3))) == 8
    assert np.array_equal(rig().translation, cameras.translation)
    assert not np.array_equal(rig(seed=2).translation, cameras.translation)


def test_a_camera_on_the_stage_is_refused():
    with pytest.raises(ValueError, match=r"off the stage of radius 3\.0 m.*raise radius"):
        rig(radius=2.0, stage_radius=3.0)
