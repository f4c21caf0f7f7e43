"""Ratios of measurements."""

import numpy as np
import pytest

from reperform.nodes.evaluate.ratio import ratio
from reperform.nodes.products.measures import Measures


def of(values, name="volume", unit="m^3") -> Measures:
    return Measures(np.array(values, float), np.array([name] * len(values)), np.array([unit] * len(values)))


def test_ratio_and_its_unit():
    found = ratio(of([0.12, 0.3]), of([0.1, 0.4]))
    assert found.value == pytest.approx([1.2, 0.75])
    assert found.unit.tolist() == ["1", "1"]


def test_over_nothing_is_unmeasured():
    assert np.isnan(ratio(of([0.1, np.nan]), of([0.0, 1.0])).value).all()


@pytest.mark.parametrize(("other", "told"), [({"name": "height"}, "entries"), ({"unit": "m"}, "units")])
def test_other_quantities_are_refused(other, told):
    with pytest.raises(ValueError, match=f"same {told}"):
        ratio(of([1.0]), of([1.0], **other))
