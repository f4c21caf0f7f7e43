"""Rows of several tables in one."""

import numpy as np
import pytest

from reperform.nodes.evaluate.figure import figure
from reperform.nodes.evaluate.table import table
from reperform.nodes.products.measures import Measures

ONE = {"take": Measures(np.array([[2.0]]), np.array(["x"]), np.array(["m"]))}


def test_rows_come_in_the_order_given():
    rows = {name: figure(ONE, figure=name, side="<=", target=3.0) for name in ("b", "a", "c")}
    joined = table(rows)
    assert joined.figure.tolist() == ["b", "a", "c"]
    assert table({"first": joined, "more": figure(ONE, figure="d")}).figure.tolist() == ["b", "a", "c", "d"]
    assert joined.holds.tolist() == [1, 1, 1]
    assert joined.holds.dtype == np.int8


def test_two_rows_of_one_name_are_refused():
    row = figure(ONE, figure="same")
    with pytest.raises(ValueError, match="got same twice"):
        table({"a": row, "b": row})
