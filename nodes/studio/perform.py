"""A take of the virtual actor."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.skinning import skin_dual_quaternion
from reperform.nodes.products.mesh import MeshSequence, TextureAtlas
from reperform.nodes.products.performance import BoneRotations, Contacts, Performance, SkeletonSequence
from reperform.nodes.studio.actor import build_actor
from reperform.nodes.studio.actor_parts import Costume
from reperform.nodes.studio.actor_skeleton import NAMES, PARENTS, REFERENCE_STATURE, REST_JOINTS
from reperform.nodes.studio.garment import garment_displacement
from reperform.nodes.studio.motions import MARGIN, Motion, plan_motion
from reperform.nodes.studio.pose_plan import Plan, solve

# the plan is sampled at the multiple of the frame rate next above this (Hz)
FINEST = 100.0


@node(over="take", memory=1.0)
def perform(
    *,
    motion: Annotated[Motion, Param("", about="what the actor does")] = "walk",
    costume: Annotated[Costume, Param("", about="what the actor wears")] = "skirt",
    seconds: Annotated[float, Param("s", 0.2, 30.0, "length of the take")] = 1.6,
    fps: Annotated[float, Param("Hz", 5.0, 240.0, "frames per second")] = 25.0,
    walk_speed: Annotated[float, Param("m/s", 0.3, 1.9, "speed of walking")] = 1.3,
    jog_speed: Annotated[float, Param("m/s", 1.9, 3.6, "speed of jogging")] = 2.4,
    turn: Annotated[float, Param("rad/s", 0.0, 2.0, "how fast turn_left and turn_right turn")] = 0.8,
    height: Annotated[
        float,
        Param("m", 0.0, 2.4, "of a jump's rise, a reaching hand or a ducking head; 0: the motion's own"),
    ] = 0.0,
    length: Annotated[float, Param("m", 0.0, 2.5, "of a jump; 0: the motion's own")] = 0.0,
    width: Annotated[
        float, Param("m", 0.0, 2.0, "between the hands of a grab (joints); 0: the motion's own")
    ] = 0.0,
    phase: Annotated[float, Param("cycle", 0.0, 1.0, "where in the gait cycle the take starts")] = 0.0,
    heading: Annotated[float, Param("rad", -7.0, 7.0, "turns the whole take about the vertical")] = 0.0,
    stature: Annotated[float, Param("m", 1.2, 2.1, "height of the actor, without lifting the arms")] = 1.72,
) -> Performance:
    """What the virtual actor really does: a closed textured mesh of one topology, joints and foot contacts.

    The actor walks over the ground y = 0 (metres); the ground it covers is centred on the origin. Returns
    mesh vertices (T, V, 3), T = round(seconds fps), with one topology and one atlas per costume over all
    motions, joints (T, 21, 3), and planted (T, 2): the ball of the (left, right) foot rests on the ground
    and does not move.

    A plan gives speed and turn over time; footsteps are put where the hips pass during each stance; legs
    are solved in closed form to stay on them; the surface follows by dual-quaternion skinning, and the
    loose garment by e'' = -a - 2 z w (e' + d v) - w^2 e behind the body that carries it, pushed out by the
    legs.

    Source: 004 table 2.1 (the inventory of motions); Kavan et al. 2008 (skinning); Boulic et al. 1990, The
    Visual Computer 6 (gait as a function of speed). Departure: procedural, since the seeds' captures are
    not public.
    """
    size = stature / REFERENCE_STATURE
    finer = int(np.ceil(FINEST / fps))
    plan = plan_motion(
        motion, seconds, fps * finer, walk_speed / size, jog_speed / size, turn, phase, height / size, length / size,
        width / size,
    )  # fmt: skip
    frames = round(MARGIN * fps * finer) + finer * np.arange(max(2, round(seconds * fps)))
    plan = _centred(plan, frames, heading)
    rotation, joints = solve(plan)
    translation = joints - np.einsum("tbij,bj->tbi", rotation, REST_JOINTS)
    actor = build_actor(costume)
    vertices = skin_dual_quaternion(actor.vertices, actor.weights, rotation[frames], translation[frames])
    vertices += garment_displacement(actor, rotation, translation, joints, 1 / (fps * finer), frames)
    rate = np.array(fps, np.float32)
    return Performance(
        MeshSequence((vertices * size).astype(np.float32), actor.faces, rate),
        TextureAtlas(actor.uv, actor.faces_uv, actor.image),
        SkeletonSequence((joints[frames] * size).astype(np.float32), PARENTS, np.array(NAMES), rate),
        Contacts(plan.planted[frames]),
        BoneRotations(rotation[frames].astype(np.float32), PARENTS, rate),
    )


def _centred(plan: Plan, frames: np.ndarray, heading: float) -> Plan:
    """The plan moved so that the ground it covers is centred on the origin, then turned about it."""
    track = plan.track[frames]
    middle = 0.5 * (track.min(axis=0) + track.max(axis=0))
    cos, sin = np.cos(heading), np.sin(heading)
    turn = np.array([[cos, -sin], [sin, cos]])
    ball = plan.ball.copy()
    ball[..., [0, 2]] = (ball[..., [0, 2]] - middle) @ turn
    return plan._replace(
        track=(plan.track - middle) @ turn,
        heading=plan.heading + heading,
        ball=ball,
        foot_yaw=plan.foot_yaw + heading,
    )
