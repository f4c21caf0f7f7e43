"""What key-framed synthesis can be asked."""

from __future__ import annotations

from typing import Annotated

from reperform.nodes.declaration import Param

Start = Annotated[str, Param(about="first key frame, as TAKE:FRAME")]
End = Annotated[str, Param(about="last key frame, as TAKE:FRAME")]
Via = Annotated[tuple[str, ...], Param(about="key frames to meet in between, in order, as TAKE:FRAME")]
Keys = Annotated[tuple[str, ...], Param(about="key-frame sequences, each TAKE:FRAME > TAKE:FRAME > ...")]
Distance = Annotated[float | None, Param("m", 0.0, 1000.0, "way of the centroid on the ground")]
Duration = Annotated[float | None, Param("s", 0.0, 600.0, "length of the motion")]
DistanceWeight = Annotated[float, Param("1/m", 0.0, 1e6, "cost of a metre too far or too short")]
DurationWeight = Annotated[float, Param("1/s", 0.0, 1e6, "cost of a second too long or too short")]
DistanceTolerance = Annotated[float, Param("m", 1e-6, 1000.0, "greatest error of the distance")]
DurationTolerance = Annotated[float, Param("s", 1e-6, 600.0, "greatest error of the duration")]
