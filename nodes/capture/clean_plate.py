"""The empty set, learnt from footage of it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.picture_reader import read_picture
from reperform.nodes.products.clips import Clips
from reperform.nodes.products.footage import CleanPlate


@node(over="take", memory=1.0)
def clean_plate(
    clips: Clips,
    *,
    folder: Annotated[str, File("the folder that the clips were indexed in", in_key=False)],
    pictures: Annotated[int, Param("frame", 1, 1000, "pictures used per camera, evenly spread")] = 25,
    least_deviation: Annotated[float, Param("1/255", 0.1, 20, "deviation assumed at least")] = 1.0,
) -> CleanPlate:
    """Midmean picture of each camera's empty set and its spread, robust to what passes for a moment.

    clips: footage without performer. mean (camera, y, x, 3) is the mean of the middle half of the values of `pictures`
    frames; deviation is 1.4826 times the median absolute deviation from it, at least `least_deviation`.

    Source: 004 section 2.2 (foreground extraction); Rousseeuw and Croux 1993, JASA (median absolute deviation).
    Departure: midmean instead of mean, so that a person who walks through for a few frames leaves no trace.
    """
    frames = len(clips.position)
    chosen = np.unique(np.linspace(0, frames - 1, min(pictures, frames)).round().astype(int))
    means, deviations = [], []
    for camera in range(len(clips.name)):
        width, height = (int(n) for n in clips.image_size[camera])
        stack = np.stack(
            [
                read_picture(
                    Path(folder) / str(clips.file[k, camera]), int(clips.position[k, camera]), (width, height)
                )
                for k in chosen
            ]
        )
        mean, deviation = _median_and_spread(stack)
        means.append(mean)
        deviations.append(np.maximum(deviation, np.float32(least_deviation)))
    return CleanPlate(np.stack(means), np.stack(deviations))


def _median_and_spread(stack: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Median and 1.4826 MAD over the first axis of uint8 pictures, row by row to spare memory."""
    mean = np.empty(stack.shape[1:], np.float32)
    deviation = np.empty(stack.shape[1:], np.float32)
    middle = len(stack) // 2
    for rows in range(0, stack.shape[1], 64):
        part = stack[:, rows : rows + 64].astype(np.int16)
        # mean of the middle half: a median that is not caught on whole numbers
        ordered = np.sort(part, axis=0)
        low, high = len(stack) // 4, len(stack) - len(stack) // 4
        mean[rows : rows + 64] = ordered[low:high].mean(axis=0, dtype=np.float32)
        spread = np.abs(part - mean[rows : rows + 64])
        deviation[rows : rows + 64] = 1.4826 * np.partition(spread, middle, axis=0)[middle]
    return mean, deviation
