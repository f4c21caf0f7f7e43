"""What the nodes that keep only some frames share."""

from __future__ import annotations


def refuse_late_start(who: str, first: int, frames: int) -> None:
    """Raise ValueError where there is no frame to keep."""
    if first >= frames:
        raise ValueError(f"{who}: first must be under the {frames} frames of the take, got {first}")
