"""Where recorded pictures lie: an index of footage that is not yet decoded."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class Clips(NamedTuple):
    """The recording of one take: per frame and camera a file, a picture in it, and a digest of its content."""

    # relative to the folder of the take, with forward slashes
    file: Annotated[np.ndarray, Axes("frame", "camera", dtype="str")]
    # which picture of a video; 0 for an image file
    position: Annotated[np.ndarray, Axes("frame", "camera", dtype="int32")]
    # blake2b of the image file, or of the video file and the index
    digest: Annotated[np.ndarray, Axes("frame", "camera", dtype="str")]
    # width, height
    image_size: Annotated[np.ndarray, Axes("camera", "2", dtype="int32", unit="px")]
    name: Annotated[np.ndarray, Axes("camera", dtype="str")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]
