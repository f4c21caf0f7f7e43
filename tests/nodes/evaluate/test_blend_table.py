import numpy as np
import pytest

from reperform.nodes.evaluate.blend_errors import METHODS, blend_errors
from reperform.nodes.evaluate.blend_table import blend_table
from reperform.nodes.products.measures import Measures


def test_rows_are_pairs_times_methods(turned_pairs):
    errors = blend_errors(turned_pairs, steps=4)
    times = Measures(np.arange(8.0).reshape(2, 4), np.array(METHODS), np.array(["s"] * 4))
    table = blend_table({"x": errors}, {"t": times})
    assert table.sequence.tolist() == ["one"] * 4 + ["two"] * 4 and table.method.tolist() == list(METHODS) * 2
    np.testing.assert_array_equal(table.seconds, np.arange(8.0))
    np.testing.assert_allclose(table.share * np.repeat(errors.size, 4), table.largest)
    assert table.largest[3] == 0.0 and table.vertices.dtype == np.int32


def test_times_of_other_pairs_are_refused(turned_pairs):
    errors = blend_errors(turned_pairs, steps=2)
    times = Measures(np.zeros((1, 4)), np.array(METHODS), np.array(["s"] * 4))
    with pytest.raises(ValueError, match="1 pairs do not fit errors of 2"):
        blend_table({"x": errors}, {"t": times})
    with pytest.raises(ValueError, match="as many errors as times"):
        blend_table({"x": errors}, {})
