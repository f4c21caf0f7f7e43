import numpy as np
import pytest

from reperform.nodes.evaluate.quotient import quotient
from reperform.nodes.products.measures import Measures

ROWS = Measures(
    np.array([[1.0, 4.0, 7.0], [np.nan, 5.0, 7.0], [2.0, 8.0, 7.0]]),
    np.array(["a", "b", "c"]),
    np.array(["m", "m", "s"]),
)


def test_means_of_rows_measured_on_both_sides():
    out = quotient(ROWS, over="a", under="b")
    np.testing.assert_allclose(out.value, [[0.25]])
    assert str(out.name[0]) == "a over b"


def test_units_and_names_must_fit():
    with pytest.raises(ValueError, match="one unit, got m and s"):
        quotient(ROWS, over="a", under="c")
    with pytest.raises(ValueError, match="no entry 'd'; measured were a, b, c"):
        quotient(ROWS, over="a", under="d")
