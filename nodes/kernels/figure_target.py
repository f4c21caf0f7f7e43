"""Figures against targets, and in the units they are stated in."""

from __future__ import annotations

import math

# prefixes that a figure may be stated with: metres as mm, seconds as ms
_PREFIX = {"m": 1e3, "c": 1e2, "u": 1e6, "k": 1e-3}


def holds(value: float, side: str, target: float) -> int:
    """1 where value `side` target is met, 0 where not, -1 where nothing was measured or nothing is asked.

    side: "<=", ">=" or "" (nothing asked). Infinite values are measured ones.
    """
    if side == "" or math.isnan(value) or math.isnan(target):
        return -1
    return int(value <= target if side == "<=" else value >= target)


def in_unit(value: float, given: str, wanted: str) -> float:
    """A value in another unit: equal, per cent of a share, or with a prefix (mm of m, ms of s).

    Raises ValueError for any other pair.
    """
    if given == wanted:
        return value
    if (given, wanted) == ("1", "%"):
        return 100 * value
    if wanted[1:] == given and wanted[0] in _PREFIX and given in ("m", "s"):
        return value * _PREFIX[wanted[0]]
    raise ValueError(
        f"a figure measured in {given!r} cannot be stated in {wanted!r}: use {given!r} or a prefix"
    )
