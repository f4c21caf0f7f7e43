"""Read a calibrated rig from files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.calibration_formats import CameraRecord, read_opencv, read_surrey
from reperform.nodes.kernels.file_pattern import match_files
from reperform.nodes.products.cameras import Cameras

# Printed with few digits, a rotation is orthonormal only so far.
_ORTHONORMAL = 2e-3
# World axes of a z-up file in the y-up world: x, z, -y.
_Z_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


@node(over="take")
def calibration(
    *,
    file: Annotated[str, File("calibration file, or folder with one file per camera")],
    pattern: Annotated[
        str, Param(about="in a folder: the files' names with {camera}")
    ] = "cam{camera}/config.xml",
    format: Annotated[
        Literal["auto", "surrey", "opencv"], Param(about="auto: by the file's ending")
    ] = "auto",
    cameras: Annotated[list[str], Param(about="cameras to take, in this order; empty: all")] = [],  # noqa: B006
    scale: Annotated[float, Param("m", 1e-6, 1e3, "length of the file's unit")] = 1.0,
    up: Annotated[Literal["y", "z"], Param(about="axis that points up in the file")] = "y",
    width: Annotated[int, Param("px", 0, 65536, "image width where the file does not tell")] = 0,
    height: Annotated[int, Param("px", 0, 65536, "image height where the file does not tell")] = 0,
) -> Cameras:
    """The cameras of a rig, in metres, Y up, x_cam = R x + t.

    With s = `scale` and M the turn of a z-up world to y up (x, z, -y): R = R_file M^T, t = s t_file. Rotations are
    replaced by the nearest orthonormal matrix (SVD). Cameras of a folder are named by what {camera} matched, those
    of one file 0, 1, ... Surrey's text format gives metres; OpenCV's XML, YAML and JSON give one camera per file.

    Raises ValueError naming the file and the camera for missing cameras, malformed files, matrices that are no
    rotation or no camera matrix, and an image size that nobody tells or that the principal point lies outside.

    Source: Zhang, IEEE PAMI 22, 2000 (the camera model, with OpenCV's five distortion coefficients); 004 (the studio).
    """
    path = Path(file)
    records = _records(path, pattern, format)
    names = list(cameras) or list(records)
    missing = [name for name in names if name not in records]
    if missing:
        raise ValueError(
            f"calibration: camera {', '.join(missing)} is not in {path}; found {', '.join(records)}: check cameras"
        )
    world = _Z_UP if up == "z" else np.eye(3)
    chosen = [records[name] for name in names]
    return Cameras(
        matrix=np.stack(
            [_checked_matrix(r, f"{path}, camera {n}") for n, r in zip(names, chosen, strict=True)]
        ),
        rotation=np.stack(
            [
                _nearest_rotation(r.rotation, f"{path}, camera {n}") @ world.T
                for n, r in zip(names, chosen, strict=True)
            ]
        ),
        translation=scale * np.stack([record.translation for record in chosen]),
        distortion=np.stack([record.distortion for record in chosen]),
        image_size=np.array(
            [_size(r, width, height, f"{path}, camera {n}") for n, r in zip(names, chosen, strict=True)],
            np.int32,
        ),
        name=np.array(names, dtype=str),
    )


def _records(path: Path, pattern: str, format: str) -> dict[str, CameraRecord]:
    if not path.is_dir():
        if not path.is_file():
            raise ValueError(f"calibration: {path} does not exist: give the calibration file or its folder")
        return {str(k): record for k, record in enumerate(_read(path, format))}
    matched = match_files(path, pattern)
    if not matched:
        raise ValueError(f"calibration: no file below {path} matches {pattern!r}: check folder and pattern")
    records = {}
    for camera, files in matched.items():
        found = [record for _, name in files for record in _read(path / name, format)]
        if len(found) != 1:
            raise ValueError(
                f"calibration: camera {camera} must have one file with one camera below {path}, got {len(found)} "
                f"cameras in {len(files)} files: narrow the pattern {pattern!r}"
            )
        records[camera] = found[0]
    return records


def _read(path: Path, format: str) -> list[CameraRecord]:
    opencv = (
        path.suffix.lower() in (".xml", ".yaml", ".yml", ".json") if format == "auto" else format == "opencv"
    )
    return [read_opencv(path)] if opencv else read_surrey(path)


def _checked_matrix(record: CameraRecord, who: str) -> np.ndarray:
    matrix = record.matrix
    if not (matrix[0, 0] > 0 and matrix[1, 1] > 0 and np.allclose(matrix[[1, 2, 2], [0, 0, 1]], 0)):
        raise ValueError(
            f"calibration: {who}: a camera matrix is [fx s cx; 0 fy cy; 0 0 1] with fx, fy > 0 px, got {matrix.tolist()}"
        )
    return matrix / matrix[2, 2]


def _nearest_rotation(matrix: np.ndarray, who: str) -> np.ndarray:
    error = float(np.abs(matrix @ matrix.T - np.eye(3)).max())
    if not error < _ORTHONORMAL or np.linalg.det(matrix) < 0:
        raise ValueError(
            f"calibration: {who}: the rotation must be orthonormal and right-handed, got R R^T off by {error:.2g} and "
            f"determinant {np.linalg.det(matrix):.3f}: check the order of the numbers"
        )
    u, _, v = np.linalg.svd(matrix)
    return u @ v


def _size(record: CameraRecord, width: int, height: int, who: str) -> tuple[int, int]:
    told = record.image_size
    size = told if all(told) else (width, height)
    if not all(size):
        raise ValueError(
            f"calibration: {who}: the file does not tell the image size: set width and height (px)"
        )
    if all(told) and width and height and told != (width, height):
        raise ValueError(
            f"calibration: {who}: the file says {told} px, width and height say {(width, height)} px"
        )
    centre = record.matrix[:2, 2]
    if not (0 <= centre[0] < size[0] and 0 <= centre[1] < size[1]):
        raise ValueError(
            f"calibration: {who}: the principal point ({centre[0]:.1f}, {centre[1]:.1f}) px lies outside the image of "
            f"{size[0]}x{size[1]} px: the calibration belongs to another image size"
        )
    return size
