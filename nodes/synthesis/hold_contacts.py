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
from reperform.nodes.synthesis.source_takes import source_takes


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
    faces, fps = np.asarray(mesh.faces), float(mesh.fps)
    takes, number = source_takes(animation, meshes, "synthesis.hold_contacts")
    captured = [np.asarray(take.vertices) for take in takes]
    found = foot_contacts(captured, faces, fps, height, speed)
    if found.foot.max() < 0:
        return animation
    planted = path_contacts(
        number, np.asarray(origin.source_frame), np.asarray(origin.weight), found.planted, share
    )
    fields = leg_fields(captured[0][0], faces, found.foot)
    held = hold_feet(np.asarray(mesh.vertices), found.foot, planted, fields, fps, ease)
    return Animation(mesh._replace(vertices=held), origin)
