"""What holding contacts can be told."""

from __future__ import annotations

from typing import Annotated

from reperform.nodes.declaration import Param

Height = Annotated[float, Param("m", 0.001, 0.3, "over where a foot lies, under which it may rest")]
Speed = Annotated[float, Param("m/s", 0.01, 2.0, "under which a foot rests")]
Share = Annotated[
    float, Param("1", 0.5, 1.0, "weight of the sources in which a foot rests, for it to rest in their blend")
]
Ease = Annotated[float, Param("s", 0.02, 1.0, "over which a correction comes and goes")]
