import numpy as np

from reperform.nodes.evaluate.volume_change import volume_change
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation


def test_one_percent_longer_is_three_percent_more(
    carried: Animation, standing: dict[str, MeshSequence]
) -> None:
    measured = volume_change(carried, standing)
    assert measured.value[:-1].max() < 1e-4
    np.testing.assert_allclose(measured.value[-1], 1.01**3 - 1, rtol=1e-3)
