import numpy as np
import pytest

from reperform.nodes.evaluate.shape_colour_accuracy import shape_colour_accuracy
from reperform.nodes.products.shape_colour import ShapeColourHistograms
from reperform.nodes.ragged import Ragged


def _take(phase, frames, entries=10):
    """A cloud that swings: every frame is another mixture of two poses."""
    rng = np.random.default_rng(7)
    rest, swing = rng.normal(size=(2, entries, 3)) * (0.2, 0.5, 0.3)
    colour = rng.random((entries, 3)).astype(np.float32)
    weights = np.sin(0.9 * np.arange(frames) + phase)
    share = np.full(entries, 1 / entries)
    return ShapeColourHistograms(
        Ragged([np.arange(entries, dtype=np.int32)] * frames),
        Ragged([share] * frames),
        Ragged([(rest + 0.5 * w * swing).astype(np.float32) for w in weights]),
        Ragged([colour] * frames),
        np.zeros((frames, 3), np.float32),
        np.array([5, 10, 20, 10, 10, 10], np.int32),
        np.float32(1.2),
    )


def test_with_more_cells_than_bins_at_all_turns_hardly_anything_is_missed():
    takes = {"walk": _take(0.0, 16), "jog": _take(1.3, 18)}
    found = shape_colour_accuracy(takes, pairs=12, candidates=5, half_length=2)
    value = dict(zip(found.name.tolist(), found.value[0].tolist(), strict=True))
    assert value["frames"] == 34
    assert value["spearman"] > 0.98
    np.testing.assert_allclose(value["mean ratio"], 1, atol=0.02)
    assert value["solver difference"] < 1e-9
    assert 1 <= value["turns solved"] < 20
    assert value["top4 agreement"] == 1
    assert value["speedup"] > 0


def test_refuses_takes_that_are_not_there():
    with pytest.raises(ValueError, match="no take 'run' among walk"):
        shape_colour_accuracy({"walk": _take(0, 4)}, source="run")
