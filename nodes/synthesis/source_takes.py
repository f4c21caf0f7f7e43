"""The captured takes that an animation plays."""

from __future__ import annotations

import numpy as np

from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation


def source_takes(
    animation: Animation, meshes: Dataset[MeshSequence], who: str
) -> tuple[list[MeshSequence], np.ndarray]:
    """All takes of `meshes`, and for each played frame the numbers of its sources among them, (F, 2).

    Raises ValueError where a take that is played is missing or takes differ from the motion in topology.
    """
    origin, faces = animation.provenance, np.asarray(animation.mesh.faces)
    names = list(meshes)
    played = [str(take) for take in np.asarray(origin.takes)]
    for k in np.unique(np.asarray(origin.take)).tolist():
        if played[k] not in meshes:
            raise ValueError(f"{who}: the motion plays {played[k]!r}; the meshes have {', '.join(names)}")
    for name, take in meshes.items():
        if not np.array_equal(np.asarray(take.faces), faces):
            raise ValueError(
                f"{who}: take {name!r} must have the topology of the motion: wire the same meshes"
            )
    number = np.array([names.index(take) if take in meshes else -1 for take in played])
    return list(meshes.values()), number[np.asarray(origin.take)]
