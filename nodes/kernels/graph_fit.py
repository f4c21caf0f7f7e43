"""Gauss-Newton steps that fit a deformation graph to where its vertices want to go."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from scipy.linalg import solveh_banded

from reperform.nodes.kernels.deformation_graph import DeformationGraph
from reperform.nodes.kernels.rotation import exp


def deform(
    graph: DeformationGraph, vertices: np.ndarray, rotation: np.ndarray, translation: np.ndarray
) -> np.ndarray:
    """The vertices (V, 3) under the nodes' motions: rotation (K, 3, 3), translation (K, 3) from rest."""
    return _deform(vertices, graph.influence, graph.weight, graph.places, rotation, translation)


def node_motions(
    graph: DeformationGraph, vertices: np.ndarray, moved: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The rigid motions (K, 3, 3), (K, 3) of the nodes that best explain where the vertices went (V, 3).

    Each node's rotation is the orthogonal Procrustes fit of the vertices it moves, weighted as they follow
    it; the translation takes its place g to where that fit takes it.
    """
    mass, covariance, source, target = _moments(
        vertices, moved, graph.influence, graph.weight, len(graph.places)
    )
    u, _, vt = np.linalg.svd(covariance)
    flip = np.linalg.det(u @ vt) < 0
    u[flip, :, 2] *= -1
    rotation = u @ vt
    arm = graph.places - source / mass[:, None]
    return rotation, np.einsum("kij,kj->ki", rotation, arm) + target / mass[:, None] - graph.places


def link_arms(
    graph: DeformationGraph, rest: np.ndarray, rotation: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """What each end of a link should see of the other, in its own rest frame: (E, 2, 3).

    rest: (V, 3) the pose that has the true lengths; rotation: (K, 3, 3) of the nodes from that pose to the
    start of the fit; start: (K, 3, 3) from the graph's own rest to the same start. A link's vector at the
    start is the mean of what its two ends say, (R_j + R_k) / 2 (g_k - g_j): lengths come from `rest`, so
    that changes of shape do not build up from fit to fit, while bending already done costs nothing.
    """
    j, k = graph.links[:, 0], graph.links[:, 1]
    places = np.asarray(rest[graph.samples], np.float64)
    vector = np.einsum("eab,eb->ea", (rotation[j] + rotation[k]) / 2, places[k] - places[j])
    return np.stack(
        [np.einsum("eba,eb->ea", start[j], vector), np.einsum("eba,eb->ea", start[k], -vector)], axis=1
    )


def fit_step(
    graph: DeformationGraph,
    vertices: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    arms: np.ndarray,
    pull: np.ndarray,
    force: np.ndarray,
    stiffness: float,
    slip: float = np.inf,
) -> tuple[np.ndarray, np.ndarray]:
    """One Gauss-Newton step of E = sum_i (x_i - c_i)' A_i (x_i - c_i) + stiffness V / E sum_(jk) rho(e_jk) +
    rho(e_kj), rho(e) = |e|^2 for small e.

    pull: A (V, 3, 3); force: A_i (c_i - x_i) at the present x (V, 3). e_jk = R_j (g_k - g_j) + g_j + t_j -
    g_k - t_k keeps neighbouring motions alike; it compares with the rest shape, so changes of shape do not
    build up from fit to fit. rho is Welsch's loss of scale slip |g_k - g_j|: a link that is bent or stretched by more
    lets go, so that a foot slides along the hem that the rest surface joins it to. Returns the new rotations and
    translations.
    Source: Yao, Deng, Xu and Zhang, CVPR 2020 (Welsch's loss of closest points and of smoothness).
    """
    count = len(graph.places)
    band = np.zeros((6 * graph.bandwidth + 6, 6 * count))
    right = np.zeros(6 * count)
    _assemble_data(band, right, vertices, graph.influence, graph.weight, graph.places, rotation, pull, force)
    weight = stiffness * len(vertices) / max(len(graph.links), 1)
    _assemble_links(band, right, graph.links, arms, graph.places, rotation, translation, weight, slip)
    # far less than any datum: keeps nodes solvable that nothing pulls
    band[0] += 1e-6 * len(vertices) / count
    step = solveh_banded(
        band, right, overwrite_ab=True, overwrite_b=True, lower=True, check_finite=False
    ).reshape(count, 6)
    return exp(step[:, :3]) @ rotation, translation + step[:, 3:]


@njit(cache=True, nogil=True)
def _deform(
    vertices: np.ndarray,
    influence: np.ndarray,
    weight: np.ndarray,
    places: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
) -> np.ndarray:
    moved = np.zeros((len(vertices), 3))
    for i in range(len(vertices)):
        for k in range(influence.shape[1]):
            w = weight[i, k]
            if w == 0:
                continue
            j = influence[i, k]
            for r in range(3):
                x = places[j, r] + translation[j, r]
                for c in range(3):
                    x += rotation[j, r, c] * (vertices[i, c] - places[j, c])
                moved[i, r] += w * x
    return moved


@njit(cache=True, nogil=True)
def _moments(
    vertices: np.ndarray, moved: np.ndarray, influence: np.ndarray, weight: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    mass = np.full(count, 1e-12)
    source, target = np.zeros((count, 3)), np.zeros((count, 3))
    for i in range(len(vertices)):
        for k in range(influence.shape[1]):
            j, w = influence[i, k], weight[i, k]
            mass[j] += w
            for r in range(3):
                source[j, r] += w * vertices[i, r]
                target[j, r] += w * moved[i, r]
    covariance = np.zeros((count, 3, 3))
    for j in range(count):
        # where vertices lie in a line or a plane the rotation stays near the identity
        for r in range(3):
            covariance[j, r, r] = 1e-9 * mass[j]
    for i in range(len(vertices)):
        for k in range(influence.shape[1]):
            j, w = influence[i, k], weight[i, k]
            for r in range(3):
                for c in range(3):
                    covariance[j, r, c] += (
                        w * (moved[i, r] - target[j, r] / mass[j]) * (vertices[i, c] - source[j, c] / mass[j])
                    )
    return mass, covariance, source, target


@njit(cache=True, nogil=True)
def _assemble_data(
    band: np.ndarray,
    right: np.ndarray,
    vertices: np.ndarray,
    influence: np.ndarray,
    weight: np.ndarray,
    places: np.ndarray,
    rotation: np.ndarray,
    pull: np.ndarray,
    force: np.ndarray,
) -> None:
    """Add J' A J and J' A (c - x): dx_i = sum_k w (domega_j x q + dt_j), q = R_j (p_i - g_j)."""
    many = influence.shape[1]
    jacobian = np.zeros((many, 6, 3))
    product = np.zeros((6, 3))
    for i in range(len(vertices)):
        if pull[i, 0, 0] == 0 and pull[i, 1, 1] == 0 and pull[i, 2, 2] == 0:
            continue
        for k in range(many):
            j, w = influence[i, k], weight[i, k]
            q0 = q1 = q2 = 0.0
            for c in range(3):
                arm = vertices[i, c] - places[j, c]
                q0 += rotation[j, 0, c] * arm
                q1 += rotation[j, 1, c] * arm
                q2 += rotation[j, 2, c] * arm
            block = jacobian[k]
            # rows: the cross product with q, transposed, then the identity
            block[0, 1], block[0, 2] = -w * q2, w * q1
            block[1, 0], block[1, 2] = w * q2, -w * q0
            block[2, 0], block[2, 1] = -w * q1, w * q0
            block[3, 0] = block[4, 1] = block[5, 2] = w
            for r in range(6):
                right[6 * j + r] += (
                    block[r, 0] * force[i, 0] + block[r, 1] * force[i, 1] + block[r, 2] * force[i, 2]
                )
        for k in range(many):
            if weight[i, k] == 0:
                continue
            for r in range(6):
                for c in range(3):
                    product[r, c] = (
                        jacobian[k, r, 0] * pull[i, 0, c]
                        + jacobian[k, r, 1] * pull[i, 1, c]
                        + jacobian[k, r, 2] * pull[i, 2, c]
                    )
            for m in range(many):
                if weight[i, m] == 0 or influence[i, m] > influence[i, k]:
                    continue
                row, column = 6 * influence[i, k], 6 * influence[i, m]
                for r in range(6):
                    for c in range(6):
                        if row + r >= column + c:
                            band[row + r - column - c, column + c] += (
                                product[r, 0] * jacobian[m, c, 0]
                                + product[r, 1] * jacobian[m, c, 1]
                                + product[r, 2] * jacobian[m, c, 2]
                            )


@njit(cache=True, nogil=True)
def _assemble_links(
    band: np.ndarray,
    right: np.ndarray,
    links: np.ndarray,
    arms: np.ndarray,
    places: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    stiffness: float,
    slip: float,
) -> None:
    """Add both residuals of every link: de_jk = domega_j x q + dt_j - dt_k, q = R_j (g_k - g_j)."""
    q = np.zeros(3)
    for e in range(len(links)):
        for side in range(2):
            j, k = links[e, side], links[e, 1 - side]
            for r in range(3):
                q[r] = 0.0
                for c in range(3):
                    q[r] += rotation[j, r, c] * arms[e, side, c]
            e0 = q[0] + places[j, 0] + translation[j, 0] - places[k, 0] - translation[k, 0]
            e1 = q[1] + places[j, 1] + translation[j, 1] - places[k, 1] - translation[k, 1]
            e2 = q[2] + places[j, 2] + translation[j, 2] - places[k, 2] - translation[k, 2]
            square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
            weight = stiffness * welsch(e0 * e0 + e1 * e1 + e2 * e2, slip * math.sqrt(max(square, 1e-12)))
            if weight == 0:
                continue
            a, b = 6 * j, 6 * k
            right[a + 0] -= weight * (q[1] * e2 - q[2] * e1)
            right[a + 1] -= weight * (q[2] * e0 - q[0] * e2)
            right[a + 2] -= weight * (q[0] * e1 - q[1] * e0)
            right[a + 3] -= weight * e0
            right[a + 4] -= weight * e1
            right[a + 5] -= weight * e2
            right[b + 3] += weight * e0
            right[b + 4] += weight * e1
            right[b + 5] += weight * e2
            for r in range(3):
                band[0, a + r] += weight * (square - q[r] * q[r])
                band[0, a + 3 + r] += weight
                band[0, b + 3 + r] += weight
                for c in range(r):
                    band[r - c, a + c] -= weight * q[r] * q[c]
            # [q]_x couples domega_j with dt_j (same block) and, negated, with dt_k
            skew = ((0.0, -q[2], q[1]), (q[2], 0.0, -q[0]), (-q[1], q[0], 0.0))
            for r in range(3):
                for c in range(3):
                    s = -weight * skew[r][c]
                    band[a + 3 + r - a - c, a + c] += s
                    if b > a:
                        band[b + 3 + r - a - c, a + c] -= s
                    else:
                        band[a + c - b - 3 - r, b + 3 + r] -= s
                low, high = min(a, b), max(a, b)
                band[high - low, low + 3 + r] -= weight


@njit(cache=True, nogil=True)
def welsch(squared: float, scale: float) -> float:
    """Weight exp(-r^2 / (2 scale^2)) of a residual in the Welsch loss; 0 past three scales."""
    ratio = squared / (2 * scale * scale)
    return math.exp(-ratio) if ratio < 4.5 else 0.0
