from pathlib import Path

import cv2
import numpy as np
import pytest

from reperform.nodes.capture.background_difference import background_difference
from reperform.nodes.capture.calibration import calibration
from reperform.nodes.capture.clean_plate import clean_plate
from reperform.nodes.capture.clips import clips
from reperform.nodes.capture.decode import decode
from reperform.nodes.kernels.silhouette import intersection_over_union, silhouette
from reperform.nodes.products.clips import Clips
from reperform.nodes.products.footage import CleanPlate, Footage, Mattes
from reperform.nodes.surface.isosurface import isosurface
from reperform.nodes.surface.occupancy import occupancy

FPS = np.float32(50)


def scene() -> tuple[np.ndarray, CleanPlate, np.ndarray]:
    """A figure on a green floor before a pale wall, with its shadow on the floor; the plate; the true alpha."""
    height, width = 200, 320
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    plate = np.where((y > 110)[..., None], np.array([30, 120, 80.0]), np.array([200, 205, 198.0]))
    plate = plate * (1 - 0.2 * x / width)[..., None]
    big = np.zeros((4 * height, 4 * width), np.uint8)
    cv2.ellipse(big, (560, 440), (110, 260), -8, 0, 360, 255, -1)
    alpha = cv2.resize(big, (width, height), interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    shadow = np.where(((x - 190) / 60) ** 2 + ((y - 172) / 14) ** 2 < 1, 0.65, 1.0)
    figure = np.where((y > 90)[..., None], np.array([60, 62, 66.0]), np.array([140, 110, 90.0]))
    picture = alpha[..., None] * figure + (1 - alpha[..., None]) * plate * shadow[..., None]
    picture += np.random.default_rng(4).normal(0, 2, picture.shape)
    deviation = np.full(plate.shape, 2, np.float32)
    return (
        np.clip(picture, 0, 255).round().astype(np.uint8),
        CleanPlate(plate.astype(np.float32), deviation),
        alpha,
    )


def test_the_figure_is_found_and_its_shadow_is_not() -> None:
    picture, plate, truth = scene()
    alpha = background_difference(Footage(picture, FPS), plate).alpha
    assert intersection_over_union(alpha > 127, truth > 0.5) > 0.98
    without = background_difference(Footage(picture, FPS), plate, shadow=1.0).alpha
    assert np.count_nonzero(without > 127) > 1.1 * np.count_nonzero(alpha > 127)


def test_the_empty_set_gives_an_empty_matte() -> None:
    _, plate, _ = scene()
    noise = np.random.default_rng(6).normal(0, 2, plate.mean.shape)
    picture = np.clip(plate.mean + noise, 0, 255).round().astype(np.uint8)
    assert not background_difference(Footage(picture, FPS), plate).alpha.any()


def test_a_plate_of_another_size_is_refused() -> None:
    picture, plate, _ = scene()
    with pytest.raises(ValueError, match=r"must have one size, got 300x200 and 320x200"):
        background_difference(Footage(picture[:, :300], FPS), plate)


def test_real_mattes_agree_between_four_cameras(data_folder: Path) -> None:
    folder = str(data_folder / "captures" / "utrecht_seated4")
    empty = clips(folder=folder, pattern="cam{camera}/background.avi", count=132)
    plate = clean_plate(empty, folder=folder, pictures=15)
    index = clips(folder=folder, pattern="cam{camera}/video.avi")
    cameras = calibration(file=folder, scale=0.001, up="z", width=644, height=486)
    alpha = []
    for c in range(4):
        view = Clips(*(part[100, c] for part in index[:3]), index.image_size[c], index.name[c], index.fps)
        footage = decode(view, folder=folder)
        alpha.append(background_difference(footage, CleanPlate(plate.mean[c], plate.deviation[c])).alpha)
    surface = isosurface(occupancy(Mattes(np.stack(alpha), index.fps), cameras))
    shares = [
        intersection_over_union(
            silhouette(surface.vertices, surface.faces, *(part[c] for part in cameras[:4]), 486, 644),
            alpha[c] > 127,
        )
        for c in range(4)
    ]
    assert np.mean(shares) > 0.95
    assert 1.36 < surface.vertices[:, 1].max() < 1.43
