"""The skeletal motion graph: takes of motion capture joined by transitions."""

from __future__ import annotations

from typing import Annotated, Literal

from reperform.nodes.declaration import Param, node
from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.motion import Dissimilarity, MotionGraph
from reperform.nodes.products.performance import SkeletonSequence
from reperform.nodes.skeleton.bones import bones


@node(over="dataset", memory=0.5)
def skeletal(
    similarity: Pairs[Dissimilarity],
    skeletons: Dataset[SkeletonSequence],
    *,
    transitions: Annotated[int, Param("1", 1, 100, "transitions kept per ordered pair of takes (N)")] = 4,
    shortest: Annotated[float, Param("s", 0.02, 2.0, "least half length L of a transition")] = 0.2,
    longest: Annotated[float, Param("s", 0.02, 2.0, "greatest half length L of a transition")] = 0.96,
    length: Annotated[
        Literal["smooth", "similar"],
        Param(about="L: the shortest that jerks little enough, or the one of least cost"),
    ] = "smooth",
    jerk: Annotated[
        float, Param("1", 0.0, 100.0, "greatest acceleration at a join over the capture's; 0 takes any")
    ] = 1.5,
    threshold: Annotated[
        float, Param("1", 0.0, 1.0, "greatest cost, in units of the largest dissimilarity of the dataset")
    ] = 0.5,
    self_transitions: Annotated[bool, Param(about="whether a take may pass into itself")] = True,
    apart: Annotated[float, Param("s", 0.0, 60.0, "least time between both ends within one take")] = 0.4,
    remove: Annotated[
        tuple[str, ...],
        Param(about="transitions to leave out: SOURCE>TARGET, each TAKE, TAKE:FRAME or TAKE:FIRST-LAST"),
    ] = (),
    only: Annotated[
        tuple[str, ...], Param(about="if any, the only transitions to keep, written as for `remove`")
    ] = (),
    forbid: Annotated[
        tuple[str, ...], Param(about="frames that no transition may blend: TAKE or TAKE:FIRST-LAST")
    ] = (),
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
