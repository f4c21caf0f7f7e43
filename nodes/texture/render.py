"""Synthesised motion, textured by the footage it comes from."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.backdrop import backdrop
from reperform.nodes.kernels.camera import centre, project
from reperform.nodes.kernels.captured_surface import (
    Picture,
    capture_surface,
    compose,
    directions_to,
    textured,
)
from reperform.nodes.kernels.flow_blend import Flow, flow_blend
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.rasterise import interpolate
from reperform.nodes.kernels.surface_hits import SurfaceHits, surface_hits
from reperform.nodes.product import Dataset
from reperform.nodes.products.cameras import CameraPath, Cameras
from reperform.nodes.products.colour_match import ColourMatch
from reperform.nodes.products.footage import Film, Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, Provenance
from reperform.nodes.texture.free_viewpoint import calibration
from reperform.nodes.texture.parameters import (
    Bias,
    Brightness,
    Erode,
    Feather,
    Grid,
    Samples,
    Shadow,
    Sharpness,
)


@node(over="frame", memory=1.0)
def render(
    animation: Animation,
    camera: CameraPath,
    meshes: Dataset[MeshSequence],
    footage: Dataset[Footage],
    mattes: Dataset[Mattes],
    cameras: Dataset[Cameras],
    colours: Dataset[ColourMatch] | None = None,
    *,
    alignment: Annotated[
        Flow,
        Param("1", about="optical flow between the sources; none = cross-fade"),
    ] = "dis",
    views: Annotated[int, Param("cameras", 1, 64, "of each source, the nearest in direction")] = 5,
    sharpness: Sharpness = 4.0,
    erode: Erode = 1.5,
    feather: Feather = 6.0,
    bias: Bias = 0.003,
    samples: Samples = 3,
    brightness: Brightness = 0.75,
    shadow: Shadow = 0.5,
    grid: Grid = 1.0,
) -> Film:
    """Render one synthesised frame from a virtual camera: a 4D video texture.

    The animated mesh M is rasterised; each pixel is a triangle and barycentrics, hence a point of every
    captured mesh that the frame comes from (provenance: take, frame, weight, yaw). That point is looked up
    in the footage as in `texture.free_viewpoint`, the direction to the virtual eye turned by -yaw into the
    capture. The renders I_i, I_j of the two sources on the same shape are aligned by optical flow and
    blended by weight; a frame with one source is that source's render exactly.

    Raises ValueError where a source take is missing, a frame is out of range, or a captured mesh has another
    topology than the animation.

    Source: 004 section 5.3.3, eqs 5.1-5.3. Departure: see `nodes/kernels/flow_blend.py` (trap in eqs
    5.2-5.3).
    """
    width, height = camera.image_size.tolist()
    pose = camera.matrix, camera.rotation, camera.translation
    vertices, faces = animation.mesh.vertices, animation.mesh.faces
    stage = backdrop(*pose, height, width, vertices, faces, brightness=brightness, shadow=shadow, grid=grid)
    hits = surface_hits(*project(vertices, *pose), faces, height, width, samples)
    points = interpolate(vertices, faces, hits.ids, hits.barycentric)
    towards = directions_to(centre(camera.rotation, camera.translation), points)
    renders, weights = [], []
    for take, frame, weight, yaw in sources(animation.provenance):
        captured = _captured(meshes, take, frame, faces)
        inward = apply(towards, Placement(-yaw, np.zeros(2)))
        chosen = _nearest_cameras(cameras[take], captured, inward, views)
        shots = _pictures(footage[take], mattes[take], cameras[take], frame, chosen)
        gains = None if colours is None else np.asarray(colours[take].gain)[chosen]
        surface = capture_surface(
            captured, faces, shots, gains=gains, erode=erode, feather=feather, bias=bias
        )
        renders.append(textured(surface, hits.ids, hits.barycentric, inward, sharpness=sharpness, bias=bias))
        weights.append(weight)
    colour = renders[0][0] if len(renders) == 1 else _blend(hits, renders, weights, alignment)
    return Film(*compose(stage, hits.y, hits.x, colour, hits.coverage), animation.mesh.fps)


def sources(provenance: Provenance) -> list[tuple[str, int, float, float]]:
    """The captured frames behind one synthesised frame: take, frame, weight, yaw; equal ones joined.

    Raises ValueError where no weight is positive.
    """
    found: dict[tuple[str, int, float], float] = {}
    for slot in range(2):
        weight = float(provenance.weight[slot])
        if weight > 1e-6:
            name = str(provenance.takes[int(provenance.take[slot])])
            key = name, int(provenance.source_frame[slot]), float(provenance.yaw[slot])
            found[key] = found.get(key, 0.0) + weight
    if not found:
        raise ValueError("texture.render: a synthesised frame needs a source with positive weight, got none")
    total = sum(found.values())
    return [(take, frame, weight / total, yaw) for (take, frame, yaw), weight in found.items()]


def _captured(meshes: Dataset[MeshSequence], take: str, frame: int, faces: np.ndarray) -> np.ndarray:
    if take not in meshes:
        raise ValueError(f"texture.render: take {take!r} must be in the meshes, got {list(meshes)}")
    mesh = meshes[take]
    if not 0 <= frame < mesh.vertices.shape[0]:
        raise ValueError(
            f"texture.render: frame {frame} of take {take!r} must be under {mesh.vertices.shape[0]}: wire "
            "the meshes that the animation was made from"
        )
    if not np.array_equal(np.asarray(mesh.faces), faces):
        raise ValueError(
            f"texture.render: take {take!r} must have the animation's topology ({len(faces)} faces): wire "
            "the meshes that the animation was made from"
        )
    return np.asarray(mesh.vertices[frame])


def _nearest_cameras(cameras: Cameras, vertices: np.ndarray, towards: np.ndarray, count: int) -> list[int]:
    """The cameras whose directions from the performer are nearest the mean direction of view."""
    eyes = centre(np.asarray(cameras.rotation), np.asarray(cameras.translation))
    directions = directions_to_many(eyes, vertices.mean(axis=0))
    mean = towards.mean(axis=0) if len(towards) else np.array([0.0, 0.0, 1.0])
    return np.sort(np.argsort(-directions @ mean, kind="stable")[:count]).tolist()


def directions_to_many(eyes: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Unit vectors (C, 3) from one point to eyes (C, 3)."""
    away = eyes - point
    return np.asarray(away / np.linalg.norm(away, axis=1, keepdims=True))


