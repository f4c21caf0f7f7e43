import numpy as np

from reperform.nodes.evaluate.optimality_gap import optimality_gap


def test_the_search_finds_the_least_and_feasibility() -> None:
    found = optimality_gap(graphs=4, targets=8, seed=11)
    gap, wrong = found.value.T
    assert len(found.value) == 32
    assert np.isfinite(gap).any()
    assert np.nanmax(gap) <= 0.0
    assert wrong.max() == 0.0
