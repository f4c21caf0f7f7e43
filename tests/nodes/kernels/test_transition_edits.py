import pytest

from reperform.nodes.kernels.transition_edits import Edit

TAKES = ("walk", "jog", "stand_to_walk")


def test_sides_with_wildcards_and_frames() -> None:
    assert Edit("walk>jog", TAKES, "t").covers("walk", 3, "jog", 99)
    assert not Edit("walk>jog", TAKES, "t").covers("jog", 3, "walk", 99)
    edit = Edit("*walk:30-50>*", TAKES, "t")
    assert edit.covers("stand_to_walk", 30, "jog", 0)
    assert edit.covers("walk", 50, "walk", 0)
    assert not edit.covers("walk", 51, "walk", 0)
    assert Edit("walk:7>jog:0", TAKES, "t").covers("walk", 7, "jog", 0)
    assert not Edit("walk:7>jog:0", TAKES, "t").covers("walk", 7, "jog", 1)


@pytest.mark.parametrize("text", ["walk", "walk>", "walk:x>jog", "walk>jog>walk"])
def test_what_cannot_be_read_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="must read"):
        Edit(text, TAKES, "motion_graph.surface")


def test_an_unknown_take_is_named() -> None:
    with pytest.raises(ValueError, match="run"):
        Edit("run>walk", TAKES, "motion_graph.surface")
