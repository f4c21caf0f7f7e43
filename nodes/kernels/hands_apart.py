"""The two hands that hold a box, and where they face each other."""

from __future__ import annotations

import numpy as np

# m round a finger tip that belongs to the hand
_HAND = 0.12


def hands_apart(poses: np.ndarray, hand: int) -> tuple[int, int]:
    """The vertices that face each other on two hands, the first on that of vertex `hand`.

    poses: (N, V, 3), m, of inputs at the pose in which they hold boxes of different widths. The other hand is where
    the distance to `hand` varies most over the inputs. Of the vertices within a hand's length of both, those that are
    nearest to each other on average lie on the inner sides; between them fits the box.
    """
    reach = np.linalg.norm(poses - poses[:, hand, None], axis=-1)
    other = int(np.argmax(reach.var(axis=0)))
    near = min(_HAND, 0.4 * float(reach[:, other].min()))
    one = np.flatnonzero(reach.max(axis=0) <= near)
    two = np.flatnonzero(np.linalg.norm(poses - poses[:, other, None], axis=-1).max(axis=0) <= near)
    gap = np.linalg.norm(poses[:, one, None] - poses[:, None, two], axis=-1).mean(axis=0)
    a, b = divmod(int(np.argmin(gap)), len(two))
    return int(one[a]), int(two[b])
