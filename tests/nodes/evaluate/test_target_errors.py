import numpy as np
import pytest

from reperform.nodes.evaluate.target_errors import target_errors
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.target_grid import TargetGrid

ROUGH = Measures(np.array([[0.01], [0.03], [0.02]]), np.array(["smoothness"]), np.array(["m"]))


def _grid() -> TargetGrid:
    """One sequence, targets of 2 and 4 m in 5 s: the first met, the second not."""
    return TargetGrid(
        keys=np.array(["a:0 > b:1"]), distance=np.array([2.0, 4.0]), duration=np.array([5.0]),
        reached_distance=np.array([[[2.04], [3.5]]]), reached_duration=np.array([[[4.96], [5.5]]]),
        cost=np.array([[[1.5], [3.0]]]), bound=np.array([[[1.25], [np.nan]]]),
        status=np.array([[[1], [0]]], np.int8), taken=np.array([[[[2, 0, 1]], [[0, 5, 0]]]], np.int16),
    )  # fmt: skip


def test_entries_are_what_they_say() -> None:
    found = target_errors(_grid(), ROUGH)
    rows = [dict(zip(found.name.tolist(), row, strict=True)) for row in found.value]
    met = {
        "distance": 0.04, "duration": 0.04, "relative distance": 0.02, "relative duration": 0.008,
        "missed distance": np.nan, "missed duration": np.nan, "infeasible": 0.0, "undecided": 0.0, "gap": 0.25,
        "smoothness": 0.02,
    }  # fmt: skip
    assert rows[0] == pytest.approx(met, nan_ok=True)
    assert rows[1]["infeasible"] == 1.0
    assert rows[1]["missed distance"] == pytest.approx(0.5)
    assert rows[1]["missed duration"] == pytest.approx(0.5)
    assert np.isnan([rows[1][name] for name in ("distance", "duration", "gap", "smoothness")]).all()


def test_smoothness_of_another_graph_is_refused() -> None:
    with pytest.raises(ValueError, match="a row per transition, 3, got 2"):
        target_errors(_grid(), ROUGH._replace(value=ROUGH.value[:2]))
