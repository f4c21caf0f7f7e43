"""Registration of all frames of all takes to the surface of one root frame."""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from reperform.nodes.align.frame_views import FrameViews
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.closest_point import closest_points
from reperform.nodes.kernels.limb_lengths import limb_lengths
from reperform.nodes.kernels.mesh_geometry import edges, face_areas, volume
from reperform.nodes.kernels.motion_history import motion_history
from reperform.nodes.kernels.registration import (
    Pull,
    Stage,
    Template,
    Tracker,
    make_template,
    misfit,
    predict,
    register_rigidly,
)
from reperform.nodes.kernels.registration import register as fit
from reperform.nodes.kernels.spanning_tree import rehang
from reperform.nodes.kernels.surface_pull import FitTarget, fit_target
from reperform.nodes.kernels.take_chains import chain_takes
from reperform.nodes.kernels.tree_walk import walk_tree
from reperform.nodes.kernels.turn_search import likely_turns, turn_matrix
from reperform.nodes.product import Dataset
from reperform.nodes.products.aligned import AlignedSequence
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Footage
from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.products.motion import ShapeTree

# A frame this near in time to its parent continues the parent's motion; others are placed anew.
_NEAR = 2
_TURNS = 3
# Normals count in the search for closest points like this distance (m): about the thickness of a limb.
_NORMAL_LENGTH = 0.15
# Branches of the tree that are followed at a time.
_THREADS = 2


