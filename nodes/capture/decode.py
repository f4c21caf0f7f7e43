"""Decode single pictures of a recording."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from reperform.nodes.declaration import File, node
from reperform.nodes.kernels.picture_reader import read_picture
from reperform.nodes.products.clips import Clips
from reperform.nodes.products.footage import Footage


@node(over="view")
def decode(
    clips: Clips,
    *,
    folder: Annotated[str, File("the folder that the clips were indexed in", in_key=False)],
) -> Footage:
    """The picture of one frame of one camera, RGB (y, x, 3) uint8, exact to the frame.

    Only this picture is decoded (of a video: from the key frame before it, or on from the picture before).
    Raises ValueError naming file and picture where it cannot be decoded or is not of the indexed size.

    Source: decoding by FFmpeg and OpenCV; no published method.
    """
    width, height = (int(n) for n in clips.image_size)
    path = Path(folder) / str(clips.file)
    return Footage(read_picture(path, int(clips.position), (width, height)), clips.fps)
