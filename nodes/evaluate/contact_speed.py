"""How fast feet slide that should stand."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.path_contacts import path_contacts
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation
from reperform.nodes.products.performance import Contacts
from reperform.nodes.synthesis.source_takes import source_takes


@node(over="dataset", memory=1.0)
def contact_speed(
    animation: Animation,
    meshes: Dataset[MeshSequence],
    contacts: Dataset[Contacts] | None = None,
    *,
    height: Annotated[
        float, Param("m", 0.001, 0.3, "over where a foot lies, under which it may rest")
    ] = 0.04,
    speed: Annotated[float, Param("m/s", 0.01, 2.0, "under which a foot rests in the capture")] = 0.25,
) -> Measures:
    """Speed over the ground of the soles that rest, in every frame of a motion, m/s.

    slide: of the centre of the sole; sole: mean over its vertices, which a foot also has that rolls or turns on the
    spot. A foot rests in a frame where it rests in all its sources, as told from the captured meshes, or by true
    contacts (left, right) where these are given. Per frame the faster foot; nan where none rests in it and in the
    frame before.

    Raises ValueError where a take of the path is missing, takes differ in topology, or true contacts are not of
    the feet found.
    Source: definition; footskate: Kovar, Schreiner and Gleicher 2002, SCA.
    """
    origin, mesh = animation.provenance, animation.mesh
    takes, number = source_takes(animation, meshes, "evaluate.contact_speed")
    fps = float(mesh.fps)
    found = foot_contacts([np.asarray(t.vertices) for t in takes], np.asarray(mesh.faces), fps, height, speed)
    rests = found.planted
    if contacts is not None:
        rests = [np.asarray(contacts[name].planted) for name in meshes]
        if found.foot.max() + 1 != rests[0].shape[1]:
            raise ValueError(
                f"evaluate.contact_speed: contacts are of {rests[0].shape[1]} feet, the meshes rest on "
                f"{found.foot.max() + 1}: leave the contacts out"
            )
    planted = path_contacts(number, np.asarray(origin.source_frame), np.asarray(origin.weight), rests)
    both = np.zeros_like(planted)
    both[1:] = planted[1:] & planted[:-1]
    value = np.full((len(planted), 2), np.nan)
    for k in range(planted.shape[1]):
        sole = np.asarray(mesh.vertices)[:, found.foot == k][..., [0, 2]].astype(np.float64)
        step = np.diff(sole, axis=0, prepend=sole[:1]) * fps
        slide = np.linalg.norm(step.mean(axis=1), axis=1)
        moves = np.linalg.norm(step, axis=2).mean(axis=1)
        here = np.where(both[:, k, None], np.stack([slide, moves], axis=1), np.nan)
        value = np.fmax(value, here)
    return Measures(value, np.array(["slide", "sole"]), np.array(["m/s", "m/s"]))