@node(over="dataset", memory=2.0, threads=2)
def register(
    surfaces: Dataset[Surfaces],
    tree: ShapeTree,
    footage: Dataset[Footage] | None = None,
    cameras: Dataset[Cameras] | None = None,
    *,
    root: Annotated[
        Literal["limbs", "spread", "tree"],
        Param(
            about="limbs: the frame whose limbs are clear of each other and of loose clothes; spread: whose surface "
            "shows most; tree: the tree's own root"
        ),
    ] = "limbs",
    limbs: Annotated[int, Param("limbs", 1, 50, "of the performer, head included")] = 5,
    route: Annotated[
        Literal["takes", "tree"],
        Param(about="takes: each in time, joined by the tree's shortest edges; tree: along the tree"),
    ] = "takes",
    patches: Annotated[int, Param("nodes", 8, 500, "of the coarsest deformation graph")] = 60,
    levels: Annotated[int, Param("levels", 1, 5, "each with twice as many nodes as the last")] = 3,
    reach: Annotated[
        float, Param("m", 0.01, 1.0, "distance at which closest points lose their pull, coarsest level")
    ] = 0.12,
    detail: Annotated[float, Param("m", 0.002, 0.5, "the same at the finest level")] = 0.05,
    stiffness: Annotated[
        float, Param("1", 0.0, 1000.0, "resistance to change of shape against one closest point")
    ] = 0.2,
    slip: Annotated[
        float,
        Param("1", 0.05, 1000.0, "change of shape, against its size, at which it is no longer resisted"),
    ] = 0.5,
    tangential: Annotated[
        float, Param("1", 0.0, 1.0, "share of a closest point's pull that is not along its normal")
    ] = 0.4,
    iterations: Annotated[int, Param("steps", 1, 50, "Gauss-Newton steps per level")] = 3,
    prior: Annotated[
        float, Param("1", 0.0, 10.0, "pull of the expected place against one closest point")
    ] = 0.03,
    texture: Annotated[
        float, Param("1", 0.0, 100.0, "pull of one camera's track against one closest point")
    ] = 4.0,
    round_trip: Annotated[float, Param("px", 0.1, 20.0, "largest error of a track followed back")] = 1.0,
    residual_gate: Annotated[float, Param("m", 0.0, 1.0, "largest residual of a trusted frame")] = 0.02,
    stretch_gate: Annotated[float, Param("1", 0.0, 10.0, "largest stretch of a trusted frame")] = 0.3,
) -> Dataset[AlignedSequence]:
    """All takes in one topology: vertex i is the same point of the performer in every frame.

    From the root, each frame's surface is fitted along the branches of the tree: the parent's aligned mesh
    is carried on by its motion (consecutive frames; where a take is entered, time is followed first in the direction
    in which less moves, and that motion continued in the other) or turned and shifted on the ground to where shape
    histograms agree best (frames of other times or takes), then fitted from coarse to fine by deformation
    graphs, E = sum rho(x_i - y_i) + stiffness sum_(jk) rho(R_j a_jk - (g_k - g_j)), with rho Welsch's loss
    of two-way closest points of compatible normals, and of changes of shape of the scale slip |a_jk|, a_jk the
    root's lengths in the parent's pose.

    Where footage and cameras are given, E has a term texture sum_(ic) rho(distance of x_i from the line of
    sight of camera c on which the texture of vertex i is found again): it tells crossing legs apart and
    keeps cloth from sliding. Tracks go from the parent's picture to the frame's by pyramidal Lucas-Kanade
    from where the vertex is expected; those that do not return within `round_trip` are dropped.

    Vertices in metres, float32. `residual` tells surface distance only; it cannot tell a limb on the wrong
    side.
    Raises ValueError where tree and surfaces, or footage and cameras, do not belong together.

    Source: 004 section 2.2.3; Sumner, Schmid and Pauly, SIGGRAPH 2007 (deformation graph); Li, Sumner and
    Pauly, SGP 2008; Yao, Deng, Xu and Zhang, CVPR 2020 (Welsch loss); Bouguet, Intel 2001 (tracking).
    Departure: deformation graphs, robust two-way closest points and tracks in place of rigid patches, SIFT and one
    Laplacian solve (eq 2.2); by default each take is followed in time, where texture can be tracked; the root is
    moved to a frame whose limbs are clear of each other and of the clothes, since what the root's surface joins can
    never come apart.
    """
    if (footage is None) != (cameras is None):
        given, missing = ("cameras", "footage") if footage is None else ("footage", "cameras")
        raise ValueError(f"register: footage and cameras go together, got {given} only: wire {missing} too")
    frames = _frames(surfaces, tree)
    parent, order = np.asarray(tree.parent), np.asarray(tree.order)
    if root != "tree":
        scores = _limb_scores(frames, limbs) if root == "limbs" else _spread_scores(frames)
        parent, order = rehang(parent, int(order[np.argmax(scores[order])]))
    if route == "takes":
        parent, order = chain_takes(tree.take, tree.frame_index, tree.parent, tree.distance, int(order[0]))
    first = frames[order[0]]
    template = make_template(first.vertices, first.faces, patches, levels)
    stages = _stages(template, reach, detail, stiffness, slip, iterations)
    pull = Pull(_NORMAL_LENGTH, tangential, prior, texture)
    views = None
    if footage is not None and cameras is not None and texture > 0:
        views = FrameViews(footage, cameras)
    aligned: dict[int, np.ndarray] = {int(order[0]): template.vertices}
    figures = {int(order[0]): (0.0, 0.0)}
    lengths = edges(template.faces)
    names = [(str(tree.takes[frame.take]), frame.instant) for frame in frames]
    before, after = motion_history(
        tree.take, tree.frame_index, parent, _NEAR, lambda k: _change(frames[int(parent[k])], frames[k])
    )

    row = {(frame.take, frame.instant): k for k, frame in enumerate(frames)}

    def visit(k: int) -> None:
        if k == order[0]:
            return
        up = int(parent[k])
        target = fit_target(frames[k].vertices, frames[k].faces, pull.normal_length)
        tracker = None
        if views is not None:
            tracker = views.tracker((names[up], names[k]), aligned[up], template.faces, round_trip)
        step = frames[k].instant - frames[up].instant
        if frames[k].take != frames[up].take or abs(step) > _NEAR:
            start = _placed(template, frames, aligned[up], up, k, target, stages[0], pull)
        else:
            options = [aligned[up]]
            if before[k] >= 0:
                came = frames[up].instant - frames[int(before[k])].instant
                options.append(predict(template, aligned[up], aligned[int(before[k])], step / came))
            elif (ahead := row.get((frames[k].take, frames[k].instant + step))) is not None:
                options.append(
                    _halfway(template, aligned[up], target, frames[ahead], stages[:1], pull, tracker)
                )
            costs = [misfit(template, pose, target, stages[0].scale, pull) for pose in options]
            start = options[int(np.argmin(costs))]
        aligned[k] = fit(template, start, target, stages, pull, tracker)
        figures[k] = _figures(template, aligned[k], frames[k], lengths)

    # the banded solves are small: several BLAS threads would only wait for each other, and could change bits
    with threadpool_limits(limits=1, user_api="blas"):
        walk_tree(*rehang(after, int(order[0])), visit, _THREADS)
    return {
        name: _sequence(
            surfaces[name], tree, number, template, aligned, figures, order[0], (residual_gate, stretch_gate)
        )
        for number, name in enumerate(map(str, tree.takes))
    }


class _Frame(NamedTuple):
    take: int
    instant: int
    vertices: np.ndarray
    faces: np.ndarray


def _frames(surfaces: Dataset[Surfaces], tree: ShapeTree) -> list[_Frame]:
    names = [str(name) for name in tree.takes]
    counts = np.bincount(tree.take, minlength=len(names))
    for name, count in zip(names, counts, strict=True):
        if name not in surfaces or len(surfaces[name].vertices) != count:
            got = f"{len(surfaces[name].vertices)} frames" if name in surfaces else "no such take"
            raise ValueError(
                f"register: the tree has {count} frames of take {name}, the surfaces have {got}: "
                "make the tree from these surfaces"
            )
    return [
        _Frame(
            int(take),
            int(index),
            np.asarray(surfaces[names[take]].vertices[int(index)]),
            np.asarray(surfaces[names[take]].faces[int(index)]),
        )
        for take, index in zip(tree.take, tree.frame_index, strict=True)
    ]


