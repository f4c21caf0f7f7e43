"""The labelling of a graph that costs least, when neighbours should differ by given amounts."""

from __future__ import annotations

import numpy as np
import scipy.sparse
from numba import njit


def neighbour_lists(adjacency: scipy.sparse.csr_matrix) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Half edges of a graph: first half edge of each vertex (V + 1,), where it leads (E,), and its opposite (E,)."""
    adjacency.sort_indices()
    count = adjacency.shape[0]
    start = adjacency.indptr.astype(np.int64)
    towards = adjacency.indices.astype(np.int64)
    owner = np.repeat(np.arange(count), np.diff(start))
    opposite = np.searchsorted(owner * count + towards, towards * count + owner)
    return start, towards, opposite.astype(np.int64)


def beliefs(
    cost: np.ndarray,
    graph: tuple[np.ndarray, np.ndarray, np.ndarray],
    offset: np.ndarray,
    slope: float,
    cap: float,
    sweeps: int,
) -> np.ndarray:
    """Approximate min-marginals (V, L) of sum_v cost[v, l_v] + sum_edges min(slope |l_v - l_w + offset|, cap).

    cost (V, L) float32, labels 0 .. L - 1; graph: `neighbour_lists`; offset (E,) in labels, per half edge from v to
    w: by how much l_w should exceed l_v (opposite half edges have opposite offsets); slope per label. Sequential
    min-sum belief propagation, alternately up and down the vertices' numbers; the message of a truncated linear
    term takes two passes over the labels.

    Source: Felzenszwalb and Huttenlocher 2006, IJCV 70(1), "Efficient belief propagation for early vision".
    """
    start, towards, opposite = graph
    return np.asarray(
        _propagate(
            np.ascontiguousarray(cost, np.float32),
            start,
            towards,
            opposite,
            np.asarray(offset, np.float32),
            np.float32(slope),
            np.float32(cap),
            sweeps,
        )
    )


@njit(cache=True, nogil=True)
def _propagate(
    cost: np.ndarray,
    start: np.ndarray,
    towards: np.ndarray,
    opposite: np.ndarray,
    offset: np.ndarray,
    slope: np.float32,
    cap: np.float32,
    sweeps: int,
) -> np.ndarray:
    count, labels = cost.shape
    messages = np.zeros((len(towards), labels), np.float32)
    belief = cost.copy()
    rest = np.empty(labels, np.float32)
    for sweep in range(sweeps):
        for step in range(count):
            v = step if sweep % 2 == 0 else count - 1 - step
            for e in range(start[v], start[v + 1]):
                w, back = towards[e], opposite[e]
                for d in range(labels):
                    rest[d] = belief[v, d] - messages[back, d]
                low = rest.min()
                for d in range(1, labels):
                    rest[d] = min(rest[d], rest[d - 1] + slope)
                for d in range(labels - 2, -1, -1):
                    rest[d] = min(rest[d], rest[d + 1] + slope)
                _send(rest, low, offset[e], slope, cap, messages[e], belief[w])
    return belief


@njit(cache=True, nogil=True, inline="always")
def _send(
    rest: np.ndarray,
    low: float,
    offset: float,
    slope: float,
    cap: float,
    message: np.ndarray,
    belief: np.ndarray,
) -> None:
    """Shift a message by a broken number of labels, cap it, and put it in the place of the old one."""
    last = len(rest) - 1
    for g in range(last + 1):
        x = g - offset
        if x <= 0:
            value = rest[0] - slope * x
        elif x >= last:
            value = rest[last] + slope * (x - last)
        else:
            i = int(x)
            value = min(rest[i] + slope * (x - i), rest[i + 1] + slope * (i + 1 - x))
        value = min(value - low, cap)
        belief[g] += value - message[g]
        message[g] = value
