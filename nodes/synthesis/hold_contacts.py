"""Feet that stand still where they stand."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.foot_hold import hold_feet, leg_fields
from reperform.nodes.kernels.path_contacts import path_contacts
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation
from reperform.nodes.synthesis.contact_parameters import Ease, Height, Share, Speed

_WHO = "synthesis.hold_contacts"


@node(over="dataset", memory=1.0)
def hold_contacts(
    animation: Animation,
    meshes: Dataset[MeshSequence],
    *,
    height: Height = 0.04,
    speed: Speed = 0.25,
    share: Share = 1.0,
    ease: Ease = 0.12,
) -> Animation:
    """The same motion with every resting foot at one place for as long as it rests.

    animation: a played path; meshes: the captured takes that it plays, m. Feet and when they rest are told from
    the captured takes; a played frame rests on the feet that its sources rest on. The mean of each sole is held in
    place, the foot moves as one with it and the leg follows, less and less up to the hip; corrections come and go
    with continuous velocity. A motion that never rests on anything comes back unchanged.

    Raises ValueError where a take of the path is missing or takes differ in topology.
    Source: Kovar, Schreiner and Gleicher 2002, SCA (footskate clean-up); contacts of blends from those of their
    sources: Kovar, Gleicher and Pighin 2002, SIGGRAPH, section 3.2.
    Departure: on the surface, without a skeleton.
    """
    mesh, origin = animation.mesh, animation.provenance
    faces = np.asarray(mesh.faces)
    takes = [str(take) for take in np.asarray(origin.takes)]
    for k in np.unique(np.asarray(origin.take)).tolist():
        if takes[k] not in meshes:
            raise ValueError(f"{_WHO}: the motion plays {takes[k]!r}; the meshes have {', '.join(meshes)}")
    for name, take in meshes.items():
        if not np.array_equal(np.asarray(take.faces), faces):
            raise ValueError(
                f"{_WHO}: take {name!r} must have the topology of the motion: wire the same meshes"
            )
    names = list(meshes)
    captured = [np.asarray(meshes[name].vertices) for name in names]
    found = foot_contacts(captured, faces, float(mesh.fps), height, speed)
    if found.foot.max() < 0:
        return animation
    number = np.array([names.index(take) if take in meshes else -1 for take in takes])
    planted = path_contacts(
        number[np.asarray(origin.take)],
        np.asarray(origin.source_frame),
        np.asarray(origin.weight),
        found.planted,
        share,
    )
    fields = leg_fields(captured[0][0], faces, found.foot)
    held = hold_feet(np.asarray(mesh.vertices), found.foot, planted, fields, float(mesh.fps), ease)
    return Animation(mesh._replace(vertices=held), origin)
