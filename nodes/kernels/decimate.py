"""Fewer triangles for the same surface, without ever tearing it."""

from __future__ import annotations

import fast_simplification
import numpy as np
from numba import njit

from reperform.nodes.kernels.largest_component import compact

# Dense meshes are first brought to this many times the budget by fast_simplification, which is several times faster
# but may tear what lies within an edge's length of itself; then it is not used.
_AHEAD = 2
# Share of the edges, cheapest first, that one pass may collapse.
_SHARE = 0.3
# Weight of the squared distance to the old vertices against that to the old planes: keeps triangles well shaped
# on flat places, where planes alone leave the position open.
_SHAPE = 1e-3
# A collapse may not turn a face's normal by more than about 78 degrees.
_TURN = 0.2
# |cross|^2 / longest edge^4 under which a triangle is a sliver (0.75 for an equilateral one).
_SLIVER = 0.01


def decimate(vertices: np.ndarray, faces: np.ndarray, budget: int) -> tuple[np.ndarray, np.ndarray]:
    """A closed manifold mesh of about `budget` vertices (never more, if it can be) by quadric edge collapse.

    Each vertex carries Q = sum over its faces of area (n.x + d)^2, plus a little of |x - v|^2; the edge (u, v)
    costs min_x (Q_u + Q_v)(x). Passes collapse the cheapest edges whose surroundings no other collapse of the pass
    touched. An edge is collapsed only if its ends have exactly two common neighbours (the link condition), so the
    topology cannot change, and if no face turns over. Deterministic: ties go to the lower vertex numbers.

    Source: Garland and Heckbert 1997, SIGGRAPH; Dey et al. 1999, "Topology preserving edge contraction".
    Departure: passes of independent collapses in place of a heap; same order of costs up to a pass.
    """
    points, triangles = _thinned(vertices, faces, _AHEAD * budget)
    quadrics = _vertex_quadrics(points, triangles)
    while (excess := len(points) - budget) > 0:
        edges = _edges(triangles)
        cost, place = _edge_costs(points, quadrics, edges)
        order = _cheapest(cost, max(int(_SHARE * len(edges)), 64))
        start, around = _faces_around(triangles, len(points))
        target = np.arange(len(points), dtype=np.int32)
        done = _collapse(
            points, triangles, quadrics, edges[order], place[order], start, around, target, excess
        )
        if done == 0:
            break
        triangles = target[triangles]
        whole = (
            (triangles[:, 0] != triangles[:, 1])
            & (triangles[:, 1] != triangles[:, 2])
            & (triangles[:, 2] != triangles[:, 0])
        )
        kept = np.zeros(len(points), bool)
        kept[triangles[whole]] = True
        quadrics = quadrics[kept]
        points, triangles = compact(points, triangles[whole])
    return points, triangles


def _thinned(vertices: np.ndarray, faces: np.ndarray, budget: int) -> tuple[np.ndarray, np.ndarray]:
    """A copy of the mesh, brought near the budget by a faster library where that leaves it closed."""
    if len(vertices) > 2 * budget:
        points, triangles = fast_simplification.simplify(
            vertices.astype(np.float32), faces.astype(np.int32), target_count=2 * budget - 4
        )
        if is_closed(triangles):
            return compact(points.astype(np.float64), triangles.astype(np.int32))
    return vertices.astype(np.float64), faces.astype(np.int32)


def _cheapest(cost: np.ndarray, count: int) -> np.ndarray:
    """Indices of about the `count` smallest costs in order; equal costs in order of index."""
    limit = np.partition(cost, count)[count] if count < len(cost) else np.inf
    chosen = np.flatnonzero(cost <= limit)
    return chosen[np.argsort(cost[chosen], kind="stable")]


def is_closed(faces: np.ndarray) -> bool:
    """Whether every edge has exactly two faces that run through it in opposite directions."""
    forward = np.sort(_codes(faces[:, [0, 1, 2]].ravel(), faces[:, [1, 2, 0]].ravel()))
    backward = np.sort(_codes(faces[:, [1, 2, 0]].ravel(), faces[:, [0, 1, 2]].ravel()))
    return bool(np.array_equal(forward, backward) and np.all(forward[1:] != forward[:-1]))