def _limb_scores(frames: list[_Frame], limbs: int) -> np.ndarray:
    """How clear the limbs of each frame are of all else: its shortest limb, as a share of how long it is in any frame.

    Less the share that what stands out besides has of the mean limb, less 2 % per handle.
    """
    lengths = np.array([limb_lengths(frame.vertices, frame.faces, limbs + 1) for frame in frames])
    own, other = lengths[:, :limbs], lengths[:, limbs]
    shortest = (own / np.maximum(own.max(axis=0), 1e-9)).min(axis=1)
    return shortest * (1 - other / np.maximum(own.mean(axis=1), 1e-9)) * _without_handles(frames)


def _spread_scores(frames: list[_Frame]) -> np.ndarray:
    """How much surface each frame has for its volume, less 2 % per handle."""
    area = np.array([face_areas(frame.vertices, frame.faces).sum() for frame in frames], np.float64)
    size = np.array([volume(frame.vertices, frame.faces) for frame in frames])
    return area / np.maximum(size, 1e-9) ** (2 / 3) * _without_handles(frames)


def _without_handles(frames: list[_Frame]) -> np.ndarray:
    """1 for a closed surface without handles, 2 % less per handle."""
    handles = [max(1 - (len(frame.vertices) - len(frame.faces) // 2) / 2, 0) for frame in frames]
    return 0.98 ** np.array(handles)


def _change(first: _Frame, second: _Frame) -> float:
    """How far the surface moves between two frames: the mean distance (m) from the second to the first."""
    return float(closest_points(second.vertices[::8], first.vertices, first.faces)[2].mean())


def _stages(
    template: Template, reach: float, detail: float, stiffness: float, slip: float, iterations: int
) -> tuple[Stage, ...]:
    scales = np.geomspace(reach, detail, len(template.graphs))
    return tuple(
        Stage(graph, float(scale), stiffness * float(scale / scales[0]), iterations, slip)
        for graph, scale in zip(template.graphs, scales, strict=True)
    )


def _placed(
    template: Template,
    frames: list[_Frame],
    pose: np.ndarray,
    up: int,
    k: int,
    target: FitTarget,
    stage: Stage,
    pull: Pull,
) -> np.ndarray:
    """The pose of a frame `up`, turned and shifted on the ground to where it fits a frame of another time or take."""
    here, there = frames[k], frames[up]
    turns = [(0.0, here.vertices.mean(axis=0) - there.vertices.mean(axis=0))]
    turns += likely_turns((there.vertices, there.faces), (here.vertices, here.faces), _TURNS)
    best, least = pose, np.inf
    for yaw, shift in turns:
        placed, cost = register_rigidly(
            template, pose @ turn_matrix(yaw).T + shift, target, stage.scale, 4, pull
        )
        # a body is nearly the same seen from the back: believe a large turn only for a clear gain
        cost *= 1 + 0.1 * abs(yaw) / np.pi
        if cost < least:
            best, least = placed, cost
    return best


def _halfway(
    template: Template,
    pose: np.ndarray,
    target: FitTarget,
    ahead: _Frame,
    stages: tuple[Stage, ...],
    pull: Pull,
    tracker: Tracker | None,
) -> np.ndarray:
    """Where a first step leads, by a look at the second: halfway from `pose` to a coarse fit of the frame `ahead`.

    A limb that is lost over the first step is often found again over two, from where the rest of the body leads.
    """
    first = fit(template, pose, target, stages, pull, tracker)
    further = fit_target(ahead.vertices, ahead.faces, pull.normal_length)
    second = fit(template, predict(template, first, pose, 1.0), further, stages, pull)
    return predict(template, second, pose, -0.5)


def _figures(template: Template, moved: np.ndarray, frame: _Frame, pairs: np.ndarray) -> tuple[float, float]:
    """Residual (m) and stretch of a fitted frame; every eighth vertex speaks for the others."""
    forth = closest_points(moved[::8], frame.vertices, frame.faces)[2]
    back = closest_points(frame.vertices[::8], moved, template.faces)[2]

    def log_length(vertices: np.ndarray) -> np.ndarray:
        ends = vertices[pairs[:, 0]] - vertices[pairs[:, 1]]
        return np.log(np.maximum(np.linalg.norm(ends, axis=1), 1e-6))

    stretch = np.sqrt(np.mean((log_length(moved) - log_length(template.vertices)) ** 2))
    return float((forth.mean() + back.mean()) / 2), float(stretch)


def _sequence(
    surfaces: Surfaces,
    tree: ShapeTree,
    number: int,
    template: Template,
    aligned: dict[int, np.ndarray],
    figures: dict[int, tuple[float, float]],
    root: int,
    gates: tuple[float, float],
) -> AlignedSequence:
    rows = np.flatnonzero(tree.take == number)
    rows = rows[np.argsort(tree.frame_index[rows], kind="stable")]
    vertices = np.stack([aligned[int(k)] for k in rows]).astype(np.float32)
    residual, stretch = np.array([figures[int(k)] for k in rows], np.float32).T
    return AlignedSequence(
        MeshSequence(vertices, template.faces.astype(np.int32), np.asarray(surfaces.fps, np.float32)),
        residual,
        stretch,
        (residual <= gates[0]) & (stretch <= gates[1]),
        np.asarray(str(tree.takes[tree.take[root]])),
        np.asarray(tree.frame_index[root], np.int32),
    )
