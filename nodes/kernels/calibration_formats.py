"""Readers of calibration files: Surrey's text format and OpenCV's XML or YAML."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np

_MATRIX = ("CameraMatrix", "camera_matrix", "cameraMatrix", "Camera_Matrix", "intrinsics", "K", "M")
_DISTORTION = (
    "DistortionCoeffs", "DistortionCoefficients", "distortion_coefficients", "Distortion_Coefficients",
    "distCoeffs", "dist_coeffs", "distortion", "D",
)  # fmt: skip
_ROTATION = ("RotationValues", "Rotation", "rotation_matrix", "rotation", "rvec", "R", "Rod")
_TRANSLATION = ("TranslationValues", "Translation", "translation_vector", "translation", "tvec", "T")
_WIDTH = ("image_width", "image_Width", "ImageWidth", "width")
_HEIGHT = ("image_height", "image_Height", "ImageHeight", "height")


class CameraRecord(NamedTuple):
    """One camera as its file says: OpenCV's model in the file's unit of length and axes; size (0, 0): not told."""

    matrix: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    distortion: np.ndarray
    image_size: tuple[int, int]


def read_surrey(path: Path) -> list[CameraRecord]:
    """All cameras of a file in the Surrey text format.

    Tokens: `cameras reserved`, then per camera `ymin ymax xmin xmax`, `fx fy cx cy`, `k`, R (9, by rows), T (3).
    The window's corner is taken off the principal point; k is the first radial coefficient.
    Raises ValueError naming the camera for wrong counts and what is not a number.
    """
    try:
        numbers = [float(token) for token in path.read_text().split()]
    except (ValueError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: the Surrey format holds numbers only ({error})") from error
    if len(numbers) < 2 or numbers[0] < 1 or numbers[0] != int(numbers[0]):
        raise ValueError(f"{path}: the Surrey format starts with the number of cameras, got {numbers[:1]}")
    count = int(numbers[0])
    if len(numbers) != 2 + 21 * count:
        raise ValueError(
            f"{path}: {count} cameras need 2 + 21 x {count} = {2 + 21 * count} numbers, got {len(numbers)}: "
            f"camera {min((len(numbers) - 2) // 21, count)} is incomplete or too much follows"
        )
    records = []
    for values in np.array(numbers[2:]).reshape(count, 21):
        top, bottom, left, right, fx, fy, cx, cy, k = values[:9]
        records.append(
            CameraRecord(
                matrix=np.array([[fx, 0, cx - left], [0, fy, cy - top], [0, 0, 1.0]]),
                rotation=values[9:18].reshape(3, 3),
                translation=values[18:],
                distortion=np.array([k, 0, 0, 0, 0.0]),
                image_size=(int(right - left) + 1, int(bottom - top) + 1),
            )
        )
    return records


def read_opencv(path: Path) -> CameraRecord:
    """One camera of an OpenCV FileStorage file; the rotation may be a matrix or a Rodrigues vector.

    Raises ValueError naming what is missing or has the wrong size.
    """
    try:
        storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    # OpenCV's own error may come wrapped in a SystemError
    except (cv2.error, SystemError) as error:
        raise ValueError(f"{path}: not an OpenCV file storage, or damaged: export it again") from error
    if not storage.isOpened():
        raise ValueError(f"{path}: not a readable OpenCV file storage")
    matrix = _field(storage, path, _MATRIX, (9,)).reshape(3, 3)
    rotation = _field(storage, path, _ROTATION, (3, 9))
    if rotation.size == 3:
        rotation = cv2.Rodrigues(rotation)[0]
    distortion = _field(storage, path, _DISTORTION, (4, 5, 8, 12, 14), np.zeros(5))
    if np.any(distortion[5:]):
        raise ValueError(f"{path}: lenses of at most 5 coefficients are understood, got {distortion.size}")
    size = [_field(storage, path, names, (1,), np.zeros(1)).item() for names in (_WIDTH, _HEIGHT)]
    return CameraRecord(
        matrix=matrix,
        rotation=rotation.reshape(3, 3),
        translation=_field(storage, path, _TRANSLATION, (3,)),
        distortion=np.concatenate([distortion, np.zeros(5)])[:5],
        image_size=(int(size[0]), int(size[1])),
    )


def _field(
    storage: cv2.FileStorage,
    path: Path,
    names: tuple[str, ...],
    sizes: tuple[int, ...],
    default: np.ndarray | None = None,
) -> np.ndarray:
    found = next((storage.getNode(name) for name in names if not storage.getNode(name).empty()), None)
    if found is None:
        if default is not None:
            return default
        raise ValueError(f"{path}: {names[0]} is missing (also looked for {', '.join(names[1:])})")
    if found.isReal() or found.isInt():
        values = np.array([found.real()])
    elif found.isSeq():
        values = np.array([found.at(k).real() for k in range(found.size())])
    else:
        values = found.mat()
    if values is None or values.size not in sizes or not np.all(np.isfinite(values)):
        raise ValueError(
            f"{path}: {names[0]} must hold {' or '.join(map(str, sizes))} finite numbers, got "
            f"{'none' if values is None else values.ravel().tolist()}"
        )
    return np.asarray(values, np.float64).ravel()
