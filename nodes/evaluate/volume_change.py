"""Whether a synthesised body shrinks or swells."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.kernels.path_mean import path_mean
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation
from reperform.nodes.synthesis.source_takes import source_takes


@node(over="dataset", memory=1.0)
def volume_change(animation: Animation, meshes: Dataset[MeshSequence]) -> Measures:
    """|V(t) / sum_i w_i V_i - 1| of every frame: its volume against that of its sources, by their weights.

    Raises ValueError where a take of the path is missing or takes differ in topology.
    Source: definition.
    """
    origin, faces = animation.provenance, np.asarray(animation.mesh.faces)
    takes, number = source_takes(animation, meshes, "evaluate.volume_change")
    captured = [volume(np.asarray(take.vertices), faces) for take in takes]
    wanted = path_mean(number, np.asarray(origin.source_frame), np.asarray(origin.weight), captured)
    change = np.abs(volume(np.asarray(animation.mesh.vertices), faces) / wanted - 1.0)
    return Measures(change[:, None], np.array(["volume change"]), np.array(["1"]))
