import numpy as np

from reperform.nodes.evaluate.transition_truth import transition_truth
from reperform.nodes.products.measure_comparison import MeasureComparison
from reperform.nodes.products.mesh import TextureAtlas
from reperform.nodes.products.performance import Contacts


def _contacts(frames, first):
    """Steps of ten frames, the left foot first."""
    planted = np.zeros((frames, 2), bool)
    for step, t in enumerate(range(first, frames, 10)):
        planted[t : t + 5, step % 2] = True
    return Contacts(planted)


def _texture(tone):
    return TextureAtlas(
        np.zeros((3, 2), np.float32), np.zeros((1, 3), np.int32), np.full((2, 2, 3), tone, np.uint8)
    )


def test_by_hand():
    # b is 4 frames later in its cycle of 20; c is another costume
    contacts = {"a": _contacts(30, 5), "b": _contacts(30, 1), "c": _contacts(30, 5)}
    textures = {"a": _texture(10), "b": _texture(10), "c": _texture(90)}
    chosen = [
        # measure, source, target, frames, cost
        (0, 0, 1, 12, 8, 0.1),
        (0, 1, 0, 8, 12, 0.2),
        (0, 0, 1, 12, 14, 0.3),
        (1, 0, 2, 12, 12, 0.1),
        (1, 0, 1, 13, 9, 0.2),
        (1, 0, 1, 12, 8, 0.3),
    ]
    columns = np.array(chosen).T
    comparison = MeasureComparison(
        np.array(["all", "shape"]), np.array(["a", "b", "c"]), np.int32([30, 30, 30]),
        np.zeros((2, 90, 90), np.float32), *columns[:5].astype(np.int32), columns[5], np.int32(4),
    )  # fmt: skip
    found = transition_truth(comparison, contacts, textures, apart=10)
    value = dict(zip(found.name.tolist(), found.value[0].tolist(), strict=True))
    np.testing.assert_allclose(value["precision all"], 2 / 3)
    np.testing.assert_allclose(value["precision shape"], 2 / 3)
    # two of shape's three are true, but in one place
    assert value["recall all"] == 2 * value["recall shape"] > 0
    assert value["precision gain"] == 0
