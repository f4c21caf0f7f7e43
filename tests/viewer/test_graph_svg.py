from xml.etree import ElementTree

import pytest

from reperform.viewer.graph_svg import GraphStep, svg

STEPS = [
    GraphStep("film", "studio.film", {}, "fresh", "400 items"),
    GraphStep("mattes", "capture.key", {"footage": "film"}, "stale"),
    GraphStep("hull", "surface.occupancy", {"mattes": "mattes", "rig": "film.cameras"}, "failed"),
]


def test_it_is_svg_with_every_step_input_and_state() -> None:
    text = svg(STEPS, "a & b")
    words = {element.text for element in ElementTree.fromstring(text).iter() if element.text}
    assert {
        "film",
        "studio.film",
        "400 items",
        "mattes",
        "footage",
        ".cameras",
        "stale",
        "failed",
        "a & b",
    } <= words


def test_the_same_steps_give_the_same_bytes() -> None:
    assert svg(STEPS) == svg(list(STEPS))


def test_an_unknown_source_is_named() -> None:
    with pytest.raises(ValueError, match=r"'hull'.*'mattes'.*'matte'"):
        svg([GraphStep("hull", "surface.occupancy", {"mattes": "matte"})])


def test_an_empty_pipeline_draws() -> None:
    ElementTree.fromstring(svg([]))
