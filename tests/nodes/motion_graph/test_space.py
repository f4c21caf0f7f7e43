import numpy as np
import pytest

from reperform.nodes.kernels.control_cells import blend_weights, framed
from reperform.nodes.kernels.parameter_map import ParameterMap, controls_at
from reperform.nodes.kernels.root_frame import travel
from reperform.nodes.motion_graph.space import space
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.parametric import ParametricSpace


def table(made: ParametricSpace) -> ParameterMap:
    return ParameterMap(made.lower, made.upper, made.grid, made.inverse)


def weights_for(made: ParametricSpace, wanted: list[float]) -> np.ndarray:
    d = len(wanted)
    controls, scratch, out = np.empty(d), np.empty(d + 1), np.empty(len(made.takes))
    controls_at(np.array(wanted), table(made), controls)
    blend_weights(controls, framed(made.control, made.cells), scratch, out)
    return out


def test_parameters_of_the_inputs_are_what_they_do(takes):
    made = space(*takes, takes=("right", "left", "slow", "fast"), parameters=("turning", "speed"))
    expected = np.array([[-0.5, 1.1], [0.8, 1.1], [0.0, 0.7], [0.0, 1.5]])
    assert np.abs(made.value - expected).max() < 0.01
    # cycle of 1.3 - 0.3 speed seconds
    assert np.abs(made.seconds.sum(axis=1) - (1.3 - 0.3 * expected[:, 1])).max() < 0.01


def test_a_wanted_speed_is_done_by_the_blend(takes):
    made = space(*takes, takes=("slow", "fast"), parameters=("speed",))
    for speed in (0.7, 0.93, 1.31, 1.5):
        w = weights_for(made, [speed])
        assert w.min() >= 0
        assert w.sum() == pytest.approx(1)
        steps = np.tensordot(w, made.motion, 1)
        track, _ = travel(steps)
        done = np.linalg.norm(track[-1]) / (w @ made.seconds).sum()
        assert done == pytest.approx(speed, abs=0.004)
    assert made.inverse_error.max() < 0.005


@pytest.mark.parametrize(("method", "limit"), [("monotone", 0.005), ("rbf", 0.005), ("polynomial", 0.03)])
def test_every_inverse_finds_what_was_asked(takes, method, limit):
    made = space(*takes, takes=("slow", "fast"), inverse=method)
    assert made.inverse_error[0, 1] < limit


def test_two_parameters_are_inverted_together(takes):
    made = space(*takes, takes=("right", "left", "slow", "fast"), parameters=("turning", "speed"))
    assert made.inverse_error[:, 0].max() < 0.004
    assert made.inverse_error[:, 1].max() < 0.03


def test_poses_face_ahead_wherever_the_take_lay(takes):
    made = space(*takes, takes=("slow", "fast"))
    ground = made.motion[..., :2].mean(axis=1)
    assert np.abs(ground[:, 0]).max() < 0.03 * ground[:, 1].min()
    assert np.abs(made.vertices[..., [0, 2]].mean(axis=2)).max() < 1e-5


def test_a_cycle_goes_on_from_its_last_pose_to_its_first(takes):
    made = space(*takes, takes=("slow", "fast"))
    steps = np.linalg.norm(made.vertices - np.roll(made.vertices, 1, axis=1), axis=-1).max(axis=-1)
    assert (steps[:, 0] < 1.15 * steps[:, 1:].max(axis=1)).all()


def test_feet_come_down_at_the_same_pose(takes):
    made = space(*takes, takes=("slow", "fast", "left", "right"))
    down = [[np.flatnonzero(held & ~np.roll(held, 1)) for held in feet.T] for feet in made.planted]
    for foot in (0, 1):
        assert np.ptp([row[foot][0] for row in down]) <= 1


def test_a_motion_that_is_not_cyclic_keeps_its_ends(takes):
    made = space(*takes, takes=("low", "high"), parameters=("height",), cyclic=False)
    assert made.value.ravel() == pytest.approx([0.2, 0.55], abs=0.01)
    assert made.source_frame[:, 0].tolist() == [0, 0]
    assert made.source_frame[:, -1].tolist() == [34, 34]
    assert (np.diff(made.source_frame, axis=1) > 0).all()
    assert made.seconds[:, -1].tolist() == [0, 0]
    half = weights_for(made, [0.4])
    rise = (half @ made.vertices[..., 1].mean(axis=2)).max() - made.vertices[0, 0, :, 1].mean()
    assert rise == pytest.approx(0.4, abs=0.01)


def test_a_reach_is_measured_at_the_marked_vertex(takes):
    meshes, _ = takes
    made = space(
        {k: meshes[k] for k in ("low", "high")},
        parameters=("reach_y",),
        cyclic=False,
        hand=43,
        blend="linear",
    )
    vertex, pose = made.reach
    assert vertex == 43
    assert made.value[:, 0] == pytest.approx(made.vertices[:, pose, vertex, 1])


