"""The frames that a walk through a motion graph plays: sources, weights and placements on the ground."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.ground_plane import IDENTITY, Placement, compose, rotate_ground


class Passage(NamedTuple):
    """One transition: source frames m - length .. m + length into target frames n - length .. n + length."""

    source: int
    target: int
    m: int
    n: int
    length: int
    # takes coordinates of the target to those of the source
    placement: Placement

    @property
    def departure(self) -> int:
        """Last frame of the source that is played as captured."""
        return self.m - self.length

    @property
    def arrival(self) -> int:
        """First frame of the target that is played as captured."""
        return self.n + self.length


class PathFrames(NamedTuple):
    """Up to two sources per played frame: take, frame, weight, yaw (F, 2) and offset (F, 2, 2)."""

    take: np.ndarray
    frame: np.ndarray
    weight: np.ndarray
    yaw: np.ndarray
    offset: np.ndarray


def ease(length: int) -> np.ndarray:
    """Weight of the target at k = -L .. L: 3 u^2 - 2 u^3 of u = (k + L) / 2 L, flat at both ends."""
    u = np.arange(2 * length + 1) / (2 * length)
    return u * u * (3.0 - 2.0 * u)


def path_frames(take: int, frame: int, passages: Sequence[Passage], end: int) -> PathFrames:
    """Play from `frame` of `take` through all passages to frame `end` of the last take.

    The placement of each target is that of its source after the placement of the transition: they accumulate.
    Raises ValueError where a passage leaves another take or an earlier frame than the one reached.
    """
    rows: list[tuple[int, int, int, int, float, Placement, Placement]] = []
    here = IDENTITY
    for passage in passages:
        if passage.source != take or passage.departure < frame:
            raise ValueError(
                f"path: take {take} was reached at frame {frame}; a transition leaves take {passage.source} "
                f"at frame {passage.departure}"
            )
        there = compose(here, passage.placement)
        rows += [(take, k, take, k, 0.0, here, here) for k in range(frame, passage.departure + 1)]
        weights = ease(passage.length)
        rows += [
            (
                take,
                passage.m + k,
                passage.target,
                passage.n + k,
                float(weights[k + passage.length]),
                here,
                there,
            )
            for k in range(1 - passage.length, passage.length)
        ]
        take, frame, here = passage.target, passage.arrival, there
    if end < frame:
        raise ValueError(
            f"path: frame {end} of take {take} lies before frame {frame}, where the path enters it"
        )
    rows += [(take, k, take, k, 0.0, here, here) for k in range(frame, end + 1)]
    return PathFrames(
        take=np.array([(row[0], row[2]) for row in rows], np.int32),
        frame=np.array([(row[1], row[3]) for row in rows], np.int32),
        weight=np.array([(1.0 - row[4], row[4]) for row in rows], np.float32),
        yaw=np.array([(row[5].yaw, row[6].yaw) for row in rows]),
        offset=np.array([(row[5].offset, row[6].offset) for row in rows]),
    )


def ground_track(frames: PathFrames, tracks: Sequence[np.ndarray]) -> np.ndarray:
    """Where the centroid goes on the ground along a path, (F, 2), from that of each take (frames, 2), m."""
    places = []
    for side in range(2):
        here = np.array(
            [tracks[t][f] for t, f in zip(frames.take[:, side], frames.frame[:, side], strict=True)]
        )
        places.append(_turn(here, frames.yaw[:, side]) + frames.offset[:, side])
    return np.asarray(
        frames.weight[:, :1].astype(np.float64) * places[0]
        + frames.weight[:, 1:].astype(np.float64) * places[1]
    )


def _turn(vectors: np.ndarray, yaw: np.ndarray) -> np.ndarray:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * vectors[:, 0] + s * vectors[:, 1], -s * vectors[:, 0] + c * vectors[:, 1]], axis=1)


def passage_track(passage: Passage, tracks: Sequence[np.ndarray]) -> np.ndarray:
    """The centroid's ground track during one transition, (2 L + 1, 2), in coordinates of the source."""
    window = np.arange(-passage.length, passage.length + 1)
    weight = ease(passage.length)[:, None]
    placed = rotate_ground(tracks[passage.target][passage.n + window], passage.placement.yaw)
    return (1.0 - weight) * tracks[passage.source][passage.m + window] + weight * (
        placed + passage.placement.offset
    )


def arc_length(track: np.ndarray) -> float:
    """Length of a polyline (F, 2), m."""
    return float(np.linalg.norm(np.diff(track, axis=0), axis=1).sum())
