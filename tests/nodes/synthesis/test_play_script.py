import gc
import tracemalloc

import numpy as np
import pytest

from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.motion_parameters import Travelled, measure
from reperform.nodes.synthesis.character import Character, Command
from reperform.nodes.synthesis.character_data import character_data
from reperform.nodes.synthesis.play_script import play_script

SCRIPT = ("0 walk speed=1.2", "1.5 jump height=0.5", "4 walk speed=1.4 turning=0.5")


@pytest.fixture(scope="session")
def played(playable):
    return play_script(*playable, script=SCRIPT, seconds=6.0, fps=50.0)


def test_it_does_what_the_script_says_in_time(played):
    names = [str(name) for name in played.spaces[played.space]]
    assert names[0] == "walk"
    assert names[-1] == "walk"
    assert 0.9 < names.count("jump") / 50 < 1.9
    assert np.nanmax(played.latency) <= 1.2
    assert not np.isnan(played.latency).any()
    assert played.mesh.vertices[..., 1].max() > 1.72 + 0.1


def test_what_touches_the_ground_stands_still(played):
    """Of planted feet the lowest vertices of the sole: heel and ball where it is flat, the ball where it rolls."""
    mesh = played.mesh
    foot = foot_contacts([mesh.vertices], mesh.faces, float(mesh.fps)).foot
    speed = []
    for k in range(2):
        sole = mesh.vertices[:, foot == k].astype(np.float64)
        touches = sole[..., 1] < sole[..., 1].min(axis=1, keepdims=True) + 0.015
        for f in np.flatnonzero(played.planted[1:, k] & played.planted[:-1, k]) + 1:
            both = touches[f] & touches[f - 1]
            speed.append(np.linalg.norm((sole[f] - sole[f - 1])[both][:, [0, 2]].mean(axis=0)) * 50)
    assert len(speed) > 200
    assert np.percentile(speed, 99) < 0.025


def test_nothing_pops(played, playable):
    """Accelerations within transitions are of the size of those within the motions that are joined."""
    jerk = np.linalg.norm(np.diff(played.mesh.vertices, 2, axis=0), axis=-1)
    peak = np.percentile(jerk, 99, axis=1)
    joined = played.mix[1:-1] < 1
    assert joined.sum() > 20
    assert peak[joined].max() < 1.5 * peak[~joined].max()


def test_every_frame_is_the_blend_that_it_says(played, playable):
    """In the frame of the root, and feet apart, the mesh is the mix of captured poses of its sources."""
    _, spaces = playable
    takes = [str(take) for take in played.takes]
    np.testing.assert_allclose(played.weight.sum(axis=1), 1, atol=1e-12)
    top = played.mesh.vertices[0, :, 1] > 1.0
    for f in (40, 85, 200):
        made = np.zeros((top.sum(), 1))
        for take, moment, weight in zip(
            played.take[f], played.source_frame[f], played.weight[f], strict=True
        ):
            owner = next(s for s in spaces.values() if takes[take] in list(s.takes))
            row = list(owner.takes).index(takes[take])
            moments = owner.source_frame[row]
            poses = owner.vertices[row][:, top, 1]
            made[:, 0] += weight * np.array(
                [np.interp(moment, moments, poses[:, v]) for v in range(top.sum())]
            )
        np.testing.assert_allclose(played.mesh.vertices[f, top, 1], made[:, 0], atol=0.02)


def test_a_walk_goes_and_turns_as_asked(playable):
    data = character_data(*playable)
    walk = data.space("walk")
    command = Command(walk, data.values(walk, {"speed": 1.3, "turning": -0.4}), 1)
    character = Character(data, walk)
    for _ in range(100):
        character.step(0.02, command)
    assert character.heading == pytest.approx(-0.4 * character.time, abs=0.15)
    start, heading, pose = character.root.copy(), character.heading, character.pose
    time, before = 0.0, pose
    # one whole cycle
    while not before < pose <= character.pose or time < 0.4:
        before = character.pose
        character.step(0.005, command)
        time += 0.005
    chord = np.hypot(*(character.root - start)[:2])
    turned = character.heading - heading
    assert turned / time == pytest.approx(-0.4, abs=0.03)
    assert chord / np.sinc(turned / (2 * np.pi)) / time == pytest.approx(1.3, abs=0.03)


def test_the_loop_allocates_nothing_that_stays(playable):
    data = character_data(*playable)
    character = Character(data)
    commands = [
        Command(s, data.values(s, {}), n) for n, s in enumerate((data.space("walk"), data.space("jump")))
    ]
    sizes = []
    for round in range(7):
        for k in range(300):
            character.step(0.02, commands[k // 100 % 2])
        gc.collect()
        if round == 0:  # compilation keeps what it makes
            tracemalloc.start()
        sizes.append(tracemalloc.get_traced_memory()[0])
        tracemalloc.reset_peak()
    character.step(0.02, commands[1])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # the mesh of one frame is 8 kB; what stays does so in every round, what Python keeps for later only in some
    assert np.diff(sizes).min() < 8000
    assert peak - sizes[-1] < 16000


def test_it_never_dies_under_random_commands(playable):
    data = character_data(*playable)
    character, random = Character(data), np.random.default_rng(2)
    for number in range(150):
        s = int(random.integers(2))
        table = data.maps[s]
        values = table.lower + random.random(len(table.lower)) * (table.upper - table.lower)
        for _ in range(75):
            character.step(0.04, Command(s, values, number))
            assert character.stuck < 1.2
        assert character.latency <= 1.2
        assert np.isfinite(character.vertices).all()


def test_twice_is_the_same(played, playable):
    again = play_script(*playable, script=SCRIPT, seconds=6.0, fps=50.0)
    np.testing.assert_array_equal(again.mesh.vertices, played.mesh.vertices)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("0 fly", "line 1: there is no space 'fly'; there are walk, jump"),
        ("0 walk height=1", "line 1: space 'walk' has no parameter 'height'; it has speed, turning"),
    ],
)
def test_a_wrong_script_is_told_of(playable, line, says):
    with pytest.raises(ValueError, match=says):
        play_script(*playable, script=(line,))


def test_a_space_that_refuses_says_what_it_can(playable):
    graph, spaces = playable
    strict = {**spaces, "walk": spaces["walk"]._replace(refuse=np.asarray(True))}
    with pytest.raises(ValueError, match=r"speed must be 0\.\d+ \.\. 1\.\d+ m/s, got 9\.000"):
        play_script(graph, strict, script=("0 walk speed=9",))


def test_measures_agree_with_the_map(playable):
    """What the space says of a blend is what its root then does."""
    walk = playable[1]["walk"]
    weights = np.array([[0.25, 0.25, 0.25, 0.25]])
    travelled = Travelled(walk.motion, walk.seconds, walk.vertices[..., 1].mean(axis=2))
    speed = measure("speed", travelled, weights, np.zeros((1, 3)), 0)[0]
    assert walk.value[:, 0].min() < speed < walk.value[:, 0].max()
