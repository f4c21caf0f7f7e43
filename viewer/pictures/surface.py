"""Surfaces: one frame, or a row of poses through time."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from reperform.viewer.contents import atlas_of, frame_count, mesh_frame, one_topology
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.scene import Body, draw_scene, ground_under


def surface_picture(product: Any, frame: int, look: Look) -> np.ndarray:
    """One frame of any product with a mesh, shaded, textured or with a checker of reference positions."""
    body = dressed(product, frame, look)
    return draw_scene([body], look.view, look.size, ground=ground_under(body.vertices))


def poses_picture(product: Any, look: Look, count: int = 6) -> np.ndarray:
    """Poses of a mesh sequence from its first to its last frame, side by side, left to right in time."""
    frames = np.unique(np.linspace(0, frame_count(product) - 1, count).round().astype(int))
    right = np.array([np.cos(look.view.azimuth), 0.0, -np.sin(look.view.azimuth)])
    if one_topology(product) and look.reference is None:
        look = replace(look, reference=mesh_frame(product, 0)[0])
    bodies, edge = [], 0.0
    for frame in frames:
        body = dressed(product, int(frame), look)
        if not len(body.vertices):
            continue
        along = body.vertices @ right
        middle = (body.vertices.min(0) + body.vertices.max(0)) / 2
        across = middle - right * (middle @ right)
        # In one row across the view: neither walking on nor towards the eye moves a pose out of it.
        shift = right * (edge - along.min()) - across * [1, 0, 1]
        bodies.append(replace(body, vertices=body.vertices + shift))
        edge += float(np.ptp(along)) + 0.12
    cloud = np.concatenate([body.vertices for body in bodies]) if bodies else np.zeros((0, 3))
    return draw_scene(bodies, look.view, look.size, ground=ground_under(cloud))


def dressed(product: Any, frame: int, look: Look) -> Body:
    """The mesh of a frame with the paint that the look asks for, as far as it fits."""
    vertices, faces = mesh_frame(product, frame)
    if look.surface == "textured":
        atlas = look.atlas if look.atlas is not None else atlas_of(product)
        if atlas is not None and np.shape(atlas.faces_uv)[0] == len(faces):
            return Body(
                vertices,
                faces,
                uv=np.asarray(atlas.uv, np.float64),
                faces_uv=np.asarray(atlas.faces_uv),
                image=np.asarray(atlas.image),
            )
    if look.surface == "checker":
        reference = look.reference
        if reference is None and one_topology(product):
            reference = mesh_frame(product, 0)[0]
        if reference is not None and len(reference) == len(vertices):
            return Body(vertices, faces, reference=np.asarray(reference, np.float64))
    return Body(vertices, faces)
