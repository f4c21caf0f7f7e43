import numpy as np
import pytest

from reperform.nodes.texture.turntable import turntable


def test_goes_round_once(scene):
    film = turntable(
        scene.footage,
        scene.mattes,
        scene.cameras,
        scene.mesh,
        frame=1,
        views=5,
        width=120,
        picture_height=160,
    )
    assert film.images.shape == (5, 160, 120, 3)
    assert film.fps == 25
    share = (film.coverage > 0).mean(axis=(1, 2))
    assert (share > 0.03).all()
    assert np.ptp(share) > 0.01
    # the body stays in the middle
    x = [np.nonzero(picture)[1].mean() for picture in film.coverage]
    np.testing.assert_allclose(x, 59.5, atol=6)


def test_refuses_a_frame_that_is_not_there(scene):
    with pytest.raises(ValueError, match="frame must be under 2, got 2"):
        turntable(scene.footage, scene.mattes, scene.cameras, scene.mesh, frame=2)
