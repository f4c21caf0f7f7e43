"""From which frames the motion at each frame of a tree of frames is known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def motion_history(
    take: np.ndarray, frame: np.ndarray, parent: np.ndarray, near: int, change: Callable[[int], float]
) -> tuple[np.ndarray, np.ndarray]:
    """Which frame tells, with the parent, how row k moves, and which must be known first: `before`, `after` (n,).

    take, frame, parent: (n,) of a tree of frames, the root its own parent. A frame that follows its parent in time, at
    most `near` frames on, repeats the motion from `before` to the parent: usually the parent's parent. Where that is of
    another take or farther off, as at the root and wherever a take is entered, time runs two ways from the parent: the
    way in which less changes is gone first (`change(k)`: from the parent to k; ties to the lower row), and its first
    frame tells the motion of the other way's. `before` is -1 where nothing tells. `after` is a tree: the parent, or
    that first frame.
    """
    take, frame, parent = (np.asarray(rows, np.int64) for rows in (take, frame, parent))
    step = np.where(take == take[parent], frame - frame[parent], 0)
    step[np.abs(step) > near] = 0
    before = np.where(step * step[parent] > 0, parent[parent], -1)
    after = parent.copy()
    first_steps = np.flatnonzero((step != 0) & (before < 0))
    for up in np.unique(parent[first_steps]):
        rows = first_steps[parent[first_steps] == up]
        on, back = rows[step[rows] > 0], rows[step[rows] < 0]
        if len(on) and len(back):
            calm = min(map(int, rows), key=change)
            other = back if step[calm] > 0 else on
            before[other] = after[other] = calm
    return before, after
