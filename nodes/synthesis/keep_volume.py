"""Blends as voluminous as what they blend."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.kernels.path_mean import path_mean
from reperform.nodes.kernels.volume_keeping import with_volume
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation
from reperform.nodes.synthesis.source_takes import source_takes


@node(over="dataset", memory=1.0)
def keep_volume(animation: Animation, meshes: Dataset[MeshSequence]) -> Animation:
    """The same motion, every frame with the volume of its sources, by their weights.

        V(t) = sum_i w_i(t) V_i,   reached by one step along all normals of the frame, a millimetre or so

    meshes: the captured takes that the animation plays, closed surfaces, m. Frames that already have their volume
    come back as they are.

    Raises ValueError where a take of the path is missing or takes differ in topology.
    Source: von Funck, Theisel and Seidel 2007, SIGGRAPH (volume correction along normals).
    Departure: one step for the whole surface, which is exact, instead of one per bone.
    """
    mesh, origin = animation.mesh, animation.provenance
    takes, number = source_takes(animation, meshes, "synthesis.keep_volume")
    volumes = [volume(np.asarray(take.vertices), np.asarray(mesh.faces)) for take in takes]
    wanted = path_mean(number, np.asarray(origin.source_frame), np.asarray(origin.weight), volumes)
    kept = [
        with_volume(np.asarray(mesh.vertices[f]), np.asarray(mesh.faces), float(wanted[f]))
        for f in range(len(wanted))
    ]
    return Animation(mesh._replace(vertices=np.stack(kept)), origin)
