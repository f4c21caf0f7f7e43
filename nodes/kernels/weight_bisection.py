"""Blend weights on a simplex, halved edge by edge and kept conforming."""

from __future__ import annotations

import numpy as np


class WeightBisection:
    """A simplex of N corners cut into halves, each cut through the middle of one edge.

    Every simplex lists its corners in the order that says which edge is cut next: at depth d the one between its
    corners 0 and k, k = n - d mod n, n = N - 1. Halves of cuts at one edge are made together, so that what is
    linear on each simplex is continuous over all. For two corners it is plain bisection of an interval.

    Source: Maubach 1995, SIAM Journal on Scientific Computing (bisection of simplices by ordered corners).
    """

    def __init__(self, corners: int) -> None:
        # barycentric weights of all points; the first N are the corners
        self.points: list[np.ndarray] = list(np.eye(corners))
        self.corners = [tuple(range(corners))]
        self.depth = [0]
        # per simplex the cut (index of the point in the middle, less N), -1 where it is whole, and its first half
        self.split = [-1]
        self.child = [0]

    @property
    def leaves(self) -> list[int]:
        """The simplices that are whole."""
        return [s for s, cut in enumerate(self.split) if cut < 0]

    def edge(self, simplex: int) -> tuple[int, int]:
        """The points between which a simplex is cut next."""
        n = len(self.points[0]) - 1
        corners = self.corners[simplex]
        return corners[0], corners[n - self.depth[simplex] % n]

    def conflicts(self, simplex: int) -> list[int]:
        """Whole simplices that share the edge of the next cut but would be cut elsewhere: cut them first."""
        edge = set(self.edge(simplex))
        return [s for s in self.leaves if edge <= set(self.corners[s]) and set(self.edge(s)) != edge]

    def middle(self, simplex: int) -> np.ndarray:
        """The weights in the middle of the edge of the next cut."""
        a, b = self.edge(simplex)
        return 0.5 * (self.points[a] + self.points[b])

    def cut(self, simplex: int) -> np.ndarray:
        """Cut every whole simplex at the edge of this one; returns the new point's weights."""
        edge = set(self.edge(simplex))
        weights = self.middle(simplex)
        point = len(self.points)
        self.points.append(weights)
        n = len(weights) - 1
        for s in self.leaves:
            corners = self.corners[s]
            if not edge <= set(corners):
                continue
            k = n - self.depth[s] % n
            self.split[s], self.child[s] = point - n - 1, len(self.corners)
            halves = (
                (*corners[:k], point, *corners[k + 1 :]),
                (*corners[1 : k + 1], point, *corners[k + 1 :]),
            )
            for half in halves:
                self.corners.append(half)
                self.depth.append(self.depth[s] + 1)
                self.split.append(-1)
                self.child.append(0)
        return weights

    def probes(self, simplex: int) -> list[np.ndarray]:
        """Weights at which a simplex tells how well it does: quarters of the next cut's edge, middles, centre."""
        a, b = (self.points[k] for k in self.edge(simplex))
        corners = [self.points[k] for k in self.corners[simplex]]
        found = [0.75 * a + 0.25 * b, 0.5 * (a + b), 0.25 * a + 0.75 * b]
        if len(corners) > 2:
            pairs = [(p, q) for i, p in enumerate(corners) for q in corners[:i]]
            found += [np.mean(corners, axis=0)] + [
                0.5 * (p + q) for p, q in pairs if p is not a or q is not b
            ]
        return found
