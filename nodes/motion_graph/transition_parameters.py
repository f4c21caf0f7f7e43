"""What making the transitions of a motion graph can be told."""

from __future__ import annotations

from typing import Annotated, Literal

from reperform.nodes.declaration import Param

Transitions = Annotated[int, Param("1", 1, 100, "transitions kept per ordered pair of takes (N)")]
Shortest = Annotated[float, Param("s", 0.02, 2.0, "least half length L of a transition")]
Longest = Annotated[float, Param("s", 0.02, 2.0, "greatest half length L of a transition")]
Length = Annotated[
    Literal["smooth", "similar"],
    Param(about="L: the shortest that jerks little enough, or the one of least cost"),
]
Jerk = Annotated[
    float, Param("1", 0.0, 100.0, "greatest acceleration at a join over the capture's; 0 takes any")
]
Threshold = Annotated[
    float, Param("1", 0.0, 1.0, "greatest cost, in units of the largest dissimilarity of the dataset")
]
SelfTransitions = Annotated[bool, Param(about="whether a take may pass into itself")]
Apart = Annotated[float, Param("s", 0.0, 60.0, "least time between both ends within one take")]
Remove = Annotated[
    tuple[str, ...],
    Param(about="transitions to leave out: SOURCE>TARGET, each TAKE, TAKE:FRAME or TAKE:FIRST-LAST"),
]
Only = Annotated[
    tuple[str, ...], Param(about="if any, the only transitions to keep, written as for `remove`")
]
Forbid = Annotated[
    tuple[str, ...], Param(about="frames that no transition may blend: TAKE or TAKE:FIRST-LAST")
]
