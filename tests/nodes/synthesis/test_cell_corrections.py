"""A character whose meshes are corrected while it plays."""

import numpy as np
import pytest

from reperform.nodes.blend.correct_space import correct_space
from reperform.nodes.synthesis.character import Character, Command
from reperform.nodes.synthesis.character_data import character_data
from reperform.nodes.synthesis.play_script import play_script


@pytest.fixture(scope="module")
def corrections(playable):
    _, spaces = playable
    return {"jumping": correct_space(spaces["jump"], epsilon=0.002, levels=1)}


def _meshes(playable, corrections, height: float, blending: str) -> np.ndarray:
    data = character_data(*playable, corrections, blending)
    jump = data.space("jump")
    values = data.values(jump, {"height": height})
    character = Character(data, jump, values=values)
    shown = []
    for _ in range(30):
        character.perform(0.04)
        shown.append(character.vertices.copy())
    return np.array(shown)


def test_a_take_is_played_as_it_was_captured_to_the_bit(playable, corrections):
    highest = float(playable[1]["jump"].upper[0])
    linear, hybrid = (_meshes(playable, corrections, highest, kind) for kind in ("linear", "hybrid"))
    np.testing.assert_array_equal(linear, hybrid)


def test_blends_are_corrected_where_corrections_are(playable, corrections):
    space = playable[1]["jump"]
    middle = float(space.sample_value[np.argmin(np.abs(space.sample_weight[:, 0] - 0.5)), 0])
    linear, hybrid = (_meshes(playable, corrections, middle, kind) for kind in ("linear", "hybrid"))
    moved = np.linalg.norm(hybrid - linear, axis=-1)
    assert 0.002 < moved.max() < 0.15
    # the poses in which both takes stand alike need none
    assert moved[0].max() == 0


def test_a_script_plays_hybrid_and_transitions_stay_smooth(playable, corrections):
    script = ("0 walk speed=1.2", "0.5 jump height=0.45", "3 walk speed=1.2")
    linear, hybrid = (
        play_script(*playable, corrections, script=script, seconds=3.5, fps=50.0, blending=kind)
        for kind in ("linear", "hybrid")
    )
    np.testing.assert_array_equal(linear.space, hybrid.space)
    walks = (hybrid.spaces[hybrid.space] == "walk") & (hybrid.mix == 1)
    np.testing.assert_array_equal(linear.mesh.vertices[walks][:20], hybrid.mesh.vertices[walks][:20])
    jerk = np.linalg.norm(np.diff(hybrid.mesh.vertices, 2, axis=0), axis=-1)
    before = np.linalg.norm(np.diff(linear.mesh.vertices, 2, axis=0), axis=-1)
    assert np.percentile(jerk, 99, axis=1).max() < 1.15 * np.percentile(before, 99, axis=1).max()


def test_corrections_fade_out_and_in_while_it_plays(playable, corrections):
    data = character_data(*playable, corrections, "hybrid")
    jump = data.space("jump")
    values = np.array([float(np.mean(playable[1]["jump"].value))])
    fading, whole = Character(data, jump, values=values), Character(data, jump, values=values)
    bare = Character(character_data(*playable), jump, values=values)
    apart = []
    for frame in range(30):
        fading.corrected = frame < 5 or frame >= 20
        for character in (fading, whole, bare):
            character.perform(0.04)
        apart.append([np.abs(fading.vertices - other.vertices).max() for other in (whole, bare)])
    from_whole, from_bare = np.array(apart).T
    assert from_whole[:5].max() == 0.0
    # held feet have gone another way in between
    assert max(from_whole[-1], from_bare[14:20].max()) < 0.001
    assert from_whole[14:20].max() > 0.002
    # not at once
    assert 0.0 < from_whole[6] < 0.6 * from_whole[14:20].max() + 0.002


def test_hybrid_without_corrections_is_refused(playable):
    with pytest.raises(ValueError, match="blending must be linear"):
        character_data(*playable, None, "hybrid")


def test_nothing_is_corrected_by_default(playable, corrections):
    data = character_data(*playable, corrections)
    walk = data.space("walk")
    character = Character(data, walk)
    character.step(0.04, Command(walk, data.values(walk, {}), 1))
    assert data.corrections == ((), ())
