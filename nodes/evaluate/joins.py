"""Whether one sees where captured pieces were joined."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.join_acceleration import join_acceleration_ratio
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation


@node(over="dataset", memory=1.0)
def joins(
    animation: Animation,
    meshes: Dataset[MeshSequence],
    *,
    quantile: Annotated[
        float, Param("1", 0.5, 1.0, "over the vertices of a frame; 1: the peak vertex")
    ] = 0.99,
) -> Measures:
    """Peak acceleration at the joins of a motion over that of the capture; <= 1: joins do not show.

    r = max over frames at joins of q_v |x_v(t+1) - 2 x_v(t) + x_v(t-1)| / 99th percentile over the captured frames
    of the same, q_v the quantile over vertices. Frames at joins are the blended ones and their neighbours. One row,
    entry `acceleration ratio`; nan where the motion has no join.

    Raises ValueError where motion and capture differ in vertices or frame rate.
    Source: 000 section 6.1 and Kovar, Gleicher and Pighin 2002 (joins must not pop).
    Departure: measured against the capture itself, since neither gives a figure.
    """
    mesh = animation.mesh
    for name, take in meshes.items():
        same = take.vertices.shape[1] == mesh.vertices.shape[1]
        if not same or float(np.asarray(take.fps)) != float(mesh.fps):
            raise ValueError(
                f"evaluate.joins: take {name!r} must have the vertices and rate of the motion, "
                f"{mesh.vertices.shape[1]} at {float(mesh.fps):g} Hz, got {take.vertices.shape[1]} at "
                f"{float(np.asarray(take.fps)):g} Hz: wire the meshes that the motion is made of"
            )
    captured = [np.asarray(take.vertices) for take in meshes.values()]
    weight = np.asarray(animation.provenance.weight)
    value = join_acceleration_ratio(np.asarray(mesh.vertices), weight, captured, float(mesh.fps), quantile)
    return Measures(np.array([[value]]), np.array(["acceleration ratio"]), np.array(["1"]))
