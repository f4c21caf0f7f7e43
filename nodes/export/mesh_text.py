"""Single meshes as OBJ and PLY."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from reperform.nodes.export.atomic import beside


def write_obj(
    path: Path,
    vertices: np.ndarray,
    faces: np.ndarray,
    texture: tuple[np.ndarray, np.ndarray, bytes] | None = None,
) -> None:
    """Wavefront OBJ, metres; with uv (U, 2), faces_uv (F, 3) and a PNG's bytes also .mtl and .png beside
    it."""
    lines = [f"v {x:.7g} {y:.7g} {z:.7g}" for x, y, z in vertices.tolist()]
    if texture is None:
        lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    else:
        uv, faces_uv, png = texture
        with beside(path.with_suffix(".png")) as draft:
            draft.write_bytes(png)
        material = f"newmtl performer\nKd 1 1 1\nmap_Kd {path.stem}.png\n"
        with beside(path.with_suffix(".mtl")) as draft:
            draft.write_text(material, encoding="utf-8")
        lines = [
            f"mtllib {path.stem}.mtl",
            *lines,
            *(f"vt {u:.7g} {v:.7g}" for u, v in uv.tolist()),
            "usemtl performer",
        ]
        both = np.stack([faces, faces_uv], axis=-1).reshape(-1, 6) + 1
        lines += ["f {}/{} {}/{} {}/{}".format(*row) for row in both.tolist()]
    with beside(path) as draft:
        draft.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_ply(path: Path, vertices: np.ndarray, faces: np.ndarray) -> None:
    """Binary little-endian PLY, metres; complete or absent."""
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, faces
    with beside(path) as draft:
        draft.write_bytes(header.encode() + np.asarray(vertices, "<f4").tobytes() + rows.tobytes())
