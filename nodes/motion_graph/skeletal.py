"""The skeletal motion graph: takes of motion capture joined by transitions."""

from __future__ import annotations

from reperform.nodes.declaration import node
from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.motion_graph.transition_parameters import (
    Apart,
    Forbid,
    Jerk,
    Length,
    Longest,
    Only,
    Remove,
    SelfTransitions,
    Shortest,
    Threshold,
    Transitions,
)
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.motion import Dissimilarity, MotionGraph
from reperform.nodes.products.performance import SkeletonSequence
from reperform.nodes.skeleton.bones import bones


@node(over="dataset", memory=0.5)
def skeletal(
    similarity: Pairs[Dissimilarity],
    skeletons: Dataset[SkeletonSequence],
    *,
    transitions: Transitions = 4,
    shortest: Shortest = 0.2,
    longest: Longest = 0.96,
    length: Length = "smooth",
    jerk: Jerk = 1.5,
    threshold: Threshold = 0.5,
    self_transitions: SelfTransitions = True,
    apart: Apart = 0.4,
    remove: Remove = (),
    only: Only = (),
    forbid: Forbid = (),
) -> MotionGraph:
    """Takes of one skeleton as nodes, and for every ordered pair its N best transitions (m, n, L) as edges.

    The surface motion graph with joints for vertices: same costs, same foresight of the blend, same placement on
    the ground, same edits (motion_graph.surface says how).

    Raises ValueError where takes differ in hierarchy or frame rate, a matrix does not fit its takes, an edit cannot
    be read, or no transition is left.
    Source: Kovar, Gleicher and Pighin 2002, SIGGRAPH (003 section 3.2.1).
    Departure: transitions as for surfaces (000 eqs 2-5), so that one machinery serves both.
    """
    points = {take: bones(skeleton) for take, skeleton in skeletons.items()}
    try:
        return surface(
            similarity, points, transitions=transitions, shortest=shortest, longest=longest, length=length, jerk=jerk,
            threshold=threshold, self_transitions=self_transitions, apart=apart, remove=remove, only=only, forbid=forbid,
        )  # fmt: skip
    except ValueError as error:
        raise ValueError(str(error).replace("motion_graph.surface", "motion_graph.skeletal")) from error
