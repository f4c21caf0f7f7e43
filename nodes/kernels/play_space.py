"""One parametric space as plain arrays, and what playing it takes: time, travel, contacts, mesh. No allocation."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

# What is so much above the lowest of a sole (m) does not touch the ground.
_TOUCHES = 0.04


class PlaySpace(NamedTuple):
    """Inputs i of poses k that are blended by weights w (N,). A cyclic space has its first pose again at the end."""

    # (N, P + cyclic, 3 V) float32, in the frame of the root, m
    inputs: np.ndarray
    # (N, P, 3): dx, dz (m), dyaw (rad) to the next pose; (N, P) s
    motion: np.ndarray
    seconds: np.ndarray
    # (N, P + cyclic, feet): 1 where the foot is planted
    planted: np.ndarray
    cyclic: bool

    @property
    def poses(self) -> int:
        """Number of poses P."""
        return int(self.motion.shape[1])


@njit(cache=True, nogil=True)
def advance(
    motion: np.ndarray,
    seconds: np.ndarray,
    cyclic: bool,
    weights: np.ndarray,
    pose: float,
    dt: float,
    step: np.ndarray,
) -> float:
    """Play `dt` s on from a pose (in poses); the pose then. step (3,): dx, dz, dyaw in the frame of the root before.

    Pace and travel are blends: seconds(k) = sum_i w_i seconds_ik, motion(k) likewise, so a foot that is planted in
    every input stays where it is. A space that is not cyclic stays at its last pose.

    Source: 001 section 3.2 (a blend of time-warped motions is played at the blended pace).
    """
    step[:] = 0.0
    poses = motion.shape[1]
    while dt > 0.0:
        k = int(pose)
        if k >= poses - 1 and not cyclic:
            return float(poses - 1)
        wait = 0.0
        for i in range(len(weights)):
            wait += weights[i] * seconds[i, k]
        left = (k + 1 - pose) * wait
        share = 0.0
        if dt >= left:
            share = k + 1 - pose
            dt -= left
            pose = float(k + 1)
            if pose >= poses and cyclic:
                pose = 0.0
        else:
            share = dt / wait
            pose += share
            dt = 0.0
        _move(motion, weights, k, share, step)
    return pose


@njit(cache=True, nogil=True)
def _move(motion: np.ndarray, weights: np.ndarray, k: int, share: float, step: np.ndarray) -> None:
    dx, dz, turn = 0.0, 0.0, 0.0
    for i in range(len(weights)):
        dx += weights[i] * motion[i, k, 0]
        dz += weights[i] * motion[i, k, 1]
        turn += weights[i] * motion[i, k, 2]
    c, s = math.cos(step[2]), math.sin(step[2])
    step[0] += share * (c * dx + s * dz)
    step[1] += share * (-s * dx + c * dz)
    step[2] += share * turn


@njit(cache=True, nogil=True)
def seconds_between(
    seconds: np.ndarray, cyclic: bool, weights: np.ndarray, start: float, end: float
) -> float:
    """Seconds from one pose to a later one; in a cyclic space an earlier one is that of the next round."""
    poses = seconds.shape[1]
    if end < start:
        if not cyclic:
            return 0.0
        end += poses
    out = 0.0
    k = int(start)
    while k < end:
        share = min(end, k + 1.0) - max(start, float(k))
        for i in range(len(weights)):
            out += share * weights[i] * seconds[i, k % poses]
        k += 1
    return out


@njit(cache=True, nogil=True)
def pose_into(
    inputs: np.ndarray, weights: np.ndarray, pose: float, mix: float, add: bool, flat: np.ndarray
) -> None:
    """flat (3 V,) (+)= mix times the linear blend of the inputs at a pose between two."""
    before = min(int(pose), inputs.shape[1] - 2)
    part = pose - before
    fresh = not add
    for i in range(len(weights)):
        if weights[i] == 0.0:
            continue
        one, two = np.float32(mix * weights[i] * (1.0 - part)), np.float32(mix * weights[i] * part)
        x, y = inputs[i, before], inputs[i, before + 1]
        if fresh:
            for v in range(len(flat)):
                flat[v] = one * x[v] + two * y[v]
        else:
            for v in range(len(flat)):
                flat[v] += one * x[v] + two * y[v]
        fresh = False


@njit(cache=True, nogil=True)
def planted_share(
    planted: np.ndarray, weights: np.ndarray, pose: float, mix: float, add: bool, out: np.ndarray
) -> None:
    """out (feet,) (+)= mix times the share of what is blended in which each foot rests."""
    before = min(int(pose), planted.shape[1] - 2)
    part = pose - before
    for k in range(len(out)):
        value = 0.0
        for i in range(len(weights)):
            value += weights[i] * ((1.0 - part) * planted[i, before, k] + part * planted[i, before + 1, k])
        out[k] = mix * value + (out[k] if add else 0.0)


@njit(cache=True, nogil=True)
def place_into(
    flat: np.ndarray,
    x: float,
    z: float,
    yaw: float,
    fields: np.ndarray,
    first: np.ndarray,
    last: np.ndarray,
    shift: np.ndarray,
    out: np.ndarray,
) -> None:
    """The mesh in the world, out (V, 3): x_v = R_y(yaw) local_v + (x, 0, z) + sum_k fields_kv shift_k.

    fields (K, V) are nothing outside first .. last (K,).
    """
    c, s = np.float32(math.cos(yaw)), np.float32(math.sin(yaw))
    tx, tz = np.float32(x), np.float32(z)
    for v in range(len(out)):
        a, b = flat[3 * v], flat[3 * v + 2]
        out[v, 0] = c * a + s * b + tx
        out[v, 1] = flat[3 * v + 1]
        out[v, 2] = c * b - s * a + tz
    for k in range(len(fields)):
        dx, dy, dz = np.float32(shift[k, 0]), np.float32(shift[k, 1]), np.float32(shift[k, 2])
        for v in range(first[k], last[k]):
            share = fields[k, v]
            if share > 0.0:
                out[v, 0] += share * dx
                out[v, 1] += share * dy
                out[v, 2] += share * dz


@njit(cache=True, nogil=True)
def soles_of(
    flat: np.ndarray, x: float, z: float, yaw: float, start: np.ndarray, vertex: np.ndarray, point: np.ndarray,
    out: np.ndarray, slid: np.ndarray,
) -> None:  # fmt: skip
    """The middle of each sole in the world, out (K, 3), and how far over the ground it slid where it touches.

    Sole k has vertices vertex[start[k] : start[k + 1]]; point (n, 3), all of them in the world, is where they were, and
    is overwritten with where they are. slid (K, 2): x, z, the mean motion of what touches the ground before and after,

        slid = sum_v a_v(t - 1) a_v(t) (x_v(t) - x_v(t - 1)) / sum_v a_v(t - 1) a_v(t),   a_v = max(0, 1 - (y_v - min y) / h)

    with h = 0.04 m, so that a foot may roll from heel to ball while it is held.
    """
    c, s = math.cos(yaw), math.sin(yaw)
    for k in range(len(start) - 1):
        first, last = start[k], start[k + 1]
        before, now = math.inf, math.inf
        for n in range(first, last):
            before, now = min(before, point[n, 1]), min(now, flat[3 * vertex[n] + 1])
        out[k] = 0.0
        slid[k] = 0.0
        touches = 0.0
        for n in range(first, last):
            a, y, b = flat[3 * vertex[n]], flat[3 * vertex[n] + 1], flat[3 * vertex[n] + 2]
            px, pz = c * a + s * b + x, c * b - s * a + z
            share = max(0.0, 1.0 - (point[n, 1] - before) / _TOUCHES) * max(0.0, 1.0 - (y - now) / _TOUCHES)
            touches += share
            slid[k, 0] += share * (px - point[n, 0])
            slid[k, 1] += share * (pz - point[n, 2])
            point[n, 0], point[n, 1], point[n, 2] = px, y, pz
            out[k, 0] += px
            out[k, 1] += y
            out[k, 2] += pz
        out[k] /= max(last - first, 1)
        if touches > 0.0:
            slid[k] /= touches