def _codes(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    return start.astype(np.int64) << 32 | end


def _edges(faces: np.ndarray) -> np.ndarray:
    """Undirected edges (E, 2) of a closed mesh, each once."""
    start, end = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    return np.stack([start, end], axis=1)[start < end]


def _vertex_quadrics(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Quadrics (V, 10): upper triangle of A, b, c of x'Ax + 2 b'x + c."""
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    cross = np.cross(b - a, c - a)
    area = 0.5 * np.linalg.norm(cross, axis=1)
    plane = cross / np.maximum(2 * area, 1e-30)[:, None]
    plane = np.concatenate([plane, -np.einsum("fi,fi->f", plane, a)[:, None]], axis=1)
    outer = area[:, None, None] * plane[:, :, None] * plane[:, None, :]
    quadrics = np.zeros((len(points), 10))
    own = np.zeros(len(points))
    pick = ([0, 0, 0, 1, 1, 2, 0, 1, 2, 3], [0, 1, 2, 1, 2, 2, 3, 3, 3, 3])
    for corner in range(3):
        for column, values in enumerate(outer[:, pick[0], pick[1]].T):
            quadrics[:, column] += np.bincount(faces[:, corner], weights=values, minlength=len(points))
        own += np.bincount(faces[:, corner], weights=area, minlength=len(points))
    own *= _SHAPE
    quadrics[:, [0, 3, 5]] += own[:, None]
    quadrics[:, 6:9] -= own[:, None] * points
    quadrics[:, 9] += own * np.einsum("vi,vi->v", points, points)
    return quadrics


@njit(cache=True, nogil=True)
def _edge_costs(points: np.ndarray, quadrics: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least cost of collapsing each edge and where the vertex then goes (Cramer's rule about the middle)."""
    cost = np.empty(len(edges))
    place = np.empty((len(edges), 3))
    q = np.empty(10)
    for e in range(len(edges)):
        u, v = edges[e]
        for k in range(10):
            q[k] = quadrics[u, k] + quadrics[v, k]
        x = 0.5 * (points[u, 0] + points[v, 0])
        y = 0.5 * (points[u, 1] + points[v, 1])
        z = 0.5 * (points[u, 2] + points[v, 2])
        gx = q[0] * x + q[1] * y + q[2] * z + q[6]
        gy = q[1] * x + q[3] * y + q[4] * z + q[7]
        gz = q[2] * x + q[4] * y + q[5] * z + q[8]
        minor_x, minor_y, minor_z = (
            q[3] * q[5] - q[4] * q[4],
            q[2] * q[4] - q[1] * q[5],
            q[1] * q[4] - q[2] * q[3],
        )
        determinant = q[0] * minor_x + q[1] * minor_y + q[2] * minor_z
        if determinant > 0:
            x -= (minor_x * gx + minor_y * gy + minor_z * gz) / determinant
            y -= (
                minor_y * gx + (q[0] * q[5] - q[2] * q[2]) * gy + (q[1] * q[2] - q[0] * q[4]) * gz
            ) / determinant
            z -= (
                minor_z * gx + (q[1] * q[2] - q[0] * q[4]) * gy + (q[0] * q[3] - q[1] * q[1]) * gz
            ) / determinant
        place[e, 0], place[e, 1], place[e, 2] = x, y, z
        value = q[0] * x * x + q[3] * y * y + q[5] * z * z + 2 * (q[1] * x * y + q[2] * x * z + q[4] * y * z)
        value += 2 * (q[6] * x + q[7] * y + q[8] * z) + q[9]
        cost[e] = max(value, 0.0)
    return cost, place


@njit(cache=True, nogil=True)
def _faces_around(faces: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Faces at each vertex v in order: around[start[v] : start[v + 1]]."""
    start = np.zeros(count + 1, np.int64)
    for f in range(len(faces)):
        for corner in range(3):
            start[faces[f, corner] + 1] += 1
    for v in range(count):
        start[v + 1] += start[v]
    free = start[:-1].copy()
    around = np.empty(3 * len(faces), np.int32)
    for f in range(len(faces)):
        for corner in range(3):
            v = faces[f, corner]
            around[free[v]] = f
            free[v] += 1
    return start, around


@njit(cache=True, nogil=True)
def _collapse(
    points: np.ndarray,
    faces: np.ndarray,
    quadrics: np.ndarray,
    edges: np.ndarray,
    place: np.ndarray,
    start: np.ndarray,
    around: np.ndarray,
    target: np.ndarray,
    limit: int,
) -> int:
    """Collapse edges in order into their first vertex (points, quadrics, target change); how many were."""
    touched = np.zeros(len(points), np.bool_)
    mark = np.full(len(points), -1, np.int64)
    done = 0
    for e in range(len(edges)):
        if done >= limit:
            break
        u, v = edges[e]
        if touched[u] or touched[v]:
            continue
        if _blocked(faces, around, start, u, v, touched, mark, e):
            continue
        if _turns(points, faces, around, start[u], start[u + 1], u, v, place[e]) or _turns(
            points, faces, around, start[v], start[v + 1], v, u, place[e]
        ):
            continue
        for w in (u, v):
            for k in range(start[w], start[w + 1]):
                for corner in range(3):
                    touched[faces[around[k], corner]] = True
        points[u] = place[e]
        quadrics[u] += quadrics[v]
        target[v] = u
        done += 1
    return done


@njit(cache=True, nogil=True)
def _blocked(
    faces: np.ndarray,
    around: np.ndarray,
    start: np.ndarray,
    u: int,
    v: int,
    touched: np.ndarray,
    mark: np.ndarray,
    e: int,
) -> bool:
    """Whether the surroundings of the edge (u, v) are touched or share other than two neighbours."""
    for k in range(start[u], start[u + 1]):
        for corner in range(3):
            w = faces[around[k], corner]
            if touched[w]:
                return True
            mark[w] = e
    common = 0
    for k in range(start[v], start[v + 1]):
        for corner in range(3):
            w = faces[around[k], corner]
            if touched[w]:
                return True
            if w != u and w != v and mark[w] == e:
                mark[w] = -2 - e
                common += 1
    return common != 2


@njit(cache=True, nogil=True)
def _turns(
    points: np.ndarray,
    faces: np.ndarray,
    around: np.ndarray,
    first: int,
    last: int,
    moved: int,
    gone: int,
    place: np.ndarray,
) -> bool:
    """Whether a face at `moved` (but not at `gone`) turns over or collapses when `moved` goes to `place`."""
    x, y, z = place[0], place[1], place[2]
    for k in range(first, last):
        f = around[k]
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        if gone in (a, b, c):
            continue
        if b == moved:
            a, b, c = b, c, a
        elif c == moved:
            a, b, c = c, a, b
        bx, by, bz = points[b, 0], points[b, 1], points[b, 2]
        sx, sy, sz = points[c, 0] - bx, points[c, 1] - by, points[c, 2] - bz
        ox, oy, oz = bx - points[a, 0], by - points[a, 1], bz - points[a, 2]
        nx, ny, nz = bx - x, by - y, bz - z
        side = sx * sx + sy * sy + sz * sz
        old_shape, old_size = _shape(ox, oy, oz, sx, sy, sz, side)
        new_shape, new_size = _shape(nx, ny, nz, sx, sy, sz, side)
        # a sliver may go on as one, and its normal is not worth keeping
        if new_shape < min(_SLIVER, old_shape):
            return True
        # (o x s).(n x s) = (o.n)(s.s) - (o.s)(s.n)
        turned = (ox * nx + oy * ny + oz * nz) * side - (ox * sx + oy * sy + oz * sz) * (
            nx * sx + ny * sy + nz * sz
        )
        if old_shape > _SLIVER and turned < _TURN * np.sqrt(old_size * new_size):
            return True
    return False


@njit(cache=True, nogil=True, inline="always")
def _shape(
    ex: float, ey: float, ez: float, sx: float, sy: float, sz: float, side: float
) -> tuple[float, float]:
    """|e x s|^2 over the longest edge^4 of the triangle with edges e, s, e + s, and |e x s|^2."""
    edge = ex * ex + ey * ey + ez * ez
    dot = ex * sx + ey * sy + ez * sz
    size = max(edge * side - dot * dot, 0.0)
    longest = max(edge, side, edge + side + 2 * dot, 1e-300)
    return size / (longest * longest), size
