"""Motions under parameters, and the graph that joins them."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class TimeWarp(NamedTuple):
    """Which moment of one take belongs to which moment of another: `other[i]` belongs to frame i."""

    # frames, not whole; never goes back
    other: Annotated[np.ndarray, Axes("warped", dtype="float64", unit="frame")]
    # mean dissimilarity along the warp
    cost: Annotated[np.ndarray, Axes(dtype="float64")]


class ParametricSpace(NamedTuple):
    """Takes of one kind of motion, in step with each other, that are blended by weights w (input,).

    Pose k of every input shows the same moment of the motion. Blended, with weights >= 0 of sum 1: the vertices
    (linear, or by blend.hybrid), `motion`, `seconds`. A pose is placed on the ground by the root (x, z, yaw):
    x_world = R_y(yaw) x + (root_x, 0, root_z); from pose k to the next the root moves by
    (x, z) += R_y(yaw) motion[k, :2], then yaw += motion[k, 2], in seconds[k]. Blended by phase, not by time, so that
    a foot that is planted in every input stays planted. A cyclic space goes on from its last pose to its first.
    """

    takes: Annotated[np.ndarray, Axes("input", dtype="str")]
    # in the frame of the root: its ground point under the mean vertex, facing +z; one facing for all spaces of a
    # dataset, so roots of two spaces can be exchanged at a transition
    vertices: Annotated[np.ndarray, Axes("input", "pose", "vertex", "3", unit="m")]
    # to the next pose: dx, dz (m), dyaw (rad); 0 at the last pose unless cyclic
    motion: Annotated[np.ndarray, Axes("input", "pose", "3", dtype="float64")]
    # to the next pose; 0 at the last pose unless cyclic
    seconds: Annotated[np.ndarray, Axes("input", "pose", dtype="float64", unit="s")]
    # left, right foot rests on the ground
    planted: Annotated[np.ndarray, Axes("input", "pose", "2", dtype="bool")]
    # the captured frame (not whole) that each pose shows
    source_frame: Annotated[np.ndarray, Axes("input", "pose", dtype="float64", unit="frame")]
    cyclic: Annotated[np.ndarray, Axes(dtype="bool")]
    # what the user controls: speed, turning, height, length, reach_x, reach_y, reach_z, reach_width
    parameters: Annotated[np.ndarray, Axes("parameter", dtype="str")]
    units: Annotated[np.ndarray, Axes("parameter", dtype="str")]
    # of the inputs as they are
    value: Annotated[np.ndarray, Axes("input", "parameter", dtype="float64")]
    # the same from 0 to 1: coordinates in which weights are linear within a cell
    control: Annotated[np.ndarray, Axes("input", "parameter", dtype="float64")]
    # inputs that are blended with each other: intervals, triangles, tetrahedra of `control`
    cells: Annotated[np.ndarray, Axes("cell", "corner", dtype="int32")]
    # the sampled map p = f(w), measured on blends
    sample_weight: Annotated[np.ndarray, Axes("sample", "input", dtype="float64")]
    sample_value: Annotated[np.ndarray, Axes("sample", "parameter", dtype="float64")]
    # the inverse f^-1 on a regular grid from `lower` to `upper` (last parameter fastest), linear between: controls,
    # from which weights follow in their cell; where a value cannot be reached, the nearest that can
    lower: Annotated[np.ndarray, Axes("parameter", dtype="float64")]
    upper: Annotated[np.ndarray, Axes("parameter", dtype="float64")]
    grid: Annotated[np.ndarray, Axes("parameter", dtype="int32")]
    inverse: Annotated[np.ndarray, Axes("entry", "parameter", dtype="float64")]
    # distance of f(f^-1(p)) from p, in shares of the range, on blends that were not sampled: mean, greatest
    inverse_error: Annotated[np.ndarray, Axes("parameter", "2", dtype="float64")]
    # the vertex and pose that `reach` measures; -1 where it does not
    reach: Annotated[np.ndarray, Axes("2", dtype="int32")]
    # the vertices that `reach_width` lies between, at the pose of `reach`; -1 where it is not measured
    hands: Annotated[np.ndarray, Axes("2", dtype="int32")]
    # whether values out of reach are refused (else clamped)
    refuse: Annotated[np.ndarray, Axes(dtype="bool")]
    faces: Annotated[np.ndarray, Axes("face", "3", dtype="int32")]
    fps: Annotated[np.ndarray, Axes(dtype="float32", unit="Hz")]


class ParametricGraph(NamedTuple):
    """Parametric spaces as nodes; edges with what a transition costs from any pose and weights to any other.

    Each space has references: its inputs and blends between them at bisected weights. Tables are flat, one after
    another; kernels.transition_tables.edge_tables gives those of one edge.
    """

    spaces: Annotated[np.ndarray, Axes("space", dtype="str")]
    poses: Annotated[np.ndarray, Axes("space", dtype="int32")]
    cyclic: Annotated[np.ndarray, Axes("space", dtype="bool")]
    # parameters, references and cells of each space
    dimensions: Annotated[np.ndarray, Axes("space", dtype="int32")]
    references: Annotated[np.ndarray, Axes("space", dtype="int32")]
    cells: Annotated[np.ndarray, Axes("space", dtype="int32")]
    # whether a walk over the edges can go on from here for ever, and come back
    core: Annotated[np.ndarray, Axes("space", dtype="bool")]
    # takes of all spaces, and the space of each
    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    take_space: Annotated[np.ndarray, Axes("take", dtype="int32")]
    # controls of all references of all spaces; unused columns are 0. The first of a space are its inputs
    reference_control: Annotated[np.ndarray, Axes("reference", "control", dtype="float64")]
    # corners of all cells of all spaces among the references of their space; unused ones are -1
    corners: Annotated[np.ndarray, Axes("cell", "corner", dtype="int32")]
    # the reference at each lattice point of each cell (kernels.control_cells.lattice), flat per space
    lattice: Annotated[np.ndarray, Axes("place", dtype="int32")]
    # 2^subdivisions: parts into which each edge of a cell is cut
    halves: Annotated[np.ndarray, Axes(dtype="int32")]
    # seconds to the next pose, flat (reference, pose) per space
    seconds: Annotated[np.ndarray, Axes("step", dtype="float64", unit="s")]
    # squared distance of references of one space at one pose, flat (pose, reference, reference) per space
    spread: Annotated[np.ndarray, Axes("spread", unit="m2")]
    # products of the steps of references to the next pose, s_p . s_q, flat (pose, reference, reference) per space
    stride: Annotated[np.ndarray, Axes("spread", unit="m2")]
    # edges: from which space to which
    source: Annotated[np.ndarray, Axes("edge", dtype="int32")]
    target: Annotated[np.ndarray, Axes("edge", dtype="int32")]
    # least dissimilarity along the edge
    best: Annotated[np.ndarray, Axes("edge", dtype="float64")]
    # squared distance, flat (source pose, source reference, target pose, target reference) per edge
    distance: Annotated[np.ndarray, Axes("pair", unit="m2")]
    # greatest squared distance in any table: dissimilarity = squared distance / largest
    largest: Annotated[np.ndarray, Axes(dtype="float64", unit="m2")]
    # the baseline: fixed transitions per edge, best first; columns: source, target
    fixed_edge: Annotated[np.ndarray, Axes("fixed", dtype="int32")]
    fixed_pose: Annotated[np.ndarray, Axes("fixed", "2", dtype="int32")]
    fixed_reference: Annotated[np.ndarray, Axes("fixed", "2", dtype="int32")]
    fixed_cost: Annotated[np.ndarray, Axes("fixed", dtype="float64")]
    # settings of the search: lambda (thousandths of dissimilarity per 1/25 s), depth of the trellis, its step in time
    # and in controls (share of the whole), greatest dissimilarity at which a transition is made
    latency_weight: Annotated[np.ndarray, Axes(dtype="float64")]
    depth: Annotated[np.ndarray, Axes(dtype="int32")]
    step: Annotated[np.ndarray, Axes(dtype="float64")]
    threshold: Annotated[np.ndarray, Axes(dtype="float64")]


class SpaceSuggestion(NamedTuple):
    """Which takes belong in one parametric space."""

    takes: Annotated[np.ndarray, Axes("take", dtype="str")]
    # takes of one label belong together; labels in order of first appearance
    label: Annotated[np.ndarray, Axes("take", dtype="int32")]
    # mean dissimilarity along the best warp of one take onto another
    distance: Annotated[np.ndarray, Axes("take", "other", unit="1")]
    # joins of the tree, scipy's layout: two clusters, their distance, takes in the new one
    joins: Annotated[np.ndarray, Axes("join", "4", dtype="float64")]
    # distance below which clusters were joined
    cut: Annotated[np.ndarray, Axes(dtype="float64")]
