from pathlib import Path

import cv2
import numpy as np

from reperform.nodes.capture.clean_plate import clean_plate
from reperform.nodes.capture.clips import clips


def test_noise_is_averaged_measured_and_a_passer_by_leaves_no_trace(tmp_path: Path) -> None:
    random = np.random.default_rng(7)
    y, x = np.mgrid[0:30, 0:44]
    truth = np.stack([60 + 2 * x, 90 + y, 150 - x - y], axis=2).astype(np.float64)
    for k in range(24):
        picture = truth + random.normal(0, [2, 4, 6], truth.shape)
        if 8 <= k < 12:
            picture[5:25, 10:20] = 240
        cv2.imwrite(str(tmp_path / f"{k}.png"), np.clip(picture, 0, 255).round().astype(np.uint8)[..., ::-1])
    plate = clean_plate(clips(folder=str(tmp_path), pattern="{frame}.png"), folder=str(tmp_path), pictures=24)
    assert plate.mean.shape == (1, 30, 44, 3)
    assert np.abs(plate.mean[0] - truth).mean() < 1.3
    assert np.abs(plate.mean[0, 5:25, 10:20] - truth[5:25, 10:20]).mean() < 2
    assert np.allclose(plate.deviation[0].mean(axis=(0, 1)), [2, 4, 6], rtol=0.2)


def test_the_deviation_is_never_zero(tmp_path: Path) -> None:
    for k in range(3):
        cv2.imwrite(str(tmp_path / f"{k}.png"), np.full((8, 10, 3), 77, np.uint8))
    plate = clean_plate(
        clips(folder=str(tmp_path), pattern="{frame}.png"), folder=str(tmp_path), least_deviation=1.5
    )
    assert np.all(plate.mean == 77)
    assert np.all(plate.deviation == 1.5)
