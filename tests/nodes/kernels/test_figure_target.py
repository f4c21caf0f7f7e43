"""Targets and units of figures."""

import math

import pytest

from reperform.nodes.kernels.figure_target import holds, in_unit


@pytest.mark.parametrize(
    ("value", "side", "target", "expected"),
    [
        (1.0, "<=", 1.0, 1),
        (1.01, "<=", 1.0, 0),
        (0.85, ">=", 0.85, 1),
        (0.84, ">=", 0.85, 0),
        (math.inf, ">=", 24.0, 1),
        (math.nan, "<=", 1.0, -1),
        (3.0, "", math.nan, -1),
    ],
)
def test_holds(value, side, target, expected):
    assert holds(value, side, target) == expected


@pytest.mark.parametrize(
    ("value", "given", "wanted", "expected"),
    [(0.012, "m", "mm", 12.0), (1.5, "m", "m", 1.5), (0.25, "s", "ms", 250.0), (0.5, "1", "%", 50.0), (2.0, "m", "cm", 200.0)],
)  # fmt: skip
def test_units(value, given, wanted, expected):
    assert in_unit(value, given, wanted) == pytest.approx(expected)


@pytest.mark.parametrize(("given", "wanted"), [("m", "s"), ("dB", "mdB"), ("1", "mm"), ("m^3", "mm")])
def test_units_of_other_things_are_refused(given, wanted):
    with pytest.raises(ValueError, match=f"'{wanted}'"):
        in_unit(1.0, given, wanted)
