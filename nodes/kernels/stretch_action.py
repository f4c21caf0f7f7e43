"""What is to be done on a stretch of a curve, as a user writes it."""

from __future__ import annotations


def read_action(text: str, who: str) -> tuple[float, float, str]:
    """Metres from and to, and the take's name, of FROM-TO TAKE, such as `2-3.5 walk`.

    Raises ValueError where it does not read so.
    """
    stretch, _, name = text.strip().partition(" ")
    first, _, last = stretch.partition("-")
    try:
        found = float(first), float(last), name.strip()
    except ValueError:
        found = 1.0, 0.0, ""
    if not 0 <= found[0] < found[1] or not found[2]:
        raise ValueError(
            f"{who}: action {text!r} must read FROM-TO TAKE, metres with 0 <= FROM < TO, such as 2-3.5 walk"
        )
    return found
