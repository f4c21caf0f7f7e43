import numpy as np

from reperform.nodes.evaluate.transition_time import transition_time
from reperform.nodes.products.motion import Dissimilarity


def test_one_time_per_pair():
    matrix = Dissimilarity(np.random.default_rng(0).random((30, 25)).astype(np.float32))
    found = transition_time({("a", "b"): matrix, ("b", "a"): matrix}, repeats=2)
    assert found.value.shape == (2, 1)
    assert (found.value > 0).all()
    assert found.unit.tolist() == ["s"]
