"""Bringing one take into step with another."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.contact_keys import common_keys, contact_events
from reperform.nodes.kernels.ground_plane_distance import ground_plane_distance
from reperform.nodes.kernels.time_warp import continuous_warp, shortest_warp
from reperform.nodes.product import Pair
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.parametric import TimeWarp
from reperform.nodes.products.performance import Contacts

_WHO = "blend.time_warp"
# vertices on which poses are compared
_SAMPLE = 400


@node(over="pair", memory=1.0)
def time_warp(
    mesh: Pair[MeshSequence],
    contacts: Pair[Contacts] | None = None,
    *,
    keys: Annotated[
        tuple[str, ...], Param(about="moments that must coincide, in seconds of each take: FIRST:SECOND")
    ] = (),
    velocity_weight: Annotated[
        float, Param("1", 0.0, 100.0, "weight of motion per frame against shape")
    ] = 1.0,
) -> TimeWarp:
    """For every frame of the first take the moment of the second that belongs to it, from end to end.

    mesh: two takes of one topology, m; contacts: which feet rest on the ground. The shortest path over the matrix of
    dissimilarities (vertices and velocities, apart from where the bodies stand and face) from corner to corner, made
    smooth and monotone. It passes exactly through `keys` or, without them, through the feet coming down and going up
    that both takes have in the same order.

    Raises ValueError where the takes differ in topology, or keys cannot be read or do not rise.

    Source: 001 and 004 section 3.2.1 (fig 3.1).
    Departure: monotone and continuous, where 004 keeps the frame-to-frame steps of the path.
    """
    first, second = mesh
    if first.vertices.shape[1] != second.vertices.shape[1] or not np.array_equal(first.faces, second.faces):
        raise ValueError(
            f"{_WHO}: both takes must share one topology, got {first.vertices.shape[1]} and "
            f"{second.vertices.shape[1]} vertices: align them first (align.register)"
        )
    step = max(1, first.vertices.shape[1] // _SAMPLE)
    a, b = (np.asarray(take.vertices)[:, ::step].astype(np.float64) for take in mesh)
    u, v = (np.gradient(x, axis=0) if len(x) > 1 else np.zeros_like(x) for x in (a, b))
    distance = ground_plane_distance(a, b, u, v, velocity_weight)
    cells = _given(keys, float(np.asarray(first.fps)), float(np.asarray(second.fps)))
    if not keys and contacts is not None:
        moments = common_keys([contact_events(np.asarray(feet.planted)) for feet in contacts])
        cells = np.floor(moments).astype(np.int64).T
    path, cost = shortest_warp(distance, cells)
    return TimeWarp(continuous_warp(path, cells), np.array(cost))


def _given(keys: tuple[str, ...], fps: float, other_fps: float) -> np.ndarray:
    """Frames (K, 2) of key moments."""
    try:
        pairs = [[float(time) for time in text.split(":")] for text in keys]
    except ValueError as error:
        raise ValueError(f"{_WHO}: keys are FIRST:SECOND in seconds, got {', '.join(keys)}") from error
    if any(len(pair) != 2 for pair in pairs):
        raise ValueError(f"{_WHO}: keys are FIRST:SECOND in seconds, got {', '.join(keys)}")
    return np.round(np.array(pairs).reshape(-1, 2) * [fps, other_fps]).astype(np.int64)
