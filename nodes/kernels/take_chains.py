"""A spanning tree that runs through every take in time."""

from __future__ import annotations

import numpy as np


def chain_takes(
    take: np.ndarray, frame: np.ndarray, parent: np.ndarray, distance: np.ndarray, root: int
) -> tuple[np.ndarray, np.ndarray]:
    """Parents (n,) and an order of visit (n,) from `root`, with few steps between takes.

    take, frame: (n,) of each row; parent, distance: (n,) a spanning tree over the rows and the lengths of its
    edges. Within a take each frame hangs from the one before or after it, outwards from where the take is
    entered; takes are joined, nearest first, by the shortest edges of the tree between two takes. Ties go to
    the lower row.
    """
    row = {(int(t), int(f)): k for k, (t, f) in enumerate(zip(take, frame, strict=True))}
    shortest: dict[tuple[int, int], tuple[float, int, int]] = {}
    for k, up in enumerate(map(int, parent)):
        if take[up] != take[k]:
            pair = (int(min(take[up], take[k])), int(max(take[up], take[k])))
            shortest[pair] = min(shortest.get(pair, (np.inf, 0, 0)), (float(distance[k]), k, up))
    chained = np.full(len(parent), -1, np.int32)
    order: list[int] = []

    def enter(k: int, origin: int) -> None:
        chained[k] = origin
        order.append(k)
        for step in (1, -1):
            here = k
            while (ahead := (int(take[here]), int(frame[here]) + step)) in row:
                chained[row[ahead]] = here
                here = row[ahead]
                order.append(here)

    enter(root, root)
    while True:
        open_edges = [edge for edge in shortest.values() if (chained[edge[1]] < 0) != (chained[edge[2]] < 0)]
        if not open_edges:
            return chained, np.array(order, np.int32)
        _, k, up = min(open_edges)
        enter(k, up) if chained[k] < 0 else enter(up, k)
