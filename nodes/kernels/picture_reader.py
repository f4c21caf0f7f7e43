"""One picture from an image file or a video."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from reperform.nodes.kernels.video_reader import read_video_picture


def read_picture(path: Path, index: int, size: tuple[int, int]) -> np.ndarray:
    """Picture `index` of a file, RGB (y, x, 3) uint8; images have only picture 0, stored orientation is kept.

    size: the expected (width, height) in px. Raises ValueError naming the file and the picture.
    """
    who = f"{path} (picture {index})"
    if not path.is_file():
        raise ValueError(f"{who} is gone since it was indexed: index the clips again")
    if cv2.haveImageReader(str(path)):
        image = cv2.imread(str(path), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
        if image is None:
            raise ValueError(f"{who} is damaged: no picture comes out; replace the file")
        picture = np.ascontiguousarray(image[..., ::-1])
    else:
        picture = read_video_picture(str(path), index)
    if picture.shape != (size[1], size[0], 3):
        raise ValueError(
            f"{who} must be {size[0]}x{size[1]} px as indexed, got {picture.shape[1]}x{picture.shape[0]}: "
            "index the clips again"
        )
    return picture
