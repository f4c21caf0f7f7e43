"""How well a walk follows a curve and does what was prescribed."""

from __future__ import annotations

import fnmatch
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.stretch_action import read_action
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.pose_walk import PoseWalk


@node(over="dataset")
def curve_walk(
    walk: PoseWalk,
    *,
    actions: Annotated[
        tuple[str, ...], Param(about="what was prescribed, as FROM-TO TAKE, metres along the curve")
    ] = (),
) -> Measures:
    """Distance of a walk from its curve, and the share of prescribed actions that fill their stretches.

        distance = sqrt(mean over frames |body - curve(arc length walked so far)|^2)

    on the ground, m; `nearest` is the same to the nearest point wanted at any time. An action is on its stretch where
    every frame whose arc length lies in it shows (of two blended takes the heavier counts) a take allowed there by
    this or an overlapping action, and at least one shows its own. nan where there is no action.

    Raises ValueError where the walk followed no curve or an action cannot be read.
    Source: 002 section 4 (Boukhayma and Boyer 2015, 3DV), which shows pictures only.
    """
    wanted = np.asarray(walk.wanted)[:, [0, 2]]
    if not np.isfinite(wanted).all():
        raise ValueError("evaluate.curve_walk: the walk followed no curve: wire one of synthesis.along_curve")
    ground = np.asarray(walk.middle)[:, [0, 2]]
    distance = float(np.sqrt(np.square(ground - wanted).sum(axis=1).mean()))
    apart = np.linalg.norm(ground[:, None] - wanted[None], axis=-1).min(axis=1)
    done = _done(walk, ground, actions)
    return Measures(
        np.array([[distance, float(np.sqrt(np.square(apart).mean())), done]]),
        np.array(["distance", "nearest", "actions"]),
        np.array(["m", "m", "1"]),
    )


def _done(walk: PoseWalk, ground: np.ndarray, actions: tuple[str, ...]) -> float:
    """The share of actions on their stretches."""
    if not actions:
        return float("nan")
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ground, axis=0), axis=1))])
    heavier = np.asarray(walk.weight).argmax(axis=1)
    shown = np.asarray(walk.takes)[np.asarray(walk.take)[np.arange(len(heavier)), heavier]]
    read = [read_action(text, "evaluate.curve_walk") for text in actions]
    own = [np.array([fnmatch.fnmatchcase(str(take), name) for take in shown]) for _, _, name in read]
    within = [(arc >= first) & (arc <= last) for first, last, _ in read]
    allowed = np.zeros(len(arc), bool)
    for takes, frames in zip(own, within, strict=True):
        allowed |= takes & frames
    return float(
        np.mean(
            [
                (takes & frames).any() and allowed[frames].all()
                for takes, frames in zip(own, within, strict=True)
            ]
        )
    )
