"""Feet of a skeleton that stand still where they stand."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.bone_mesh import bone_faces
from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.foot_hold import hold_points
from reperform.nodes.kernels.leg_reach import leg_of, needed_drop, reach
from reperform.nodes.kernels.path_contacts import path_contacts
from reperform.nodes.product import Dataset
from reperform.nodes.products.mocap import Mocap, SkeletalAnimation
from reperform.nodes.synthesis.animate_skeleton import skeletal_animation
from reperform.nodes.synthesis.contact_parameters import Ease, Height, Share, Speed

_WHO = "synthesis.hold_skeleton"


@node(over="dataset")
def hold_skeleton(
    animation: SkeletalAnimation,
    mocap: Dataset[Mocap],
    *,
    height: Height = 0.04,
    speed: Speed = 0.25,
    share: Share = 1.0,
    ease: Ease = 0.12,
) -> SkeletalAnimation:
    """The same motion with every resting foot at one place for as long as it rests; bones keep their lengths.

    mocap: the takes that the animation plays; feet and when they rest are told from them. The smoothest shift that
    holds each foot moves it as a whole; hip and knee follow in closed form, and the root comes down where a leg
    would be too short.

    Raises ValueError where a take of the path is missing.
    Source: Kovar, Schreiner and Gleicher 2002, SCA (footskate clean-up).
    Departure: resting places and easing come from one quadratic problem; the root is lowered, not the leg stretched.
    """
    moving, origin = animation.mocap, animation.provenance
    skeleton = moving.skeleton
    takes = [str(take) for take in np.asarray(origin.takes)]
    for k in np.unique(np.asarray(origin.take)).tolist():
        if takes[k] not in mocap:
            raise ValueError(
                f"{_WHO}: the motion plays {takes[k]!r}; the motion capture has {', '.join(mocap)}"
            )
    parents, offset = np.asarray(skeleton.parents), np.asarray(moving.offset, np.float64)
    played = [np.asarray(mocap[take].skeleton.joints) for take in takes if take in mocap]
    rate = float(skeleton.fps)
    found = foot_contacts(played, bone_faces(parents), rate, height, speed)
    if found.foot.max() < 0:
        return animation
    number = np.cumsum([take in mocap for take in takes]) - 1
    planted = path_contacts(
        number[np.asarray(origin.take)], np.asarray(origin.source_frame), np.asarray(origin.weight), found.planted, share
    )  # fmt: skip
    joints, turn = np.asarray(skeleton.joints, np.float64), np.asarray(moving.rotation, np.float64).copy()
    tall = float(np.median(np.ptp(joints[..., 1], axis=1)))
    legs, wanted, shifts = [], [], []
    for k in range(planted.shape[1]):
        sole = np.flatnonzero(found.foot == k)
        leg = leg_of(int(sole[0]), parents, offset, tall)
        legs.append(leg)
        shifts.append(hold_points(joints[:, sole].mean(axis=1), planted[:, k], rate, ease))
        wanted.append(joints[:, leg.ankle] + shifts[-1])
    # the body goes along with its feet, so that knees have less to make up for
    moved = joints + np.mean(shifts, axis=0)[:, None]
    drops = [needed_drop(moved, leg, w, rate) for leg, w in zip(legs, wanted, strict=True)]
    moved[..., 1] -= np.max(drops, axis=0)[:, None]
    for leg, w in zip(legs, wanted, strict=True):
        reach(moved, turn, leg, w)
    return skeletal_animation(skeleton, offset, moved[:, 0], turn, animation)
