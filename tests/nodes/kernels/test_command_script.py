import pytest

from reperform.nodes.kernels.command_script import Cue, read_script


def test_lines_are_read():
    assert read_script(["0 walk", "2.5 jog speed=2.4 turning=-0.3"]) == [
        Cue(0.0, "walk", {}),
        Cue(2.5, "jog", {"speed": 2.4, "turning": -0.3}),
    ]


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ([], "at least one line"),
        (["0"], "line 1: must be SECONDS MOTION"),
        (["soon walk"], "line 1: the time must be a number"),
        (["2 walk", "1 jog"], "line 2: times must not go back, got 1 s"),
        (["0 walk speed"], "PARAMETER=VALUE, got 'speed'"),
        (["0 walk speed=nan"], "speed must be a number, got 'nan'"),
    ],
)
def test_what_cannot_be_read_is_told(lines, says):
    with pytest.raises(ValueError, match=says):
        read_script(lines)
