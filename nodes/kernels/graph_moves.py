"""How one gets on in an essential graph: play the next captured frame, or blend into another one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.gradual_placement import gradual_placement
from reperform.nodes.kernels.smooth_warp import smooth_warp


class Moves(NamedTuple):
    """Moves between captured frames, all takes' frames counted through, sorted by the frame they leave.

    Move e has points first[e] .. first[e + 1]: the frames played, the one it leaves and the one it reaches
    included. Placements and positions are in the coordinates of the take it leaves.
    """

    leaving: np.ndarray  # (N + 1,) moves leaving[i] .. leaving[i + 1] leave frame i
    source: np.ndarray  # (E,)
    target: np.ndarray  # (E,)
    steps: np.ndarray  # (E,) frames played after the source, up to the target
    cost: np.ndarray  # (E,)
    first: np.ndarray  # (E + 1,)
    time: np.ndarray  # (P, 2) frames within their takes, of source and target side
    take: np.ndarray  # (P, 2)
    weight: np.ndarray  # (P,) of the target side
    yaw: np.ndarray  # (P, 2) rad
    offset: np.ndarray  # (P, 2, 2) m
    middle: np.ndarray  # (P, 3) centre of the body, m


def smooth_weight(count: int) -> np.ndarray:
    """Weights 3 u^2 - 2 u^3 at `count` even steps of u from 0 to 1."""
    u = np.linspace(0.0, 1.0, count)
    return u * u * (3.0 - 2.0 * u)


def graph_moves(
    takes: Sequence[np.ndarray],
    edges: Sequence[tuple[int, int, float, np.ndarray]],
    frame_cost: float,
) -> Moves:
    """All moves of a graph: from every frame to the next of its take, and the blended transitions.

    takes: (T, P, 3) points of every frame of each take, m; edges: transitions (source, target, cost, path), frames
    counted through all takes, path (K, 2) their warp; frame_cost: cost of playing on by one frame.
    """
    begin = np.concatenate([[0], np.cumsum([len(take) for take in takes])])
    rows = [
        _next(takes, begin, k, f, frame_cost) for k, take in enumerate(takes) for f in range(len(take) - 1)
    ]
    rows += [_blend(takes, begin, *edge) for edge in edges]
    rows.sort(key=lambda row: (row[0], row[1]))
    first = np.concatenate([[0], np.cumsum([len(row[4]) for row in rows])]).astype(np.int64)
    source = np.array([row[0] for row in rows], np.int64)
    columns = [np.concatenate([row[k] for row in rows]) for k in range(3, 9)]
    return Moves(
        np.searchsorted(source, np.arange(begin[-1] + 1)),
        source,
        np.array([row[1] for row in rows], np.int64),
        np.diff(first) - 1,
        np.array([row[2] for row in rows]),
        first,
        *columns,
    )


_Row = tuple[int, int, float, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def _next(takes: Sequence[np.ndarray], begin: np.ndarray, take: int, frame: int, cost: float) -> _Row:
    time = np.array([[frame, frame], [frame + 1, frame + 1]], np.float64)
    middle = takes[take][frame : frame + 2].mean(axis=1, dtype=np.float64)
    here = int(begin[take]) + frame
    return (
        here, here + 1, cost, time, np.full((2, 2), take), np.zeros(2), np.zeros((2, 2)), np.zeros((2, 2, 2)), middle,
    )  # fmt: skip


def _blend(
    takes: Sequence[np.ndarray], begin: np.ndarray, source: int, target: int, cost: float, path: np.ndarray
) -> _Row:
    one, other = (int(np.searchsorted(begin, frame, "right")) - 1 for frame in (source, target))
    time = smooth_warp(path - [begin[one], begin[other]])
    a, b = pose_at(takes[one], time[:, 0]), pose_at(takes[other], time[:, 1])
    weight = smooth_weight(len(time))
    yaw, offset = gradual_placement(a, b, weight)
    middle = (1.0 - weight)[:, None] * _placed(a, yaw[:, 0], offset[:, 0]) + weight[:, None] * _placed(
        b, yaw[:, 1], offset[:, 1]
    )
    return source, target, cost, time, np.tile([one, other], (len(time), 1)), weight, yaw, offset, middle


def pose_at(frames: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Poses (K, P, 3) at times (K,), frames, linear between neighbouring frames; exact at whole ones."""
    before = np.clip(np.floor(time).astype(int), 0, len(frames) - 1)
    after = np.minimum(before + 1, len(frames) - 1)
    part = (time - before)[:, None, None]
    return (1.0 - part) * frames[before] + part * frames[after]


def _placed(points: np.ndarray, yaw: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """Means (K, 3) of poses (K, P, 3), placed."""
    mean = points.mean(axis=1)
    c, s = np.cos(yaw), np.sin(yaw)
    x, z = mean[:, 0], mean[:, 2]
    return np.column_stack([c * x + s * z + offset[:, 0], mean[:, 1], -s * x + c * z + offset[:, 1]])


class PlayedFrames(NamedTuple):
    """Frames of a walk: both sources' takes (F, 2), times (F, 2), weights, placements; and the body's centre (F, 3)."""

    take: np.ndarray
    time: np.ndarray
    weight: np.ndarray
    yaw: np.ndarray
    offset: np.ndarray
    middle: np.ndarray


def play_moves(
    moves: Moves, chain: Sequence[int], yaw: float = 0.0, offset: tuple[float, float] = (0.0, 0.0)
) -> PlayedFrames:
    """The frames of moves played one after the other, each from where the one before ended.

    yaw, offset: placement of the first move's take on the ground.
    Raises ValueError where the chain is empty or a move does not leave where the one before arrived.
    """
    if len(chain) == 0:
        raise ValueError("walk: at least one move is needed to play")
    parts: list[tuple[np.ndarray, ...]] = []
    here, at = yaw, np.asarray(offset, np.float64)
    for position, e in enumerate(chain):
        if position and moves.source[e] != moves.target[chain[position - 1]]:
            raise ValueError(
                f"walk: move {position} leaves frame {moves.source[e]}, not where the one before arrived"
            )
        rows = slice(int(moves.first[e]) + (position > 0), int(moves.first[e + 1]))
        c, s = np.cos(here), np.sin(here)
        x, z = moves.offset[rows, :, 0], moves.offset[rows, :, 1]
        placed = np.stack([c * x + s * z, -s * x + c * z], axis=-1) + at
        x, y, z = moves.middle[rows].T
        middle = np.column_stack([c * x + s * z + at[0], y, -s * x + c * z + at[1]])
        parts.append(
            (moves.take[rows], moves.time[rows], moves.weight[rows], here + moves.yaw[rows], placed, middle)
        )
        here, at = parts[-1][3][-1, 1], placed[-1, 1]
    take, time, weight, yaws, offsets, middle = (
        np.concatenate([part[k] for part in parts]) for k in range(6)
    )
    return PlayedFrames(take, time, np.column_stack([1.0 - weight, weight]), yaws, offsets, middle)
