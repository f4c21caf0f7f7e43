from pathlib import Path

import cv2
import numpy as np
import pytest

from reperform.nodes.capture.calibration import calibration
from reperform.nodes.capture.chroma_key import chroma_key
from reperform.nodes.capture.clips import clips
from reperform.nodes.capture.decode import decode
from reperform.nodes.capture.refine_calibration import refine_calibration
from reperform.nodes.kernels.silhouette import intersection_over_union, silhouette
from reperform.nodes.products.clips import Clips
from reperform.nodes.products.footage import Footage, Mattes
from reperform.nodes.surface.isosurface import isosurface
from reperform.nodes.surface.occupancy import occupancy

FPS = np.float32(25)
BLUE, GREEN, TEAL = (40, 80, 180), (50, 170, 70), (50, 120, 150)


def studio(
    backing: tuple[int, int, int], noise: float = 3, light: float = 0.35
) -> tuple[np.ndarray, np.ndarray]:
    """An oblong picture of a slanted figure of three colours, spilt on, before an uneven screen; true alpha."""
    height, width = 270, 480
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    big = np.zeros((4 * height, 4 * width), np.uint8)
    cv2.ellipse(big, (900, 560), (150, 380), 12, 0, 360, 255, -1)
    cv2.ellipse(big, (980, 180), (80, 100), 0, 0, 360, 255, -1)
    cv2.line(big, (880, 420), (620, 640), 255, 40)
    alpha = cv2.resize(big, (width, height), interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    brightness = 1 - light * (x / width) + 0.1 * np.sin(y / 30)
    screen = brightness[..., None] * np.array(backing, np.float32)
    figure = np.empty_like(screen)
    figure[:] = (190, 150, 60)
    figure[y < 70] = (45, 32, 28)
    figure[(y > 150) & (y < 200)] = (120, 118, 116)
    figure = 0.88 * figure + 0.12 * np.array(backing, np.float32)
    picture = alpha[..., None] * figure + (1 - alpha[..., None]) * screen
    # rig along the top edge
    picture[:14, 100:380] = (35, 33, 32)
    picture += np.random.default_rng(5).normal(0, noise, picture.shape)
    return np.clip(picture, 0, 255).round().astype(np.uint8), alpha


@pytest.mark.parametrize("backing", [BLUE, GREEN, TEAL])
def test_a_figure_before_an_uneven_noisy_screen_is_found(backing: tuple[int, int, int]) -> None:
    picture, truth = studio(backing)
    alpha = chroma_key(Footage(picture, FPS)).alpha
    assert alpha.dtype == np.uint8
    assert intersection_over_union(alpha > 127, truth > 0.5) > 0.985
    soft = (truth > 0) & (truth < 1)
    assert np.abs(alpha[soft] / 255.0 - truth[soft]).mean() < 0.12
    assert abs((alpha[soft] / 255.0 - truth[soft]).mean()) < 0.05
    assert np.all(alpha[:14] == 0)


def test_an_empty_set_gives_an_empty_matte() -> None:
    height, width = 135, 240
    screen = np.full((height, width, 3), BLUE, np.float64)
    screen += np.random.default_rng(1).normal(0, 4, screen.shape)
    alpha = chroma_key(Footage(np.clip(screen, 0, 255).astype(np.uint8), FPS)).alpha
    assert not alpha.any()


def test_a_picture_without_a_backing_is_refused() -> None:
    grey = np.random.default_rng(2).integers(90, 100, (60, 80, 1)).astype(np.uint8).repeat(3, axis=2)
    with pytest.raises(ValueError, match="no blue or green backing"):
        chroma_key(Footage(grey, FPS))


def test_the_blue_share_is_a_baseline() -> None:
    picture, truth = studio(BLUE)
    alpha = chroma_key(Footage(picture, FPS), method="blue_dominance").alpha
    learnt = chroma_key(Footage(picture, FPS)).alpha
    share = intersection_over_union(alpha > 127, truth > 0.5)
    assert 0.9 < share <= intersection_over_union(learnt > 127, truth > 0.5)


def test_real_mattes_agree_between_eight_cameras(data_folder: Path) -> None:
    folder = data_folder / "captures" / "surrey_dancer8"
    index = clips(folder=str(folder), pattern="cam{camera}.png")
    cameras = calibration(file=str(folder / "calibration.txt"))
    alpha = np.stack(
        [
            chroma_key(
                decode(
                    Clips(*(part[0, c] for part in index[:3]), index.image_size[c], index.name[c], index.fps),
                    folder=str(folder),
                )
            ).alpha
            for c in range(8)
        ]
    )
    mattes = Mattes(alpha[None], index.fps)
    cameras = refine_calibration({"dance": mattes}, {"dance": cameras}, sweeps=2)["dance"]
    surface = isosurface(occupancy(mattes._replace(alpha=alpha), cameras))
    shares = [
        intersection_over_union(
            silhouette(surface.vertices, surface.faces, *(part[c] for part in cameras[:4]), 1080, 1920),
            alpha[c] > 127,
        )
        for c in range(8)
    ]
    assert np.mean(shares) > 0.93
    assert min(shares) > 0.88
    assert 1.5 < np.ptp(surface.vertices[:, 1]) < 1.58
