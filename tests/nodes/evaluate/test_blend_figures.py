import numpy as np
import pytest

from reperform.nodes.evaluate.blend_errors import blend_errors
from reperform.nodes.evaluate.blend_figures import blend_figures


def test_entries_are_the_greatest_values_over_weights(turned_pairs):
    errors = blend_errors(turned_pairs, steps=4)
    measures = blend_figures({"x": errors}, pairs=("two",))
    value = dict(zip(measures.name.tolist(), measures.value[0], strict=True))
    assert len(measures.value) == 1
    assert value["linear share"] == errors.largest[1, 0].max() / errors.size[1]
    assert value["hybrid R=3 end"] == errors.end[1, 2]
    assert value["non-linear truth"] == errors.truth[1, 3, 0]
    assert dict(zip(measures.name.tolist(), measures.unit, strict=True))["linear truth"] == "m"
    assert len(blend_figures({"x": errors, "y": errors}).value) == 4


def test_a_pair_that_is_not_there_is_told(turned_pairs):
    with pytest.raises(ValueError, match="no pair 'three'; there are one, two"):
        blend_figures({"x": blend_errors(turned_pairs, steps=2)}, pairs=("three",))
    assert np.isfinite(turned_pairs.first).all()
