import numpy as np
import pytest

from reperform.nodes.evaluate.way_error import way_error
from reperform.nodes.products.played import Played


def test_the_distance_is_to_the_nearest_place_of_the_way():
    way = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 3.0]])
    rest = {name: np.zeros(0) for name in Played._fields}
    root = np.array([[1.0, 0.2, 9.0], [2.5, 1.0, 0.0], [2.0, 3.4, 0.0]])
    got = way_error(Played(**{**rest, "root": root, "way": way}))
    np.testing.assert_allclose(got.value[:, 0], [0.2, 0.5, 0.4], atol=1e-12)
    with pytest.raises(ValueError, match="followed no path"):
        way_error(Played(**{**rest, "root": root, "way": np.zeros((0, 2))}))
