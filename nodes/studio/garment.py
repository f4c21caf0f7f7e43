"""The actor's skirt (or the tails of the jacket) in motion: lattice, springs, legs that push it out."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from reperform.nodes.kernels.cloth_lag import lag, push_out
from reperform.nodes.kernels.implicit_body import Part, part_frame
from reperform.nodes.kernels.skinning import skin_dual_quaternion
from reperform.nodes.studio.actor import Actor, part_weights
from reperform.nodes.studio.actor_skeleton import BONE

COLUMNS, ROWS = 24, 7
FREQUENCY, DAMPING, DRAG = 1.7, 0.28, 0.16
_LEG_RADII = np.array([[0.100, 0.074], [0.072, 0.056]])


def garment_displacement(
    actor: Actor,
    rotation: np.ndarray,
    translation: np.ndarray,
    joints: np.ndarray,
    step: float,
    frames: np.ndarray,
) -> np.ndarray:
    """Displacement (T, V, 3) of every vertex at samples `frames`, from motion sampled every `step` seconds.

    rotation (N, B, 3, 3) and translation (N, B, 3): bones rest -> posed; joints (N, B, 3).
    """
    skirt = actor.skirt
    lattice, looseness = _lattice(skirt)
    carried = skin_dual_quaternion(lattice, part_weights(lattice, skirt), rotation, translation).astype(float)
    moved = carried + lag(carried, looseness, step, FREQUENCY, DAMPING, DRAG)
    centre = joints[:, BONE["hips"]]
    starts = joints[:, [BONE[s + b] for s in ("left_", "right_") for b in ("thigh", "shin")]]
    ends = joints[:, [BONE[s + b] for s in ("left_", "right_") for b in ("shin", "foot")]]
    pushed = push_out(moved, centre, starts, ends, np.tile(_LEG_RADII, (2, 1))) - moved
    # cloth spreads a push over its neighbours and over time
    pushed = pushed.reshape(len(pushed), ROWS, COLUMNS, 3)
    pushed = gaussian_filter1d(np.maximum(gaussian_filter1d(pushed, 0.8, axis=2, mode="wrap"), 0) + np.minimum(
        gaussian_filter1d(pushed, 0.8, axis=2, mode="wrap"), 0), 0.02 / step, axis=0)  # fmt: skip
    shift = (moved - carried).reshape(pushed.shape) + pushed * looseness.reshape(ROWS, COLUMNS, 1) ** 0.5
    return _spread(actor, shift[frames])


def _lattice(skirt: Part) -> tuple[np.ndarray, np.ndarray]:
    """Points (ROWS * COLUMNS, 3) on the garment in the rest pose, and how loose each is."""
    t = np.repeat(np.linspace(0, 1, ROWS), COLUMNS)
    angle = np.tile(2 * np.pi * np.arange(COLUMNS) / COLUMNS, ROWS)
    u = np.interp(t, skirt.stations, skirt.half_u) * np.sin(angle)
    w = np.interp(t, skirt.stations, skirt.half_w) * np.cos(angle)
    axis = np.subtract(skirt.end, skirt.start)
    points = np.array(skirt.start) + np.column_stack([u, np.zeros_like(u), w]) @ part_frame(skirt)
    return points + t[:, None] * axis, np.interp(t, skirt.stations, skirt.looseness)


def _spread(actor: Actor, shift: np.ndarray) -> np.ndarray:
    """Bilinear interpolation of lattice displacements (T, ROWS, COLUMNS, 3) at the garment's vertices."""
    moved = np.zeros((len(shift), len(actor.vertices), 3), np.float32)
    rows = np.flatnonzero(~np.isnan(actor.garment[:, 0]))
    row = actor.garment[rows, 0] * (ROWS - 1)
    column = actor.garment[rows, 1] * COLUMNS
    r0 = np.minimum(row.astype(int), ROWS - 2)
    c0 = column.astype(int) % COLUMNS
    fr, fc = (row - r0)[:, None], (column - np.floor(column))[:, None]
    c1 = (c0 + 1) % COLUMNS
    moved[:, rows] = (1 - fr) * ((1 - fc) * shift[:, r0, c0] + fc * shift[:, r0, c1]) + fr * (
        (1 - fc) * shift[:, r0 + 1, c0] + fc * shift[:, r0 + 1, c1]
    )
    return moved
