"""A rigged, textured glTF character plays one of its clips."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.gltf_animation import clip_seconds, find_clip, sample_clip
from reperform.nodes.kernels.gltf_file import Gltf, by_depth, global_matrices, node_parents, read_glb
from reperform.nodes.kernels.gltf_surface import RiggedSurface, rigged_surface
from reperform.nodes.kernels.planted_feet import planted_feet
from reperform.nodes.kernels.rotation import polar
from reperform.nodes.products.mesh import MeshSequence, TextureAtlas
from reperform.nodes.products.performance import BoneRotations, Contacts, Performance, SkeletonSequence


@node(over="take", memory=1.0)
def character(
    *,
    file: Annotated[str, File("a rigged glTF 2.0 character (.glb)")],
    animation: Annotated[str, Param("", about="name of the clip")],
    fps: Annotated[float, Param("Hz", 5.0, 240.0, "frames per second")] = 25.0,
    seconds: Annotated[
        float, Param("s", 0.0, 60.0, "length of the take, the clip repeating; 0: the clip once")
    ] = 0.0,
    start: Annotated[float, Param("s", 0.0, 60.0, "time in the clip at which the take starts")] = 0.0,
    speed: Annotated[float, Param("m/s", 0.0, 8.0, "how fast the character travels while it plays")] = 0.0,
    heading: Annotated[
        float, Param("rad", -7.0, 7.0, "turns the take about the vertical; 0: travel along +z")
    ] = 0.0,
    facing: Annotated[
        float, Param("rad", -7.0, 7.0, "where the file's character faces; 0: +z, 3.1416: -z")
    ] = 0.0,
    stature: Annotated[float, Param("m", 0.0, 3.0, "scales the character to this height; 0: as it is")] = 0.0,
    leave_out: Annotated[list[str], Param("", about="mesh nodes that are not shown")] = [],  # noqa: B006
) -> Performance:
    """Sample a clip of a rigged character by linear blend skinning: v = sum_k w_k world(joint_k) bind_k v_rest.

    All meshes become one: skinned ones, meshes that hang on a bone, textured and flat-coloured materials (one
    cell of the atlas each). Vertices split only for their uv are one vertex again. Lengths are metres times the
    scale to `stature` (measured at the take's first frame); the whole take is lowered so that its lowest vertex is
    at y = 0. A clip in place is made to travel by `speed`; the path is centred on the origin. Joints are those of
    the largest skin (or all nodes where there is none). planted: foot or toe joints within 5 cm of their lowest
    and slower than 0.45 m/s: an estimate, since a file knows no contacts; all False without named feet.

    Raises ValueError for a file that is not whole binary glTF 2.0, requires an extension, or has no such clip
    (the nearest names are listed).
    Source: Khronos 2021, glTF 2.0 specification, sections 3.7.3 (skins) and 3.11 (animations).
    """
    gltf = read_glb(Path(file))
    clip = find_clip(gltf, animation)
    surface = rigged_surface(gltf, leave_out)
    length = clip_seconds(gltf, clip)
    count = max(1, round((seconds or length) * fps))
    times = start + np.arange(count) / fps
    looped = times if not seconds and not start else np.mod(times, length) if length > 0 else np.zeros(count)
    parents = node_parents(gltf)
    world = global_matrices(parents, *sample_clip(gltf, clip, looped))
    vertices = _skin(surface, world)
    order, joint_parents = _joints(gltf, parents)
    joints = world[:, order][..., :3, 3]
    low = vertices[..., 1].min()
    tall = vertices[0, :, 1].max() - vertices[0, :, 1].min()
    size = stature / tall if stature > 0 else 1.0
    travel = speed * (times - times.mean())[:, None] * np.array([np.sin(heading), 0, np.cos(heading)])
    place = _placement(heading - facing, size)
    vertices = (vertices - [0, low, 0]) @ place + travel[:, None]
    joints = (joints - [0, low, 0]) @ place + travel[:, None]
    names = [gltf.entries("nodes")[index].get("name", f"node {index}") for index in order]
    rate = np.array(fps, np.float32)
    return Performance(
        MeshSequence(vertices.astype(np.float32), surface.faces, rate),
        TextureAtlas(surface.uv, surface.faces_uv, surface.image),
        SkeletonSequence(joints.astype(np.float32), joint_parents, np.array(names), rate),
        Contacts(_contacts(joints, names, fps)),
        BoneRotations(_rotations(world[:, order], place / size), joint_parents, rate),
    )


def _skin(surface: RiggedSurface, world: np.ndarray) -> np.ndarray:
    """Posed vertices (T, V, 3)."""
    matrices = world[:, surface.node] @ surface.bind
    homogeneous = np.column_stack([surface.vertices, np.ones(len(surface.vertices))])
    posed = np.zeros((len(world), len(homogeneous), 3))
    for frame, matrix in enumerate(matrices):
        for k in range(surface.slot.shape[1]):
            rows = np.flatnonzero(surface.weight[:, k])
            moved = np.einsum("vij,vj->vi", matrix[surface.slot[rows, k], :3], homogeneous[rows])
            posed[frame, rows] += surface.weight[rows, k, None] * moved
    return posed


def _joints(gltf: Gltf, parents: np.ndarray) -> tuple[list[int], np.ndarray]:
    """(nodes that are joints, parents first; parent of each among them or -1)."""
    rigs: list[list[int]] = [list(skin["joints"]) for skin in gltf.entries("skins")]
    chosen = set(rigs[int(np.argmax([len(joints) for joints in rigs]))]) if rigs else set(range(len(parents)))
    order = [index for index in by_depth(parents) if index in chosen]
    position = {index: place for place, index in enumerate(order)}
    above = []
    for index in order:
        parent = parents[index]
        while parent >= 0 and parent not in position:
            parent = parents[parent]
        above.append(position.get(int(parent), -1))
    return order, np.array(above, np.int32)


def _placement(heading: float, size: float) -> np.ndarray:
    cos, sin = np.cos(heading), np.sin(heading)
    return size * np.array([[cos, 0, -sin], [0, 1, 0], [sin, 0, cos]])


def _rotations(world: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Rotations (T, B, 3, 3) of joints by their matrices (T, B, 4, 4), without scale, turned as the character is."""
    turned, _ = polar(world[..., :3, :3])
    return np.asarray(place.T @ turned, np.float32)


def _contacts(joints: np.ndarray, names: list[str], fps: float) -> np.ndarray:
    left, right = _foot(names, "left"), _foot(names, "right")
    if left is None or right is None:
        return np.zeros((len(joints), 2), bool)
    return planted_feet(joints[:, [left, right]], fps)


def _foot(names: list[str], side: str) -> int | None:
    """The joint nearest the ball of a foot, by its name: LeftToeBase, toes_l, foot.L ..."""
    initial = re.compile(rf"(^|[._\s-]){side[0]}($|[._\s-])")
    for part in ("toe", "ball", "foot", "ankle"):
        for index, name in enumerate(names):
            lower = name.lower()
            if part in lower and "end" not in lower and (side in lower or initial.search(lower)):
                return index
    return None