def _pictures(
    footage: Footage, mattes: Mattes, cameras: Cameras, frame: int, chosen: list[int]
) -> Iterator[Picture]:
    rig = Cameras(*(np.asarray(field) for field in cameras))
    for k in chosen:
        yield np.asarray(footage.images[frame, k]), np.asarray(mattes.alpha[frame, k]), calibration(rig, k)


def _blend(
    hits: SurfaceHits, renders: list[tuple[np.ndarray, np.ndarray]], weights: list[float], alignment: Flow
) -> np.ndarray:
    """Colours (P, 3) of two sources, each colours (P, 3) and reliability (P,), as one."""
    if not len(hits.y):
        return renders[0][0]
    margin = 8
    rows, columns = hits.y - hits.y.min() + margin, hits.x - hits.x.min() + margin
    shape = int(rows.max()) + margin + 1, int(columns.max()) + margin + 1
    inside = np.zeros(shape, bool)
    inside[rows, columns] = True
    layers, confidence = np.zeros((2, *shape, 3), np.float32), np.zeros((2, *shape), np.float32)
    for k, (colour, reliability) in enumerate(renders):
        layers[k, rows, columns], confidence[k, rows, columns] = colour, reliability
    return flow_blend(layers[0], layers[1], weights[0], inside, confidence, method=alignment)[rows, columns]
