"""Non-rigid registration of a template surface to another surface."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.deformation_graph import (
    DeformationGraph,
    carried,
    deformation_graph,
    farthest_samples,
)
from reperform.nodes.kernels.graph_fit import deform, fit_step, link_arms, node_motions
from reperform.nodes.kernels.mesh_geometry import vertex_areas, vertex_normals
from reperform.nodes.kernels.surface_pull import FitTarget, surface_pull
from reperform.nodes.kernels.texture_tracks import Sights, add_sight_pull


class Template(NamedTuple):
    """The surface whose topology all frames get, and its deformation graphs from coarse to fine."""

    vertices: np.ndarray  # (V, 3) float64, m
    faces: np.ndarray  # (F, 3)
    share: np.ndarray  # (V,) area of each vertex over the mean area
    rigid: DeformationGraph
    graphs: tuple[DeformationGraph, ...]


class Stage(NamedTuple):
    """One level of a coarse-to-fine fit."""

    graph: DeformationGraph
    scale: float  # of the Welsch loss, m
    stiffness: float
    iterations: int
    slip: float = np.inf  # at which stretch a link lets go, as a share of its length


class Pull(NamedTuple):
    """How surfaces draw on each other, and their texture."""

    normal_length: float  # m; normals count in the closest point search like this distance
    tangential: float  # share of a pull that is not along the normal
    prior: float  # weight of where a vertex was expected, against one closest point
    texture: float = 0.0  # weight of one camera's track, against one closest point


# The lines of sight of vertices expected at (V, 3) in the first or a later look.
Tracker = Callable[[np.ndarray, int], Sights]
# Texture is looked up twice: from where motion leads, and again from where the coarsest fit came to.
_LOOKS = 2
# Tracks are dropped at this share of the distance at which closest points are.
_TRACK_SCALE = 0.4


def make_template(vertices: np.ndarray, faces: np.ndarray, patches: int, levels: int) -> Template:
    """A template with `levels` graphs, the first of `patches` nodes, each of twice as many as the one
    before."""
    rest = np.ascontiguousarray(vertices, np.float64)
    samples, distances = farthest_samples(rest, faces, patches * 2 ** (levels - 1))
    graphs = [deformation_graph(rest, samples, distances, patches * 2**k) for k in range(levels)]
    areas = vertex_areas(rest, faces)
    rigid = deformation_graph(rest, samples, distances, 1)
    return Template(rest, np.asarray(faces), areas / areas.mean(), rigid, tuple(graphs))


def register(
    template: Template,
    start: np.ndarray,
    target: FitTarget,
    stages: tuple[Stage, ...],
    pull: Pull,
    tracker: Tracker | None = None,
) -> np.ndarray:
    """The template's vertices (V, 3) fitted to a target, from the pose `start` (V, 3).

    Each stage takes Gauss-Newton steps from where the last ended: two-way closest points pull, links
    between nodes resist changes of the pose against `start` and of the lengths against the template, and
    `start` itself pulls weakly where nothing else does. A `tracker` adds lines of sight on which texture was
    found again. In the end the template is deformed afresh by the
    motions found, so that no detail wears off along a chain of frames.
    """
    moved = start
    sights = None
    for look, stage in enumerate(stages):
        if tracker is not None and look < _LOOKS:
            sights = tracker(moved, look)
        graph = carried(stage.graph, start)
        bent, _ = node_motions(stage.graph, template.vertices, start)
        upright = np.broadcast_to(np.eye(3), bent.shape)
        arms = link_arms(stage.graph, template.vertices, bent, upright)
        rotation, translation = node_motions(graph, start, moved)
        for _ in range(stage.iterations):
            tensor, force = _pull(template, moved, start, target, stage.scale, pull)
            if sights is not None:
                add_sight_pull(sights, moved, _TRACK_SCALE * stage.scale, pull.texture, tensor, force)
            rotation, translation = fit_step(
                graph, start, rotation, translation, arms, tensor, force, stage.stiffness, stage.slip
            )
            moved = deform(graph, start, rotation, translation)
    finest = stages[-1].graph
    return deform(finest, template.vertices, *node_motions(finest, template.vertices, moved))


def register_rigidly(
    template: Template, start: np.ndarray, target: FitTarget, scale: float, iterations: int, pull: Pull
) -> tuple[np.ndarray, float]:
    """`start` (V, 3) moved as one piece towards the target, and the cost (m, see `surface_pull`) there."""
    graph = carried(template.rigid, start)
    rotation, translation = np.eye(3)[None], np.zeros((1, 3))
    arms = np.zeros((0, 2, 3))
    moved = start
    for _ in range(iterations):
        tensor, force = _pull(template, moved, start, target, scale, pull._replace(prior=0.0))
        rotation, translation = fit_step(graph, start, rotation, translation, arms, tensor, force, 0.0)
        moved = deform(graph, start, rotation, translation)
    return moved, misfit(template, moved, target, scale, pull)


def misfit(template: Template, moved: np.ndarray, target: FitTarget, scale: float, pull: Pull) -> float:
    """Cost (m) of a pose of the template: the robust mean distance of the two surfaces (`surface_pull`)."""
    normals = vertex_normals(moved, template.faces)
    return surface_pull(moved, normals, template.share, target, scale, pull.normal_length, pull.tangential)[2]


def predict(template: Template, parent: np.ndarray, grandparent: np.ndarray, ratio: float) -> np.ndarray:
    """Where the motion from grandparent to parent leads if it goes on for `ratio` times as long: (V, 3).

    Each node of the coarsest graph repeats its last step: it turns on by S = R_1 R_0^T and goes on by S
    (y_1 - y_0), which is exact for a steady rigid motion. For part of a step it goes on straight, without
    turning.
    """
    graph = template.graphs[0]
    turned, shifted = node_motions(graph, template.vertices, parent)
    before, came = node_motions(graph, template.vertices, grandparent)
    step = turned @ np.swapaxes(before, 1, 2)
    whole = ratio > 0.75
    rotation = step @ turned if whole else turned
    course = np.einsum("kij,kj->ki", step, shifted - came) if whole else shifted - came
    places = shifted + ratio * course
    # detail that the coarse graph does not carry stays as it is at the parent
    detail = parent - deform(graph, template.vertices, turned, shifted)
    return deform(graph, template.vertices, rotation, places) + detail


def _pull(
    template: Template,
    moved: np.ndarray,
    start: np.ndarray,
    target: FitTarget,
    scale: float,
    pull: Pull,
) -> tuple[np.ndarray, np.ndarray]:
    normals = vertex_normals(moved, template.faces)
    tensor, force, _ = surface_pull(
        moved, normals, template.share, target, scale, pull.normal_length, pull.tangential
    )
    tensor += pull.prior * np.eye(3)
    force += pull.prior * (start - moved)
    return tensor, force