def test_a_width_is_the_gap_between_two_hands(takes):
    """Two vertices go apart and back, farther in each take; what is asked is the distance at their farthest."""
    standing = takes[0]["low"]
    rest = standing.vertices[0].astype(float)
    # opposite corners of the highest ring
    left, right = (int(36 + np.argmax(sign * rest[36:42, 0])) for sign in (1, -1))
    out_and_back = np.sin(np.pi * np.arange(15) / 14)[:, None]
    meshes, wide = {}, [0.1, 0.25, 0.5]
    for k, gap in enumerate(wide):
        points = np.repeat(rest[None], 15, axis=0)
        points[:, left] += out_and_back * [1.2 * gap, 0.1, 0.2]
        points[:, right] += out_and_back * [-gap, 0.1, 0.2]
        meshes[f"grab{k}"] = MeshSequence(points.astype(np.float32), standing.faces, standing.fps)
    made = space(meshes, parameters=("reach_width",), cyclic=False, blend="linear", outside="refuse")
    assert sorted(made.hands.tolist()) == sorted([left, right])
    apart = rest[left] - rest[right] + np.outer(wide, [2.2, 0, 0])
    assert made.value[:, 0] == pytest.approx(np.linalg.norm(apart, axis=1), abs=1e-3)
    blended = np.tensordot(weights_for(made, [0.8]), made.vertices[:, 7], 1)
    assert np.linalg.norm(blended[left] - blended[right]) == pytest.approx(0.8, abs=0.005)


def test_three_parameters_of_a_reach_are_inverted_together(takes):
    """The last vertex goes out to known places and back; the rest stands, the last of the rest breathes."""
    standing = takes[0]["low"]
    rest = standing.vertices[0].astype(float)
    places = [[0.6, 1.2, 0.5], [-0.5, 1.3, 0.6], [0.1, 2.3, 0.4], [0.0, 1.4, 1.3], [0.05, 1.5, 0.7]]
    out_and_back = np.sin(np.pi * np.arange(15) / 14)[:, None]
    meshes = {}
    for k, place in enumerate(places):
        points = np.repeat(rest[None], 15, axis=0)
        points[:, 43] += out_and_back * (np.array(place) - rest[43])
        meshes[f"reach{k}"] = MeshSequence(points.astype(np.float32), standing.faces, standing.fps)
    made = space(meshes, parameters=("reach_x", "reach_y", "reach_z"), cyclic=False, blend="linear")
    assert made.reach.tolist() == [43, 7]
    assert made.cells.shape[1] == 4
    # from the root: the mean vertex, at first
    origin = rest.mean(axis=0) * [1, 0, 1]
    assert made.value == pytest.approx(np.array(places) - origin, abs=0.02)
    assert made.inverse_error[:, 0].max() < 0.01


def test_without_contacts_cycles_are_in_phase_all_the_same(takes):
    meshes, contacts = takes
    names = ("slow", "fast", "left", "right")
    told, found = space(meshes, contacts, takes=names, parameters=("speed", "turning")), space(
        meshes, takes=names, parameters=("speed", "turning")
    )  # fmt: skip
    # swing of the top against the bottom says where in the cycle a pose is
    swing = [
        made.vertices[..., 36:42, 2].mean(axis=-1) - made.vertices[..., :6, 2].mean(axis=-1)
        for made in (told, found)
    ]
    for made in swing:
        spectrum = np.fft.fft(made, axis=1)[:, 1]
        turn = np.angle(spectrum / spectrum[0])
        assert np.abs(turn).max() < 0.25
    assert np.abs(told.value - found.value).max() < 0.01


def test_a_cycle_begins_at_the_first_key(takes):
    meshes, _ = takes
    keys = ("slow 0.2 0.7", "fast 0.4 0.8")
    made = space(meshes, takes=("slow", "fast"), keys=keys)
    assert made.source_frame[:, 0] == pytest.approx([5, 10])


def test_given_key_frames_coincide(takes):
    meshes, _ = takes
    made = space(
        {k: meshes[k] for k in ("low", "high")},
        parameters=("height",),
        cyclic=False,
        keys=("low 0.72", "high 0.8"),
    )
    # the phase of the pose at which the key lies is the mean of its shares of both takes
    reached = [float(np.interp(0.5 * (18 + 20), np.arange(35), row)) for row in made.source_frame]
    assert reached == pytest.approx([18, 20], abs=0.1)


def test_errors_say_what_to_do(takes):
    meshes, contacts = takes
    with pytest.raises(ValueError, match="two takes or more to blend, got slow"):
        space(meshes, takes=("slow",))
    with pytest.raises(ValueError, match="no take trot"):
        space(meshes, takes=("slow", "trot"))
    with pytest.raises(ValueError, match="height does not vary"):
        space(meshes, contacts, takes=("slow", "fast"), parameters=("height",))
    with pytest.raises(ValueError, match="repeat itself"):
        space(meshes, takes=("low", "high"), parameters=("height",))
    with pytest.raises(ValueError, match="2 parameters need at least 3 takes"):
        space(meshes, takes=("slow", "left"), parameters=("turning", "speed"))
    with pytest.raises(ValueError, match="key frames"):
        space(meshes, takes=("slow", "fast"), keys=("slow 0.1",))
    with pytest.raises(ValueError, match="one to three"):
        space(meshes, takes=("slow", "fast"), parameters=())
    cut = MeshSequence(meshes["fast"].vertices, meshes["fast"].faces[:-1], meshes["fast"].fps)
    with pytest.raises(ValueError, match="one topology"):
        space({"slow": meshes["slow"], "fast": cut})


def test_takes_that_do_the_same_cannot_be_told_apart(takes, walk):
    meshes, contacts = ({**part} for part in takes)
    meshes["again"], contacts["again"] = walk(1.5, heading=1.0)
    with pytest.raises(ValueError, match="cannot be inverted"):
        space(meshes, contacts, takes=("slow", "fast", "again"))
