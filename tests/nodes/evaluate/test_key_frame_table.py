import numpy as np
import pytest

from reperform.nodes.evaluate.key_frame_table import key_frame_table
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.target_grid import TargetGrid

NAMES = [
    "distance", "duration", "relative distance", "relative duration", "infeasible", "undecided", "gap", "smoothness",
]  # fmt: skip


def _grid() -> TargetGrid:
    """Two sequences with targets of 1 and 2 m in 3 s."""
    flat = np.zeros((2, 2, 1))
    return TargetGrid(
        np.array(["a:0 > b:1", "b:1 > a:0"]), np.array([1.0, 2.0]), np.array([3.0]), flat, flat, flat, flat,
        flat.astype(np.int8), np.zeros((2, 2, 1, 3), np.int16),
    )  # fmt: skip


def test_rows_are_sequences_and_columns_their_statistics() -> None:
    value = np.arange(32, dtype=float).reshape(4, 8)
    value[3, 0] = np.nan
    errors = Measures(value, np.array(NAMES), np.array(["1"] * 8))
    times = Measures(
        np.array([[2.0, 0.001], [3.0, 0.002]]), np.array(["prepare", "target"]), np.array(["s", "s"])
    )
    table = key_frame_table({"grid[costume=skirt]": _grid()}, {"e": errors}, {"t": times})
    assert table.character.tolist() == ["skirt", "skirt"]
    assert table.keys.tolist() == ["a:0 > b:1", "b:1 > a:0"]
    np.testing.assert_allclose(table.distance_min, [0.0, 16.0])
    np.testing.assert_allclose(table.distance_rms, [np.sqrt(32.0), 16.0])
    np.testing.assert_allclose(table.distance_max, [8.0, 16.0])
    np.testing.assert_allclose(table.smoothness_min, [7.0, 23.0])
    np.testing.assert_allclose(table.smoothness_max, [15.0, 31.0])
    np.testing.assert_allclose(table.infeasible, [8.0, 24.0])
    np.testing.assert_allclose(table.target, [0.001, 0.002])
    with pytest.raises(ValueError, match="2 sequences of 2 targets, got 3 rows of errors"):
        key_frame_table({"grid": _grid()}, {"e": errors._replace(value=value[:3])}, {"t": times})
