"""Optimal transport between two weighted point sets: the earth mover's distance, exactly."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def earth_movers(supply: np.ndarray, demand: np.ndarray, cost: np.ndarray, above: float = np.inf) -> float:
    """The least cost of moving `supply` (N,) onto `demand` (M,), both > 0 and of one sum, at cost (N, M) per
    unit; inf as soon as it is proved to be more than `above`.

        EMD = min over flows f >= 0 with sum_j f_ij = supply_i, sum_i f_ij = demand_j of sum_ij f_ij cost_ij

    Transportation simplex on a spanning tree: starts from a flow in which row after row goes to the cheapest
    columns still open; the most negative reduced cost of a row enters, row after row.
    That a value is passed is proved by weak duality, EMD >= sum_j demand_j v_j + sum_i supply_i min_j (cost_ij - v_j).

    Source: Rubner, Tomasi and Guibas 2000, IJCV 40; Dantzig 1951; Cunningham 1976, Mathematical Programming 11
    (leaving arc).
    """
    return _optimum(supply, demand, cost, above)[0]


@njit(cache=True, nogil=True)
def row_potentials(supply: np.ndarray, demand: np.ndarray, cost: np.ndarray) -> np.ndarray:
    """Potentials (N,) of the rows of a least-cost flow: u_i + v_j <= cost_ij for some v, equal where it flows."""
    return _optimum(supply, demand, cost, np.inf)[1][: len(supply)]


@njit(cache=True, nogil=True)
def _optimum(
    supply: np.ndarray, demand: np.ndarray, cost: np.ndarray, above: float
) -> tuple[float, np.ndarray]:
    """The least cost, or inf, and the potentials of all rows and columns."""
    rows, columns = cost.shape
    parent, flow = _rooted(*_row_minimum(supply, demand, cost), rows)
    nodes = rows + columns
    child, following, before = _children(parent)
    potential, depth = np.zeros(nodes), np.zeros(nodes, np.int32)
    stack = np.empty(nodes, np.int32)
    _reset(0, parent, child, following, potential, depth, cost, stack)
    tolerance = 1e-12 * max(1.0, float(np.abs(cost).max()))
    quiet, row = 0, 0
    for _ in range(400 * nodes):
        best, column = np.inf, 0
        u = potential[row]
        for j in range(columns):
            reduced = cost[row, j] - potential[rows + j]
            if reduced < best:
                best, column = reduced, j
        best -= u
        if best < -tolerance:
            quiet = 0
            _pivot(
                row,
                rows + column,
                rows,
                parent,
                flow,
                child,
                following,
                before,
                potential,
                depth,
                cost,
                stack,
            )
        else:
            quiet += 1
            if quiet == rows:
                break
        row += 1
        if row == rows:
            row = 0
            if above < np.inf and _bound(supply, demand, cost, potential) > above:
                return np.inf, potential
    total = 0.0
    for node in range(1, nodes):
        a, b = node, parent[node]
        total += flow[node] * (cost[a, b - rows] if a < rows else cost[b, a - rows])
    return (total if total <= above else np.inf), potential


@njit(cache=True, nogil=True)
def _bound(supply: np.ndarray, demand: np.ndarray, cost: np.ndarray, potential: np.ndarray) -> float:
    """A lower bound of the distance from the columns' potentials alone."""
    rows, columns = cost.shape
    total = 0.0
    for j in range(columns):
        total += demand[j] * potential[rows + j]
    for i in range(rows):
        least = np.inf
        for j in range(columns):
            least = min(least, cost[i, j] - potential[rows + j])
        total += supply[i] * least
    return total


