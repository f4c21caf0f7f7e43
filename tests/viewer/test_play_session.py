"""Directing a character without a display."""

import numpy as np
import pytest

from reperform.nodes.synthesis.character_data import character_data
from reperform.viewer.play_headless import play_picture, play_scripted
from reperform.viewer.play_opening import write_recording
from reperform.viewer.play_script_input import Act, ScriptedInput, read_acts
from reperform.viewer.play_session import PlaySession


@pytest.fixture
def session(playable) -> PlaySession:
    return PlaySession(character_data(*playable), (("m/s", "rad/s"), ("m",)))


def played(session: PlaySession, text: str, seconds: float) -> PlaySession:
    play_scripted(session, ScriptedInput(read_acts(text.splitlines())), seconds)
    return session


def test_arrows_change_speed_and_direction(session):
    slow = session.values[0].copy()
    played(session, "0.2 press up\n0.9 release up\n1 press left\n1.5 release left", 3.0)
    assert session.values[0][0] > slow[0] + 0.2
    assert session.values[0][1] > 0.2
    assert session.character.heading > 0.2
    # and no further than the space can
    played(session, "0 press up", 5.0)
    assert session.values[0][0] == session.data.maps[0].upper[0]


def test_a_key_calls_a_jump_and_the_walk_goes_on(session):
    seen = []
    hands = ScriptedInput([Act(1.0, "press", ("j",))])
    for k in range(200):
        hands.due(session, k / 50)
        session.tick(0.02)
        seen.append(session.character.space)
    assert 1 in seen
    assert seen[0] == seen[-1] == session.space == 0
    assert session.character.latency < 1.2
    assert "latency 0." in session.status()


def test_a_drawn_path_is_followed(session):
    played(session, "0 draw 0.3 1.5\n0 draw -0.4 3\n0 draw 0 4.5\n0 follow", 3.0)
    assert session.pilot is not None
    played(session, "", 6.0)
    assert session.pilot is None
    assert session.path == []
    assert session.character.root[1] > 4.0


def test_a_path_begins_where_the_character_is_when_it_is_let_go(session):
    session.draw(0.3, 4.0)
    drawn = list(session.path)
    played(session, "", 1.0)
    session.draw(0.0, 6.0)
    session.follow()
    assert session.path[0] != drawn[0]
    np.testing.assert_allclose(session.path[0], session.character.root[:2])
    before = session.parameters_picture((360, 200))
    played(session, "", 1.0)
    assert (session.parameters_picture((360, 200)) != before).any()


def test_a_key_that_is_held_holds_what_reaches_and_another_switches_blending(session):
    played(session, "0 press r", 0.2)
    assert session.command().hold == np.inf
    session.release("r")
    assert session.command().hold == 0.0
    assert session.character.corrected
    session.press("h")
    assert not session.character.corrected
    # nothing to switch where there are no corrections
    assert "blending" not in session.status()


def test_what_was_recorded_is_a_product_and_a_file(session, tmp_path):
    with pytest.raises(ValueError, match="nothing was recorded"):
        write_recording(session, tmp_path / "none.npz")
    played(session, "0.2 press c\n1.2 press c", 2.0)
    made = session.recorded()
    assert 49 <= len(made.root) <= 51
    assert "recorded 1.0 s" in session.status()
    write_recording(session, tmp_path / "made.npz")
    with np.load(tmp_path / "made.npz") as stored:
        np.testing.assert_array_equal(stored["mesh.vertices"], made.mesh.vertices)


def test_the_diagrams_show_what_plays_and_under_which_values(session):
    """The space that plays is green, the values asked are red where they are on the scale."""
    before = session.parameters_picture((360, 200))
    nodes = session.nodes_picture((360, 300))
    green = (nodes[..., 1].astype(int) - nodes[..., 0] > 40) & (
        nodes[..., 1].astype(int) - nodes[..., 2] > 40
    )
    assert green.sum() > 200
    session.values[0][0] = session.data.maps[0].upper[0]
    after = session.parameters_picture((360, 200))

    def red(picture):
        return (picture[:100, :, 0].astype(int) - picture[:100, :, 1] > 90).nonzero()[1].max()

    assert red(after) > red(before) - 5
    assert (before != after).any()


def test_the_whole_is_drawn_without_a_display(session):
    page = play_picture(played(session, "0 press up", 0.4), (640, 400))
    assert page.shape == (400, 640, 3)
    assert page[:344, :448].std() > 10


@pytest.mark.parametrize("line", ["0", "soon press j", "0 hold j", "0 draw 1", "0 draw a b", "0 press"])
def test_a_wrong_script_of_keys_is_told_of(line):
    with pytest.raises(ValueError, match="input, line 2: must be SECONDS press KEY"):
        read_acts(["# keys", line])
