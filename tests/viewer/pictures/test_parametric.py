import numpy as np
import pytest

from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.products.parametric import SpaceSuggestion, TimeWarp
from reperform.viewer.pictures import Look, picture

LOOK = Look(size=(720, 360))


@pytest.fixture(scope="module")
def drawn(circling):
    space = circling(12, 0.2, 1.0)
    spaces = {"slow": space, "quick": circling(10, 0.6, 0.7)}
    graph = parametric(spaces, edges=("slow>quick",), blend="linear", subdivisions=1)
    joins = np.array([[0, 1, 0.1, 2], [2, 3, 0.5, 3]])
    distance = np.array([[0, 0.1, 0.5], [0.1, 0, 0.5], [0.5, 0.5, 0]], np.float32)
    takes = np.array(["a", "b", "c"])
    products = {
        "space": space,
        "two": space._replace(
            parameters=np.array(["height", "speed"]), units=np.array(["m", "m/s"]), value=np.array([[0, 1], [2, 1.5]]),
            sample_value=np.array([[0, 1], [2, 1.5], [1, 1.2]]), inverse_error=np.zeros((2, 2)),
        ),
        "graph": graph,
        "refused": graph._replace(threshold=np.array(0.0)),
        "suggestion": SpaceSuggestion(takes, np.array([0, 0, 1], np.int32), distance, joins, np.array(0.3)),
        "warp": TimeWarp(np.array([0.0, 1.5, 2.0, 4.0]), np.array(0.2)),
    }  # fmt: skip
    return {name: picture(product, 0, LOOK) for name, product in products.items()}


@pytest.mark.parametrize("name", ["space", "two", "graph", "refused", "suggestion", "warp"])
def test_every_product_has_a_picture(drawn, name):
    assert (drawn[name].shape, drawn[name].dtype) == ((360, 720, 3), np.uint8)
    assert np.ptp(drawn[name]) > 100


def test_a_refused_transition_is_drawn_without_a_way(drawn):
    red = {
        name: (np.abs(drawn[name].astype(int) - [209, 73, 91]).sum(axis=2) < 30).sum()
        for name in ("graph", "refused")
    }
    assert red["graph"] > 100
    assert red["refused"] == 0
