import pytest

from reperform.nodes.kernels.stretch_action import read_action


def test_metres_and_take_are_read():
    assert read_action(" 2-3.5  jump_* ", "me") == (2.0, 3.5, "jump_*")


@pytest.mark.parametrize("text", ["walk", "2 walk", "3-2 walk", "2-3", "-1-2 walk", "a-b walk"])
def test_what_reads_otherwise_is_refused(text):
    with pytest.raises(ValueError, match="must read FROM-TO TAKE"):
        read_action(text, "me")
