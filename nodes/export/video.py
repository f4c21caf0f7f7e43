"""Films as MP4."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import av
import numpy as np

from reperform.nodes.export.atomic import beside


def write_mp4(path: Path, images: Iterable[np.ndarray], fps: float, *, crf: int = 18) -> int:
    """Write RGB uint8 pictures (H, W, 3) of one size as H.264 (yuv420p); returns how many.

    Odd sizes get their last row or column twice, for the format halves the colour planes. The file is
    complete or absent. Raises ValueError where there is no picture, one differs in size, or fps is not
    positive.
    """
    if not fps > 0:
        raise ValueError(f"{path}: the frame rate must be positive, in Hz, got {fps}")
    count, size = 0, (0, 0)
    with beside(path) as draft, av.open(str(draft), "w", options={"movflags": "faststart"}) as container:
        for image in images:
            picture = _even(np.asarray(image))
            if count == 0:
                size = picture.shape[:2]
                stream = container.add_stream("libx264", rate=Fraction(float(fps)).limit_denominator(1001))
                stream.height, stream.width = size
                stream.pix_fmt = "yuv420p"
                # One thread, and code that no processor or uninitialised margin can sway: the same
                # pictures are the same bytes.
                stream.codec_context.thread_count = 1
                stream.options = {
                    "crf": str(crf),
                    "preset": "veryfast",
                    "x264-params": "threads=1:lookahead-threads=1:sliced-threads=0:cpu-independent=1",
                }
            elif picture.shape[:2] != size:
                raise ValueError(
                    f"{path}: all pictures must be {size[1]} x {size[0]} px as the first, picture {count} is "
                    f"{picture.shape[1]} x {picture.shape[0]}"
                )
            for packet in stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")):
                container.mux(packet)
            count += 1
        if count == 0:
            raise ValueError(f"{path}: a film needs at least one picture, got none")
        for packet in stream.encode():
            container.mux(packet)
    return count


def _even(image: np.ndarray) -> np.ndarray:
    if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8:
        raise ValueError(
            f"a picture must be RGB uint8 of shape (H, W, 3), got {image.dtype} {image.shape}: convert it first"
        )
    pad = [(0, image.shape[0] % 2), (0, image.shape[1] % 2), (0, 0)]
    return np.ascontiguousarray(np.pad(image, pad, mode="edge"))
