"""One picture of any product."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from reperform.nodes.product import is_product
from reperform.viewer.contents import frame_count, has_mesh, one_topology, summary
from reperform.viewer.pictures.blends import (
    blend_errors_picture,
    blend_space_picture,
    blend_table_picture,
    threshold_curves_picture,
)
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.matrix import matrix_picture
from reperform.viewer.pictures.measure_comparison import measure_comparison_picture
from reperform.viewer.pictures.motion_graph import motion_graph_picture
from reperform.viewer.pictures.motion_path import motion_path_picture
from reperform.viewer.pictures.occupancy import occupancy_picture
from reperform.viewer.pictures.parametric_graph import parametric_graph_picture, space_suggestion_picture
from reperform.viewer.pictures.parametric_space import parametric_space_picture, time_warp_picture
from reperform.viewer.pictures.path_costs import path_costs_picture
from reperform.viewer.pictures.photographs import (
    film_picture,
    film_strip,
    footage_picture,
    mattes_picture,
    plate_picture,
)
from reperform.viewer.pictures.played import played_picture
from reperform.viewer.pictures.pose_graph import pose_graph_picture, pose_transitions_picture
from reperform.viewer.pictures.pose_walk import pose_walk_picture
from reperform.viewer.pictures.pruning_report import pruned_graph_picture, pruning_report_picture
from reperform.viewer.pictures.rig import camera_path_picture, cameras_picture
from reperform.viewer.pictures.shape_tree import shape_tree_picture
from reperform.viewer.pictures.skeleton import (
    mocap_picture,
    skeletal_animation_picture,
    skeleton_picture,
)
from reperform.viewer.pictures.surface import poses_picture, surface_picture
from reperform.viewer.pictures.tabulate import Cell, draw_table, statistics_picture, table_picture
from reperform.viewer.pictures.target_grid import key_frame_table_picture, target_grid_picture

Painter = Callable[[Any, int, Look], np.ndarray]

# By name, so that a plug-in's product of the same name and fields is drawn too.
PAINTERS: dict[str, Painter] = {
    "Footage": footage_picture,
    "CleanPlate": plate_picture,
    "Mattes": mattes_picture,
    "Film": film_picture,
    "Occupancy": occupancy_picture,
    "Cameras": cameras_picture,
    "CameraPath": camera_path_picture,
    "Dissimilarity": matrix_picture,
    "MeasureComparison": measure_comparison_picture,
    "MotionGraph": motion_graph_picture,
    "ParametricSpace": parametric_space_picture,
    "ParametricGraph": parametric_graph_picture,
    "SpaceSuggestion": space_suggestion_picture,
    "TimeWarp": time_warp_picture,
    "ShapeTree": shape_tree_picture,
    "MotionPath": motion_path_picture,
    "Played": played_picture,
    "PathCosts": path_costs_picture,
    "PoseGraph": pose_graph_picture,
    "PoseTransitions": pose_transitions_picture,
    "PoseWalk": pose_walk_picture,
    "SkeletonSequence": skeleton_picture,
    "Mocap": mocap_picture,
    "SkeletalAnimation": skeletal_animation_picture,
    "Table": table_picture,
    "PrunedGraph": pruned_graph_picture,
    "PruningReport": pruning_report_picture,
    "TargetGrid": target_grid_picture,
    "KeyFrameTable": key_frame_table_picture,
    "BlendSpace": blend_space_picture,
    "BlendErrors": blend_errors_picture,
    "BlendTable": blend_table_picture,
    "ThresholdCurves": threshold_curves_picture,
}


def picture(product: Any, frame: int = 0, look: Look | None = None) -> np.ndarray:
    """An RGB uint8 picture (H, W, 3) of one frame of a product, exactly `look.size` large.

    Products with a mesh are drawn in space, the others as photographs, plots or tables; a product that
    nothing fits is shown by the range of its fields. Fields may be lazy: only what is shown is read.

    Raises TypeError where it is not a product, ValueError where it has no such frame.
    """
    look = look if look is not None else Look()
    if not is_product(type(product)):
        raise TypeError(
            f"a picture is made of a product (a NamedTuple of arrays), got {type(product).__name__}"
        )
    count = frame_count(product)
    if not 0 <= frame < max(count, 1):
        raise ValueError(f"{type(product).__name__} has frames 0 .. {count - 1}, got {frame}")
    if count == 0:
        rows = [[Cell(name), Cell(layout)] for name, layout in summary(product)]
        return draw_table(["field", "holds"], rows, look.size, f"{type(product).__name__} without frames")
    return painter(product)(product, frame, look)


def painter(product: Any) -> Painter:
    """What draws this product."""
    named = PAINTERS.get(type(product).__name__)
    if named is not None:
        return named
    return surface_picture if has_mesh(product) else statistics_picture


def overview(product: Any, look: Look | None = None) -> np.ndarray:
    """The picture for a report: poses of a mesh through time, frames of a film, else the middle frame.

    Meshes of one topology get the checker unless they are textured.
    """
    look = look if look is not None else Look()
    count = frame_count(product)
    if type(product).__name__ == "Film" and count > 1:
        return film_strip(product, look)
    if type(product).__name__ not in PAINTERS and has_mesh(product) and count > 0:
        if look.surface == "shaded" and type(product).__name__ == "AlignedSequence" and one_topology(product):
            look = replace(look, surface="checker")
        return poses_picture(product, look) if count > 1 else surface_picture(product, 0, look)
    return picture(product, count // 2, look)
