import numpy as np
import pytest

from reperform.nodes.products.footage import Film, Footage, Mattes
from reperform.nodes.texture.picture_error import picture_error

FPS = np.float32(25)


def test_an_offset_and_a_missing_half():
    images = np.full((2, 8, 10, 3), 90, np.uint8)
    alpha = np.zeros((2, 8, 10), np.uint8)
    alpha[1, :, 2:8] = 255
    coverage = alpha[1].copy()
    coverage[:, 5:] = 0
    picture = np.where(coverage[..., None] > 0, 80, 128).astype(np.uint8).repeat(3, -1)
    error = picture_error(Film(picture, coverage, FPS), Footage(images, FPS), Mattes(alpha, FPS), camera=1)
    squared = (10**2 + (128 - 90) ** 2) / 2
    assert error.psnr == pytest.approx(10 * np.log10(255**2 / squared), abs=1e-3)
    assert error.overlap == pytest.approx(0.5)


def test_refuses_a_camera_that_is_not_there():
    footage, mattes = (
        Footage(np.zeros((2, 4, 4, 3), np.uint8), FPS),
        Mattes(np.zeros((2, 4, 4), np.uint8), FPS),
    )
    film = Film(footage.images[0], mattes.alpha[0], FPS)
    with pytest.raises(ValueError, match="under 2"):
        picture_error(film, footage, mattes, camera=2)
