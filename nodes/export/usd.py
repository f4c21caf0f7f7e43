"""Moving meshes as USD."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from reperform.nodes.export.atomic import beside


def write_usd(path: Path, meshes: Iterable[tuple[np.ndarray, np.ndarray]], fps: float, name: str) -> None:
    """One mesh with time-sampled points (and faces, where they change): Y up, metres, frame k at time code k.

    meshes: vertices (V, 3) m and faces (F, 3) per frame; .usd, .usdc (binary) or .usda (text). Raises
    ValueError where the package `usd-core` is missing.
    """
    try:
        from pxr import Gf, Sdf, Usd, UsdGeom, Vt
    except ImportError as error:
        raise ValueError(f"{path}: USD needs the package usd-core: pip install 'reperform[usd]'") from error
    with beside(path) as draft:
        stage = Usd.Stage.CreateNew(str(draft))
        UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
        UsdGeom.SetStageMetersPerUnit(stage, 1.0)
        stage.SetTimeCodesPerSecond(float(fps))
        stage.SetFramesPerSecond(float(fps))
        root = UsdGeom.Xform.Define(stage, Sdf.Path("/" + _identifier(name)))
        stage.SetDefaultPrim(root.GetPrim())
        mesh = UsdGeom.Mesh.Define(stage, root.GetPath().AppendChild("surface"))
        mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        points, extent = mesh.CreatePointsAttr(), mesh.CreateExtentAttr()
        counts, indices = mesh.CreateFaceVertexCountsAttr(), mesh.CreateFaceVertexIndicesAttr()
        known: np.ndarray | None = None
        count = 0
        for frame, (vertices, faces) in enumerate(meshes):
            moment = Usd.TimeCode(frame)
            points.Set(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(vertices, np.float32)), moment)
            extent.Set(
                [Gf.Vec3f(*map(float, vertices.min(axis=0))), Gf.Vec3f(*map(float, vertices.max(axis=0)))],
                moment,
            )
            if known is None or not np.array_equal(faces, known):
                known = np.ascontiguousarray(faces, np.int32)
                counts.Set(Vt.IntArray(len(known), 3), moment)
                indices.Set(Vt.IntArray.FromNumpy(known.reshape(-1)), moment)
            count += 1
        stage.SetStartTimeCode(0)
        stage.SetEndTimeCode(max(count - 1, 0))
        stage.GetRootLayer().Save()
        # The layer keeps the file open under its draft name.
        del mesh, points, extent, counts, indices, root, stage


def _identifier(name: str) -> str:
    word = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name) or "performer"
    return word if not word[0].isdigit() else "_" + word
