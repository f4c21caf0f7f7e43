"""The essential graph: what the best paths between all pairs of poses are made of."""

from __future__ import annotations

from reperform.nodes.declaration import node
from reperform.nodes.kernels.shortest_paths import all_distances, essential_edges
from reperform.nodes.motion_graph.pose_edges import complete_digraph, pose_graph
from reperform.nodes.product import Pairs
from reperform.nodes.products.essential import PoseGraph, PoseTransitions


@node(over="dataset", memory=2.0)
def essential(transitions: Pairs[PoseTransitions]) -> PoseGraph:
    """All frames of all takes, and the fewest transitions that keep the best path between any two of them.

        E(i, j) = D + alpha L, and within a take min(alpha (j - i), D + alpha L) for i < j
        J(p) = sum of E along the path; an edge stays where no path over other poses costs as little

    transitions: of every ordered pair of takes, each with itself included. Costs are above 0, so the edges that stay
    are the least set with the shortest paths of the complete digraph; it grows with alpha, since short cuts then
    save time that costs. One more take adds its pairs; those of the others stay as they are.

    Raises ValueError where a pair of takes is missing, or alpha or the frame rate differ.

    Source: Boukhayma and Boyer 2015, 3DV (002 eqs 5-7, section 3.3).
    Departure: of equally cheap paths the one over more poses stays (the captured frames one by one), so that the
    graph does not depend on the order of the search.
    """
    complete = complete_digraph(transitions, "motion_graph.essential")
    source, target = essential_edges(complete.cost, all_distances(complete.cost))
    return pose_graph(complete, source, target)
