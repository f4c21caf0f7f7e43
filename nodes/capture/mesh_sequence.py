"""Captured meshes of one topology from a file."""

from __future__ import annotations

import zipfile
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.products.mesh import MeshSequence


@node(over="take")
def mesh_sequence(
    *,
    file: Annotated[
        str, File("NumPy archive (.npz) with `vertices` (frame, vertex, 3) and `faces` (face, 3)")
    ],
    first: Annotated[int, Param("frame", 0, None, "first frame of the take")] = 0,
    count: Annotated[int, Param("frame", 0, None, "frames of the take; 0 takes all that follow")] = 0,
    fps: Annotated[float, Param("Hz", 0.0, 1000.0, "frame rate; 0 takes the file's `fps`")] = 0.0,
    scale: Annotated[float, Param("m", 1e-6, 1e6, "metres per unit of the file")] = 1.0,
    vertices: Annotated[str, Param(about="name of the array of vertices in the file")] = "vertices",
    faces: Annotated[str, Param(about="name of the array of faces in the file")] = "faces",
) -> MeshSequence:
    """A take cut from a mesh sequence that is already in one topology: frames first .. first + count - 1.

    Vertices come in metres, y up, faces counter-clockwise from outside.

    Raises ValueError where the file cannot be read, an array is missing or has another shape, a face names a
    vertex that is not there, a vertex is not finite, the take reaches past the end, or no frame rate is
    known.

    Source: the layout of NumPy's archives; the MIT mesh animation sequences (Vlasic, Baran, Matusik and
    Popovic 2008) come in it.
    """
    who = f"capture.mesh_sequence: {file}"
    try:
        with open(file, "rb") as stream, np.load(stream, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in (vertices, faces) if name in archive.files}
            rate = fps if fps > 0 or "fps" not in archive.files else float(archive["fps"])
            names = archive.files
    except (OSError, ValueError, TypeError, EOFError, zipfile.BadZipFile) as error:
        raise ValueError(f"{who} cannot be read as a NumPy archive: {error}") from error
    for name in (vertices, faces):
        if name not in arrays:
            raise ValueError(f"{who} must hold an array {name!r}, it holds {', '.join(names)}")
    points, triangles = arrays[vertices], arrays[faces]
    _check_shapes(who, points, triangles)
    last = first + count if count else len(points)
    if not first < last <= len(points):
        raise ValueError(
            f"{who} has {len(points)} frames; frames {first} .. {last - 1} were asked: change first, count"
        )
    if rate <= 0:
        raise ValueError(f"{who} does not state a frame rate: give fps in Hz")
    taken = (points[first:last] * scale).astype(np.float32)
    if not np.isfinite(taken).all():
        raise ValueError(
            f"{who}: vertices must be finite, {int((~np.isfinite(taken)).sum())} coordinates are not"
        )
    return MeshSequence(taken, triangles.astype(np.int32), np.asarray(rate, np.float32))


def _check_shapes(who: str, points: np.ndarray, triangles: np.ndarray) -> None:
    if points.ndim != 3 or points.shape[2] != 3:
        raise ValueError(f"{who}: vertices must be (frame, vertex, 3), got {points.shape}")
    if triangles.ndim != 2 or triangles.shape[1] != 3 or triangles.dtype.kind not in "iu":
        raise ValueError(f"{who}: faces must be (face, 3) integers, got {triangles.shape} {triangles.dtype}")
    if triangles.size and (triangles.min() < 0 or triangles.max() >= points.shape[1]):
        raise ValueError(
            f"{who}: faces must name vertices 0 .. {points.shape[1] - 1}, "
            f"got {triangles.min()} .. {triangles.max()}"
        )
