"""A parametric motion space: takes of one kind of motion under the parameters that tell them apart."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.control_cells import cells_of
from reperform.nodes.kernels.hands_apart import hands_apart
from reperform.nodes.kernels.motion_parameters import UNITS, Parameter
from reperform.nodes.kernels.parameter_map import Method
from reperform.nodes.kernels.parameter_samples import (
    check_invertible,
    inverse_error,
    measured_map,
    reach_marker,
)  # fmt: skip
from reperform.nodes.kernels.root_frame import mean_shape
from reperform.nodes.kernels.space_inputs import SpaceInputs, bring_into_step
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.parametric import ParametricSpace
from reperform.nodes.products.performance import Contacts

_WHO = "motion_graph.space"
# inputs nearer to each other than this share of the range do the same
_TWINS = 0.005


@node(over="dataset", memory=2.0)
def space(
    meshes: Dataset[MeshSequence],
    contacts: Dataset[Contacts] | None = None,
    *,
    takes: Annotated[tuple[str, ...], Param(about="takes that are blended, two or more; empty: all")] = (),
    parameters: Annotated[
        tuple[Parameter, ...],
        Param(about="what the user controls, one to three; they must tell the takes apart"),
    ] = ("speed",),
    cyclic: Annotated[bool, Param(about="one cycle that repeats itself (else the whole take, once)")] = True,
    poses: Annotated[
        int, Param("1", 0, 400, "poses of the space; 0: as many as the longest take has frames")
    ] = 0,
    keys: Annotated[
        tuple[str, ...],
        Param(
            about="key frames that must coincide: TAKE SECONDS SECONDS .., as many per take; a cycle begins at the first"
        ),
    ] = (),
    inverse: Annotated[Method, Param(about="how parameters are turned into weights")] = "monotone",
    outside: Annotated[
        Literal["clamp", "refuse"], Param(about="what becomes of a parameter that cannot be reached")
    ] = "clamp",
    blend: Annotated[
        Literal["nonlinear", "linear"], Param(about="how poses are blended where a reach is measured")
    ] = "nonlinear",
    hand: Annotated[
        int, Param("vertex", -1, None, "vertex that reaches; -1: the one that tells takes most apart")
    ] = -1,
) -> ParametricSpace:
    """Takes brought into step, so that any mixture of them is a motion, and the map from what it does to weights.

    meshes: takes of one topology, m; contacts: which feet rest on the ground. Poses are told from travel (the root),
    one cycle is cut out and closed, takes are warped in time onto each other with feet coming down (and going up,
    where all takes agree in order) as hard constraints. Blends are measured at weights 0.05 apart (0.1 with three
    parameters), p = f(w), and f is
    inverted.

    Raises ValueError where takes are fewer than two or unknown, differ in topology or rate, do not repeat themselves
    though cyclic, key frames do not agree, a parameter does not vary, or the map cannot be inverted.

    A reach is measured where the takes differ most: the place of a vertex from the root (reach_x, _y, _z), or the gap
    between two hands (reach_width), as wide as the box that they would hold.

    Source: 001 sections 3.1-3.2, 004 section 3.2 (figs 3.1, 3.2).
    Departure: parameters are blended piecewise between neighbouring takes (Delaunay), so that more takes only make the
    map better; the inverse is monotone by default (polynomials of degree 3 as in 004 by choice).
    """
    names = _chosen(tuple(meshes), takes)
    _require_alike(meshes, names)
    if not 1 <= len(parameters) <= 3 or len(set(parameters)) < len(parameters):
        raise ValueError(
            f"{_WHO}: one to three different parameters needed, got {', '.join(parameters) or 'none'}"
        )
    first = meshes[next(iter(meshes))]
    reference = mean_shape(np.asarray(first.vertices))
    fps = float(np.asarray(first.fps))
    planted = None if contacts is None else [np.asarray(contacts[name].planted) for name in names]
    inputs = bring_into_step(
        names, [np.asarray(meshes[name].vertices) for name in names], planted, reference, fps, cyclic, poses,
        _key_times(keys, names), _WHO,
    )  # fmt: skip
    return _mapped(
        inputs, names, np.asarray(first.faces), fps, cyclic, parameters, inverse, outside, blend, hand
    )


def _mapped(
    inputs: SpaceInputs, names: tuple[str, ...], faces: np.ndarray, fps: float, cyclic: bool,
    parameters: tuple[Parameter, ...], method: Method, outside: str, blend: str, hand: int,
) -> ParametricSpace:  # fmt: skip
    """The space with its parameter map."""
    marker = (
        reach_marker(inputs.vertices, hand)
        if any(name.startswith("reach") for name in parameters)
        else (-1, -1)
    )
    hands = hands_apart(inputs.vertices[:, marker[1]], marker[0]) if "reach_width" in parameters else (-1, -1)
    sampler = measured_map(inputs, faces, parameters, marker, hands, blend == "nonlinear")
    value = sampler(np.eye(len(names)))
    span = np.ptp(value, axis=0)
    for name, low, wide in zip(parameters, value.min(axis=0), span, strict=True):
        if wide <= 1e-3 * max(1.0, abs(low)):
            raise ValueError(
                f"{_WHO}: parameter {name} does not vary over {', '.join(names)}: it is {low:.3f} {UNITS[name]} "
                "throughout; choose takes that differ in it, or another parameter"
            )
    control = (value - value.min(axis=0)) / span
    _require_apart(control, names, parameters)
    corners = cells_of(control)
    weights, samples, table = check_invertible(sampler, control, corners, parameters, method, _WHO)
    error = inverse_error(sampler, control, corners, table)
    return ParametricSpace(
        np.array(names), inputs.vertices, inputs.motion, inputs.seconds, inputs.planted, inputs.source_frame,
        np.asarray(cyclic), np.array(parameters), np.array([UNITS[name] for name in parameters]), value, control,
        corners, weights, samples, table.lower, table.upper, table.grid, table.inverse, error,
        np.array(marker, np.int32), np.array(hands, np.int32), np.asarray(outside == "refuse"), faces,
        np.asarray(fps, np.float32),
    )  # fmt: skip


def _require_apart(control: np.ndarray, names: tuple[str, ...], parameters: tuple[Parameter, ...]) -> None:
    apart = np.abs(control[:, None] - control[None]).max(axis=2) + np.eye(len(names))
    if apart.min() < _TWINS:
        one, other = divmod(int(np.argmin(apart)), len(names))
        raise ValueError(
            f"{_WHO}: the map from weights to {', '.join(parameters)} cannot be inverted: {names[one]} and "
            f"{names[other]} do the same; leave out one of them, or add a parameter that tells them apart"
        )


def _chosen(known: tuple[str, ...], takes: tuple[str, ...]) -> tuple[str, ...]:
    names = takes or known
    missing = [name for name in names if name not in known]
    if missing:
        raise ValueError(f"{_WHO}: no take {', '.join(missing)}; there are {', '.join(known)}")
    if len(names) < 2:
        raise ValueError(
            f"{_WHO}: a space needs two takes or more to blend, got {', '.join(names) or 'none'}: add a take of the "
            "same motion done differently"
        )
    return names


def _require_alike(meshes: Dataset[MeshSequence], names: tuple[str, ...]) -> None:
    first = meshes[names[0]]
    for name in names[1:]:
        other = meshes[name]
        if other.vertices.shape[1] != first.vertices.shape[1] or not np.array_equal(other.faces, first.faces):
            raise ValueError(
                f"{_WHO}: takes must share one topology; {name} ({other.vertices.shape[1]} vertices) differs from "
                f"{names[0]} ({first.vertices.shape[1]}): align them first (align.register)"
            )
        if not np.isclose(other.fps, first.fps):
            raise ValueError(
                f"{_WHO}: takes must share one frame rate; {names[0]} has {float(first.fps):g} Hz, {name} "
                f"{float(other.fps):g} Hz: resample one"
            )


def _key_times(keys: tuple[str, ...], names: tuple[str, ...]) -> np.ndarray | None:
    """Key frames (takes, K) in seconds, as the user gives them."""
    if not keys:
        return None
    given = {text.split()[0]: text.split()[1:] for text in keys if text.split()}
    counts = {len(times) for times in given.values()}
    if set(given) != set(names) or len(counts) != 1:
        raise ValueError(
            f"{_WHO}: key frames must name every take once, with as many times each (TAKE SECONDS SECONDS ..), got "
            f"{'; '.join(keys)} for {', '.join(names)}"
        )
    try:
        return np.array([[float(time) for time in given[name]] for name in names])
    except ValueError as error:
        raise ValueError(f"{_WHO}: key frames are times in seconds, got {'; '.join(keys)}") from error
