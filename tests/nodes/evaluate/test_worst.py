import numpy as np
import pytest

from reperform.nodes.evaluate.worst import worst
from reperform.nodes.products.table import Table


def row(name: str, value: float, unit: str = "m") -> Table:
    return Table(
        np.array([name]), np.array([value]), np.array([unit]), np.array([""]), np.array([np.nan]),
        np.array([-1], np.int8), np.array([""]), np.array([np.nan]), np.array(["here"]),
    )  # fmt: skip


def test_the_row_farthest_on_the_wrong_side() -> None:
    rows = {"x": row("a", 0.2), "y": row("b", 0.7), "z": row("c", 0.4)}
    most = worst(rows, figure="most", side="<=", target=0.5)
    assert (float(most.value[0]), int(most.holds[0]), str(most.source[0])) == (0.7, 0, "worst of 3: b")
    least = worst(rows, figure="least", side=">=", target=0.1, source="walks")
    assert (float(least.value[0]), int(least.holds[0]), str(least.source[0])) == (
        0.2,
        1,
        "walks; worst of 3: a",
    )


def test_what_is_not_measured_is_not_passed_over() -> None:
    rows = {"x": row("a", 0.2), "y": row("b", np.nan)}
    out = worst(rows, figure="most", side="<=", target=0.5)
    assert np.isnan(out.value[0])
    assert int(out.holds[0]) == -1
    with pytest.raises(ValueError, match="needs figures of one unit, got m, s"):
        worst({"x": row("a", 0.2), "y": row("b", 1.0, "s")}, figure="most", side="<=", target=0.5)
