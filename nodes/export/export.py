"""The one door out: a product and a path, and the ending says the rest."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from reperform.nodes.export.acclaim import write_acclaim
from reperform.nodes.export.bvh import write_bvh
from reperform.nodes.export.gltf import write_sequence_glb, write_surfaces_glb
from reperform.nodes.export.mesh_text import write_obj, write_ply
from reperform.nodes.export.motion_graph import write_motion_graph
from reperform.nodes.export.npz import write_npz
from reperform.nodes.export.parametric_graph import write_parametric_graph
from reperform.nodes.export.png import heat, tile, write_png
from reperform.nodes.export.table import write_csv
from reperform.nodes.export.usd import write_usd
from reperform.nodes.export.video import write_mp4
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.footage import CleanPlate, Film, Footage, Mattes
from reperform.nodes.products.key_frame_table import KeyFrameTable
from reperform.nodes.products.mesh import MeshSequence, Surfaces, TextureAtlas
from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.products.motion import Animation, Dissimilarity, MotionGraph
from reperform.nodes.products.parametric import ParametricGraph
from reperform.nodes.products.performance import Performance, SkeletonSequence
from reperform.nodes.products.table import Table

MESHES = (".glb", ".obj", ".ply", ".usd", ".usda", ".usdc")
Picture = Callable[[Any], np.ndarray]
Texture = tuple[np.ndarray, np.ndarray, bytes]


def endings(kind: type) -> tuple[str, ...]:
    """The file endings that a product type can be written as."""
    table: dict[type, tuple[str, ...]] = {
        Film: (".mp4", ".png"),
        Footage: (".mp4", ".png"),
        Mattes: (".mp4", ".png"),
        CleanPlate: (".png",),
        TextureAtlas: (".png",),
        Dissimilarity: (".png",),
        MeshSequence: MESHES,
        Surfaces: MESHES,
        Animation: MESHES,
        Performance: (*MESHES, ".bvh"),
        SkeletonSequence: (".bvh",),
        Mocap: (".bvh", ".amc"),
        SkeletalAnimation: (".bvh", ".amc"),
        Table: (".csv",),
        KeyFrameTable: (".csv",),
        MotionGraph: (".json", ".graphml"),
        PoseGraph: (".json", ".graphml"),
        ParametricGraph: (".xml",),
    }
    return (*table.get(kind, ()), ".npz")


def write(product: Any, path: Path | str, name: str = "", picture: Picture | None = None) -> None:
    """Write a product to a file, in the format that the ending says; complete or absent.

    Films and footage: .mp4 (all cameras side by side), .png (one picture, or a sheet of up to 16 frames).
    Meshes: .glb and .usd hold all frames; .obj and .ply one mesh per file: for several frames the name must
    have a place for the frame, as `mesh_%04d.obj` (.png takes that too). Skeletons .bvh, or .amc with an .asf,
    tables .csv, graphs .json and .graphml, parametric graphs .xml, matrices .png, anything .npz. Fields may be lazy:
    frames are read one at a time. name: of the object
    inside .glb and .usd. picture: draws other products as RGB uint8 for .png.

    Raises ValueError where the product cannot be written so; the message lists the endings that it can.
    """
    path = Path(path)
    ending, kind = path.suffix.lower(), type(product)
    supported = endings(kind)
    if ending not in supported and not (ending == ".png" and picture is not None):
        raise ValueError(
            f"{path.name}: {kind.__name__} can be written as {' '.join(supported)}, not as {ending or 'no ending'!r}"
        )
    if ending == ".npz":
        write_npz(path, product)
    elif ending == ".csv":
        write_csv(path, product)
    elif ending in (".json", ".graphml"):
        write_motion_graph(path, product)
    elif ending == ".xml":
        write_parametric_graph(path, product)
    elif ending == ".bvh":
        write_bvh(path, _moving_skeleton(product))
    elif ending == ".amc":
        write_acclaim(path, product.mocap if isinstance(product, SkeletalAnimation) else product)
    elif ending in MESHES:
        _write_meshes(product, path, ending, name or path.stem)
    elif ending == ".mp4":
        write_mp4(path, _pictures(product), float(np.asarray(product.fps)))
    elif ".png" not in supported and picture is not None:
        write_png(path, picture(product))
    else:
        _write_pictures(product, path)


def _moving_skeleton(product: Any) -> SkeletonSequence | Mocap:
    if isinstance(product, SkeletalAnimation):
        return product.mocap
    return product.skeleton if isinstance(product, Performance) else product


def _pictures(product: Any) -> Iterator[np.ndarray]:
    """One RGB picture per frame."""
    if isinstance(product, Film):
        for frame in range(len(product.images)):
            yield np.asarray(product.images[frame])
        return
    field = product.alpha if isinstance(product, Mattes) else product.images
    for frame in range(len(field)):
        yield tile(list(np.asarray(field[frame])))


def _write_pictures(product: Any, path: Path) -> None:
    if isinstance(product, Dissimilarity):
        write_png(path, heat(np.asarray(product.distance)))
    elif isinstance(product, TextureAtlas):
        write_png(path, np.asarray(product.image))
    elif isinstance(product, CleanPlate):
        write_png(path, tile(list(np.rint(np.asarray(product.mean)).clip(0, 255).astype(np.uint8))))
    elif "%" in path.name:
        for frame, image in enumerate(_pictures(product)):
            write_png(_numbered(path, frame), image)
    else:
        count = len(product.alpha if isinstance(product, Mattes) else product.images)
        chosen = set(np.unique(np.linspace(0, count - 1, min(count, 16)).astype(int)).tolist())
        write_png(path, tile([image for frame, image in enumerate(_pictures(product)) if frame in chosen]))


def _write_meshes(product: Any, path: Path, ending: str, name: str) -> None:
    texture = _texture(product) if isinstance(product, Performance) else None
    mesh = product.mesh if isinstance(product, Animation | Performance) else product
    count, fps = len(mesh.vertices), float(np.asarray(mesh.fps))
    if count == 0:
        raise ValueError(f"{path.name}: a mesh file needs at least one frame, got none")
    fixed = np.asarray(mesh.faces) if isinstance(mesh, MeshSequence) else None

    def frames() -> Iterator[tuple[np.ndarray, np.ndarray]]:
        for k in range(count):
            yield np.asarray(mesh.vertices[k]), np.asarray(mesh.faces[k]) if fixed is None else fixed

    if ending in (".usd", ".usda", ".usdc"):
        write_usd(path, frames(), fps, name)
    elif ending == ".glb" and fixed is not None:
        write_sequence_glb(path, [v for v, _ in frames()], fixed, fps, name, texture)
    elif ending == ".glb":
        write_surfaces_glb(path, list(frames()), fps, name)
    elif count > 1 and "%" not in path.name:
        raise ValueError(
            f"{path.name}: {ending} holds one mesh, the product has {count} frames: name a file per frame, as "
            f"{path.stem}_%04d{ending}, or choose .glb or .usd"
        )
    else:
        for k, (vertices, faces) in enumerate(frames()):
            file = _numbered(path, k) if "%" in path.name else path
            if ending == ".obj":
                write_obj(file, vertices, faces, texture)
            else:
                write_ply(file, vertices, faces)


def _texture(performance: Performance) -> Texture:
    import cv2

    atlas = performance.texture
    png = cv2.imencode(".png", np.ascontiguousarray(np.asarray(atlas.image)[..., ::-1]))[1].tobytes()
    return np.asarray(atlas.uv), np.asarray(atlas.faces_uv), png


def _numbered(path: Path, frame: int) -> Path:
    try:
        return path.with_name(path.name % frame)
    except (TypeError, ValueError) as error:
        raise ValueError(
            f"{path.name}: one place for the frame is needed, as mesh_%04d{path.suffix}"
        ) from error
