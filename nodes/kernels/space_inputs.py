"""Takes brought into step: poses of one phase, told from their travel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.contact_keys import common_keys, contact_events
from reperform.nodes.kernels.ground_plane_distance import ground_plane_distance
from reperform.nodes.kernels.motion_cycle import close_loop, find_cycle
from reperform.nodes.kernels.resample_time import at_times
from reperform.nodes.kernels.root_frame import root_steps, to_root
from reperform.nodes.kernels.time_warp import continuous_warp, shortest_warp

# vertices on which poses are compared
_SAMPLE = 400
# moments of a cycle at which takes are compared to find where they are in phase
_PHASES = 12


class SpaceInputs(NamedTuple):
    """Inputs of a space, pose k of each at the same moment of the motion."""

    vertices: np.ndarray
    motion: np.ndarray
    seconds: np.ndarray
    planted: np.ndarray
    source_frame: np.ndarray


class _Piece(NamedTuple):
    """The part of a take that is used."""

    points: np.ndarray
    start: float
    # in frames; cyclic: the cycle, else from the first to the last frame
    length: float
    events: list[tuple[float, str]]
    # whether it starts at a given moment: a foot coming down or the first key
    marked: bool


def bring_into_step(
    names: tuple[str, ...],
    takes: list[np.ndarray],
    planted: list[np.ndarray] | None,
    reference: np.ndarray,
    fps: float,
    cyclic: bool,
    poses: int,
    keys: np.ndarray | None,
    who: str,
) -> SpaceInputs:
    """Poses (input, pose, V, 3) in the root's frame and what goes with them, all takes in step.

    takes: (T, V, 3) each, m; planted: (T, 2) each; reference: the pose (V, 3) that faces +z; keys: (takes, K) s. Cycles
    begin at the first key, else where the left foot comes down, else in phase with the first take.
    Raises ValueError where a take does not repeat itself, or key frames lie outside the part that is used.
    """
    local = [to_root(take, reference) for take in takes]
    pieces: list[_Piece] = []
    for row, (name, (points, _, _)) in enumerate(zip(names, local, strict=True)):
        events = [] if planted is None else contact_events(planted[row])
        starts = [t for t, what in events if what == "left down"] if keys is None else [keys[row, 0] * fps]
        sample = points[:, :: max(1, points.shape[1] // _SAMPLE)]
        if cyclic:
            pieces.append(_cycle(name, sample, events, np.array(starts), fps, pieces[:1], who))
        else:
            pieces.append(_Piece(sample, 0.0, len(points) - 1.0, events, True))
    times = _times_in_step(pieces, names, fps, cyclic, poses, keys, who)
    rows = [_resampled(*local[i], times[i], cyclic) for i in range(len(takes))]
    vertices, motion = (np.stack(column) for column in zip(*rows, strict=True))
    count = vertices.shape[1]
    seconds = np.diff(times, axis=1) / fps
    seconds = seconds if cyclic else np.concatenate([seconds, np.zeros((len(takes), 1))], axis=1)
    shown = times[:, :count]
    nearest = [
        np.clip(np.round(row).astype(int), 0, len(take) - 1) for row, take in zip(shown, takes, strict=True)
    ]
    held = (
        np.zeros((len(takes), count, 2), bool)
        if planted is None
        else np.stack([feet[row] for feet, row in zip(planted, nearest, strict=True)])
    )
    return SpaceInputs(vertices.astype(np.float32), motion, seconds, held, shown)


def _cycle(
    name: str, sample: np.ndarray, events: list[tuple[float, str]], starts: np.ndarray, fps: float, like: list[_Piece],
    who: str,
) -> _Piece:  # fmt: skip
    """One cycle of a take: from a start, else in phase with the first take (`like`)."""
    distance = ground_plane_distance(sample, sample, sample, sample, 0.0, "none")
    cycle = find_cycle(distance, fps, starts)
    if cycle is None:
        raise ValueError(
            f"{who}: take {name} must repeat itself within its {len(sample) / fps:.2f} s to be cyclic, and does not: "
            "use a longer take, or cyclic: false"
        )
    start, length = cycle
    marked = bool((starts == start).any())
    if like and not (marked and like[0].marked):
        start = _in_phase(like[0], sample, length)
    inside = [(t - start, what) for t, what in events if 0.25 <= t - start <= length - 0.25]
    return _Piece(sample, start, length, inside, marked)


def _in_phase(like: _Piece, sample: np.ndarray, length: float) -> float:
    """The frame at which a cycle must begin to be most like another, phase by phase."""
    share = np.arange(_PHASES) / _PHASES
    wanted = at_times(like.points, like.start + like.length * share)
    distance = ground_plane_distance(wanted, sample, wanted, sample, 0.0, "none")
    starts = np.arange(int(len(sample) - 1 - length) + 1)
    shown = np.round(starts[:, None] + length * share).astype(int)
    return float(starts[int(np.argmin(distance[np.arange(_PHASES), shown].mean(axis=1)))])


def _times_in_step(
    pieces: list[_Piece],
    names: tuple[str, ...],
    fps: float,
    cyclic: bool,
    poses: int,
    keys: np.ndarray | None,
    who: str,
) -> np.ndarray:
    """The moment (frames) of each take that each pose shows: (takes, poses), with one more pose if cyclic."""
    counts = [max(2, round(piece.length)) for piece in pieces]
    grids = [
        np.linspace(piece.start, piece.start + piece.length, n + 1)
        for piece, n in zip(pieces, counts, strict=True)
    ]
    cells = _key_cells(pieces, counts, names, fps, keys, who)
    sampled = [at_times(piece.points, grid) for piece, grid in zip(pieces, grids, strict=True)]
    speeds = [np.gradient(points, axis=0) for points in sampled]
    # share of its piece that each take has gone through at every sample of the first
    shares = [np.linspace(0.0, 1.0, counts[0] + 1)]
    for k in range(1, len(pieces)):
        distance = ground_plane_distance(sampled[0], sampled[k], speeds[0], speeds[k], 1.0, "none")
        pairs = np.column_stack([cells[0], cells[k]])
        path, _ = shortest_warp(distance, pairs)
        shares.append(continuous_warp(path, pairs) / counts[k])
    common = np.mean(shares, axis=0)
    count = poses or max(counts) + (not cyclic)
    phase = np.linspace(0.0, 1.0, count + 1 if cyclic else count)
    along = np.interp(phase, common, np.linspace(0.0, 1.0, counts[0] + 1))
    return np.stack(
        [
            piece.start + piece.length * np.interp(along, np.linspace(0.0, 1.0, counts[0] + 1), share)
            for piece, share in zip(pieces, shares, strict=True)
        ]
    )


def _key_cells(
    pieces: list[_Piece],
    counts: list[int],
    names: tuple[str, ...],
    fps: float,
    keys: np.ndarray | None,
    who: str,
) -> np.ndarray:
    """Samples (takes, K) of the pieces that must coincide."""
    if keys is None:
        moments = common_keys([piece.events for piece in pieces])
    else:
        moments = keys * fps - np.array([[piece.start] for piece in pieces])
    cells = np.stack(
        [np.round(row * n / piece.length) for row, n, piece in zip(moments, counts, pieces, strict=True)]
    ).astype(int)
    for name, row, n, piece in zip(names, cells, counts, pieces, strict=True):
        if len(row) and (row.min() < 0 or row.max() > n):
            begin, end = piece.start / fps, (piece.start + piece.length) / fps
            raise ValueError(
                f"{who}: key frames of {name} must lie in the part that is used, {begin:.2f} .. {end:.2f} s, got "
                f"{', '.join(f'{moment / fps + begin:.2f}' for moment in moments[names.index(name)])} s"
            )
    return cells


def _resampled(
    points: np.ndarray, track: np.ndarray, yaw: np.ndarray, times: np.ndarray, cyclic: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Poses in the root's frame and the root's steps at some moments of a take."""
    steps = root_steps(at_times(track, times), at_times(yaw, times))
    if cyclic:
        return close_loop(at_times(points, times)), steps
    return at_times(points, times), np.concatenate([steps, np.zeros((1, 3))])