@njit(cache=True, nogil=True)
def _row_minimum(
    supply: np.ndarray, demand: np.ndarray, cost: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A flow in which row after row goes to the cheapest columns still open, as the arcs (row, column, flow) of a
    spanning tree.
    """
    rows, columns = cost.shape
    arcs = rows + columns - 1
    row, column, flow = np.empty(arcs, np.int32), np.empty(arcs, np.int32), np.empty(arcs)
    wanted = demand.copy()
    # columns still open, the first `size` entries
    open_columns = np.arange(columns)
    size, found = columns, 0
    for i in range(rows):
        left = supply[i]
        while True:
            best, at = np.inf, 0
            for n in range(size):
                if cost[i, open_columns[n]] < best:
                    best, at = cost[i, open_columns[n]], n
            j = open_columns[at]
            moved = min(left, wanted[j])
            row[found], column[found], flow[found] = i, j, moved
            found += 1
            # the last row takes all that is left, the last column is never closed before it, whatever rounding says
            if i == rows - 1 or (size > 1 and wanted[j] < left):
                left = max(left - moved, 0.0)
                size -= 1
                open_columns[at] = open_columns[size]
                if size == 0:
                    break
            else:
                wanted[j] = max(wanted[j] - moved, 0.0)
                break
    return row, column, flow


@njit(cache=True, nogil=True)
def _rooted(
    row: np.ndarray, column: np.ndarray, along: np.ndarray, rows: int
) -> tuple[np.ndarray, np.ndarray]:
    """The tree of these arcs hung from row 0: parent of every node, flow to the parent."""
    nodes = len(row) + 1
    count = np.zeros(nodes + 1, np.int32)
    for e in range(len(row)):
        count[row[e] + 1] += 1
        count[rows + column[e] + 1] += 1
    start = np.cumsum(count)
    ends = start[:-1].copy()
    arc = np.empty(2 * len(row), np.int32)
    for e in range(len(row)):
        for side in range(2):
            node = rows + column[e] if side else np.int64(row[e])
            arc[ends[node]] = e
            ends[node] += 1
    parent, flow = np.full(nodes, -1, np.int32), np.zeros(nodes)
    queue = np.empty(nodes, np.int32)
    queue[0], tail = 0, 1
    for head in range(nodes):
        node = queue[head]
        for n in range(start[node], start[node + 1]):
            e = arc[n]
            other = rows + column[e] if node < rows else row[e]
            if other != parent[node]:
                parent[other], flow[other] = node, along[e]
                queue[tail] = other
                tail += 1
    return parent, flow


@njit(cache=True, nogil=True)
def _children(parent: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """First child, next and previous sibling of every node; -1 for none."""
    child = np.full(len(parent), -1, np.int32)
    following, before = child.copy(), child.copy()
    for node in range(len(parent)):
        if parent[node] >= 0:
            _hang(node, parent[node], child, following, before)
    return child, following, before


@njit(cache=True, nogil=True, inline="always")
def _hang(node: int, under: int, child: np.ndarray, following: np.ndarray, before: np.ndarray) -> None:
    first = child[under]
    following[node], before[node], child[under] = first, -1, node
    if first >= 0:
        before[first] = node


@njit(cache=True, nogil=True, inline="always")
def _unhang(node: int, under: int, child: np.ndarray, following: np.ndarray, before: np.ndarray) -> None:
    a, b = before[node], following[node]
    if a >= 0:
        following[a] = b
    else:
        child[under] = b
    if b >= 0:
        before[b] = a


@njit(cache=True, nogil=True)
def _reset(
    top: int,
    parent: np.ndarray,
    child: np.ndarray,
    following: np.ndarray,
    potential: np.ndarray,
    depth: np.ndarray,
    cost: np.ndarray,
    stack: np.ndarray,
) -> None:
    """Potentials (u_i + v_j = cost_ij along the tree) and depths of `top` and all below it."""
    rows = cost.shape[0]
    size = 1
    stack[0] = top
    while size > 0:
        size -= 1
        node = stack[size]
        up = parent[node]
        if up >= 0:
            depth[node] = depth[up] + 1
            along = cost[node, up - rows] if node < rows else cost[up, node - rows]
            potential[node] = along - potential[up]
        below = child[node]
        while below >= 0:
            stack[size] = below
            size += 1
            below = following[below]


@njit(cache=True, nogil=True)
def _pivot(
    source: int,
    sink: int,
    rows: int,
    parent: np.ndarray,
    flow: np.ndarray,
    child: np.ndarray,
    following: np.ndarray,
    before: np.ndarray,
    potential: np.ndarray,
    depth: np.ndarray,
    cost: np.ndarray,
    stack: np.ndarray,
) -> None:
    """Bring the arc source -> sink into the tree and take out the arc that empties first."""
    least, leaving, at_source = np.inf, -1, True
    a, b = source, sink
    while a != b:
        if depth[a] >= depth[b]:
            if a < rows and flow[a] < least:
                least, leaving, at_source = flow[a], a, True
            a = parent[a]
        else:
            if b >= rows and flow[b] <= least:
                least, leaving, at_source = flow[b], b, False
            b = parent[b]
    a, b = source, sink
    while a != b:
        if depth[a] >= depth[b]:
            flow[a] += -least if a < rows else least
            a = parent[a]
        else:
            flow[b] += -least if b >= rows else least
            b = parent[b]
    # the part below the leaving arc is hung up by its end of the entering arc
    node, above = (source, sink) if at_source else (sink, source)
    carried = least
    while True:
        up, old = parent[node], flow[node]
        _unhang(node, up, child, following, before)
        parent[node], flow[node] = above, carried
        _hang(node, above, child, following, before)
        if node == leaving:
            break
        above, node, carried = node, up, old
    top = source if at_source else sink
    _reset(top, parent, child, following, potential, depth, cost, stack)
