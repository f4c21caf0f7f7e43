"""A clothed human with known truth, read from a folder of skinned clips."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Annotated
from zipfile import BadZipFile

import cv2
import numpy as np
from scipy.spatial import cKDTree

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.chart_atlas import chart_atlas, fill_gutters, texel_hits
from reperform.nodes.kernels.planted_feet import planted_feet
from reperform.nodes.kernels.rasterise import interpolate
from reperform.nodes.products.mesh import MeshSequence, TextureAtlas
from reperform.nodes.products.performance import BoneRotations, Contacts, Performance, SkeletonSequence

Arrays = dict[str, np.ndarray]


@node(over="take", memory=1.0)
def twin(
    *,
    folder: Annotated[str, File("folder with rest.npz, watertight.npz, atlas.png and one .npz per clip")],
    clip: Annotated[str, Param("", about="name of the clip, such as walk")],
    watertight: Annotated[
        bool, Param("", about="the closed surface instead of the separate garments")
    ] = False,
    first: Annotated[int, Param("frame", 0, 100000, "first frame that is used")] = 0,
    frames: Annotated[int, Param("frame", 0, 100000, "how many; 0: to the end")] = 0,
    centred: Annotated[bool, Param("", about="move the ground covered to the origin")] = True,
) -> Performance:
    """The clip as it is stored: every vertex is the same physical point in all frames and clips; metres, y up.

    The clothed surface brings its own atlas; the closed one (watertight) gets an atlas painted with the colour of
    the nearest point of the clothed surface in the rest pose. planted: toes within 5 cm of their lowest and
    slower than 0.45 m/s, an estimate: the clips were retargeted without contacts and their feet slide.

    Raises ValueError for a missing clip (nearest names listed), file or array, or a damaged file.

    Source: reading of files; no published method.
    """
    root = Path(folder)
    rest = _load(root / "rest.npz", ("vertices", "faces", "uv", "faces_uv"))
    motion = _load(
        _clip_file(root, clip), ("vertices", "joints", "joint_names", "joint_parents", "transforms", "fps")
    )
    atlas = _picture(root / "atlas.png")
    clothed = TextureAtlas(rest["uv"].astype(np.float32), rest["faces_uv"].astype(np.int32), atlas)
    if watertight:
        closed = _load(root / "watertight.npz", ("rest_vertices", "faces", clip))
        vertices, faces = closed[clip], closed["faces"].astype(np.int32)
        texture = _transfer(closed["rest_vertices"], faces, rest, clothed)
    else:
        vertices, faces, texture = motion["vertices"], rest["faces"].astype(np.int32), clothed
    span = slice(first, first + frames if frames else None)
    joints = motion["joints"][span].astype(np.float64)
    if not len(joints):
        raise ValueError(
            f"studio.twin: first must be below the {len(vertices)} frames of {clip!r}, got {first}"
        )
    shift = np.zeros(3)
    if centred:
        shift[[0, 2]] = 0.5 * (joints[:, 0, [0, 2]].min(axis=0) + joints[:, 0, [0, 2]].max(axis=0))
    joints = joints - shift
    rate = np.array(motion["fps"], np.float32)
    names = [str(name) for name in motion["joint_names"]]
    return Performance(
        MeshSequence((vertices[span] - shift).astype(np.float32), faces, rate),
        texture,
        SkeletonSequence(
            joints.astype(np.float32), motion["joint_parents"].astype(np.int32), np.array(names), rate
        ),
        Contacts(planted_feet(joints[:, _feet(names)], float(rate))),
        BoneRotations(
            motion["transforms"][span, :, :, :3].astype(np.float32),
            motion["joint_parents"].astype(np.int32),
            rate,
        ),
    )


def _load(path: Path, wanted: tuple[str, ...]) -> Arrays:
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
            missing = [name for name in wanted if name not in stored]
            if missing:
                raise ValueError(
                    f"studio.twin: {path.name} must hold {missing[0]!r}, it holds: {', '.join(stored.files)}"
                )
            return {name: stored[name] for name in wanted}
    except FileNotFoundError as error:
        raise ValueError(f"studio.twin: {path} does not exist: give the folder that holds it") from error
    except (BadZipFile, EOFError, OSError) as error:
        raise ValueError(
            f"studio.twin: {path.name} is truncated or damaged ({error}): fetch it again"
        ) from error


def _clip_file(root: Path, clip: str) -> Path:
    known = sorted(path.stem for path in root.glob("*.npz") if path.stem not in ("rest", "watertight"))
    if clip not in known:
        near = difflib.get_close_matches(clip, known, n=3, cutoff=0.3)
        hint = f"did you mean {' or '.join(map(repr, near))}? " if near else ""
        raise ValueError(f"studio.twin: no clip {clip!r}; {hint}the folder has: {', '.join(known) or 'none'}")
    return root / f"{clip}.npz"


def _picture(path: Path) -> np.ndarray:
    image = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if image is None:
        raise ValueError(f"studio.twin: {path} is missing or not a picture: give the folder that holds it")
    return np.ascontiguousarray(image[..., ::-1])


def _feet(names: list[str]) -> list[int]:
    """Indices of the left and right toe (or foot) joint."""
    found = []
    for side in ("l", "r"):
        places = [
            index
            for part in ("toe", "foot")
            for index, name in enumerate(names)
            if part in name.lower() and (name.lower().endswith(side) or name.lower().startswith(side))
        ]
        found.append(places[0] if places else 0)
    return found


def _transfer(
    vertices: np.ndarray, faces: np.ndarray, rest: Arrays, clothed: TextureAtlas, size: int = 1024
) -> TextureAtlas:
    """An atlas for another surface of the same body: each texel takes the colour of the nearest clothed point."""
    points, colours = _coloured_points(rest, clothed)
    uv, faces_uv = chart_atlas(vertices, faces, size)
    ids, barycentric = texel_hits(uv, faces_uv, size, size)
    painted = ids >= 0
    _, nearest = cKDTree(points).query(interpolate(vertices, faces, ids[painted], barycentric[painted]))
    image = np.zeros((size, size, 3), np.uint8)
    image[painted] = colours[nearest]
    return TextureAtlas(uv, faces_uv, fill_gutters(image, painted))


def _coloured_points(
    rest: Arrays, clothed: TextureAtlas, spacing: float = 0.003
) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 3) about `spacing` (m) apart on the clothed surface, with their colours (N, 3)."""
    corners = rest["vertices"][rest["faces"]].astype(float)
    corners_uv = clothed.uv[clothed.faces_uv].astype(float)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max(axis=1)
    steps = np.clip(np.ceil(longest / spacing), 1, 40).astype(int)
    height, width = clothed.image.shape[:2]
    points, colours = [], []
    for count in np.unique(steps):
        i, j = np.indices((count, count)).reshape(2, -1)
        inside = i + j < count
        a, b = (i[inside] + 1 / 3) / count, (j[inside] + 1 / 3) / count
        weights = np.column_stack([1 - a - b, a, b])
        rows = steps == count
        points.append(np.einsum("pk,fki->fpi", weights, corners[rows]).reshape(-1, 3))
        uv = np.einsum("pk,fki->fpi", weights, corners_uv[rows]).reshape(-1, 2)
        x = np.clip((uv[:, 0] * width).astype(int), 0, width - 1)
        y = np.clip(((1 - uv[:, 1]) * height).astype(int), 0, height - 1)
        colours.append(clothed.image[y, x])
    return np.concatenate(points), np.concatenate(colours)
