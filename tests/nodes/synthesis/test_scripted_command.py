"""A body with two bumps for hands closes them on boxes."""

import numpy as np
import pytest

from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.motion_graph.space import space
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.synthesis.character import Character, Command
from reperform.nodes.synthesis.character_data import character_data
from reperform.nodes.synthesis.play_script import play_script

WIDTHS = {"narrow": 0.65, "middle": 0.8, "wide": 1.1}


@pytest.fixture(scope="module")
def meshes(meshes) -> dict[str, MeshSequence]:
    """The walkers, and the same body whose sides go out to a width and back within 2 s."""
    first = meshes["slow"]
    rest = first.vertices[0].astype(float)
    centre = rest.mean(axis=0)
    across = rest[:, 0] - centre[0]
    made = {name: meshes[name] for name in ("slow", "fast")}
    go = np.sin(np.pi * np.arange(50) / 49)[:, None] ** 2
    side = np.where(np.abs(across) > 0.2, np.sign(across), 0.0)
    span = np.ptp(across)
    for name, width in WIDTHS.items():
        points = np.repeat(rest[None], 50, axis=0)
        points[..., 0] += go * side * 0.5 * (width - span)
        points[..., 2] += 0.05 * go * np.abs(side)
        made[name] = MeshSequence(points.astype(np.float32), first.faces, first.fps)
    return made


@pytest.fixture(scope="module")
def spaces(meshes):
    made = {"walk": space(meshes, takes=("slow", "fast"), blend="linear")}
    for outside in ("clamp", "refuse"):
        made[f"box_{outside}"] = space(
            meshes,
            takes=tuple(WIDTHS),
            parameters=("reach_width",),
            cyclic=False,
            blend="linear",
            outside=outside,
        )
    return made


@pytest.fixture(scope="module")
def graphs(spaces):
    def joined(box: str):
        chosen = {name: spaces[name] for name in ("walk", box)}
        edges = (f"walk>{box}", f"{box}>walk")
        return parametric(
            chosen, edges=edges, blend="linear", subdivisions=0, threshold=1.0, latency_weight=5.0
        ), chosen

    return {outside: joined(f"box_{outside}") for outside in ("clamp", "refuse")}


def _gap(played, made) -> np.ndarray:
    one, two = made.hands
    return np.linalg.norm(played.mesh.vertices[:, one] - played.mesh.vertices[:, two], axis=1)


def test_hands_close_on_a_box_of_any_width_and_hold_it(graphs):
    graph, chosen = graphs["refuse"]
    box = chosen["box_refuse"]
    asked = float(0.7 * box.lower[0] + 0.3 * box.upper[0])
    script = ("0 walk speed=0.9", f"0.6 grab width={asked} hold=1.5")
    played = play_script(graph, chosen, script=script, seconds=7.0, fps=50.0)
    held = np.abs(_gap(played, box) - asked) < 0.004
    still = held & (np.abs(played.pose - box.reach[1]) < 1e-3) & (played.mix == 1)
    assert still.sum() / 50 == pytest.approx(1.5, abs=0.06)
    assert np.ptp(np.flatnonzero(still)) == still.sum() - 1
    # and goes on walking
    assert played.spaces[played.space[-1]] == "walk"
    assert (np.diff(played.root[-25:, :2], axis=0) ** 2).sum() > 0


def test_another_request_ends_a_hold(graphs):
    graph, chosen = graphs["clamp"]
    script = ("0 walk speed=0.9", "0.5 grab width=0.9 hold=60", "5 walk speed=0.9")
    played = play_script(graph, chosen, script=script, seconds=7.0)
    names = played.spaces[played.space]
    assert names[5 * 25 - 1] == "box_clamp"
    assert names[-1] == "walk"


def test_a_hold_that_is_taken_back_ends(graphs):
    graph, chosen = graphs["clamp"]
    data = character_data(graph, chosen)
    walk, box = data.space("walk"), data.space("box_clamp")
    character, values = Character(data, walk), data.values(box, {})
    stays = []
    for frame in range(300):
        hold = np.inf if frame < 200 else 0.0
        character.step(0.02, Command(box, values, 1, hold))
        stays.append(character.space == box and character.pose == pytest.approx(data.reach[box]))
    assert sum(stays[150:200]) == 50
    assert not any(stays[205:])
    assert character.space == walk


def test_a_box_out_of_reach_is_refused_or_clamped_by_choice(graphs):
    graph, chosen = graphs["refuse"]
    with pytest.raises(
        ValueError, match=r"line 1: space 'box_refuse': reach_width must be .* m, got 2\.500: ask"
    ):
        play_script(graph, chosen, script=("0 grab width=2.5",), seconds=1.0)
    graph, chosen = graphs["clamp"]
    played = play_script(graph, chosen, script=("0 grab width=2.5 hold=3",), seconds=3.0)
    widest = float(chosen["box_clamp"].upper[0])
    assert _gap(played, chosen["box_clamp"]).max() == pytest.approx(widest, abs=0.01)


def test_what_cannot_hold_or_grab_says_so(graphs, playable):
    graph, chosen = graphs["clamp"]
    with pytest.raises(ValueError, match="space 'walk': hold must be"):
        play_script(graph, chosen, script=("0 walk speed=1 hold=2",), seconds=1.0)
    with pytest.raises(
        ValueError, match="grab needs a space with the parameter reach_width, there are walk, jump"
    ):
        play_script(*playable, script=("0 grab width=0.4",), seconds=1.0)


def test_values_that_no_blend_does_together_are_refused(playable):
    data = character_data(*playable)
    walk = data.space("walk")
    refusing = type(data)(**{**vars(data), "refuse": (True, True)})
    inside = refusing.values(walk, {"speed": 1.2, "turning": 0.1})
    assert inside.tolist() == [1.2, 0.1]
    with pytest.raises(ValueError, match="space 'walk': turning must be"):
        refusing.values(walk, {"turning": 3.0})
