import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.mesh_blend import MeshBlender, blend_linear
from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.kernels.rotation import exp, log


@pytest.fixture
def bar() -> tuple[np.ndarray, np.ndarray]:
    """A closed bar of uneven thickness along x, 1 m long, off centre."""
    mesh = trimesh.creation.cylinder(radius=0.08, height=1.0, sections=16)
    for _ in range(3):
        mesh = mesh.subdivide()
    vertices = np.asarray(mesh.vertices)[:, [2, 0, 1]] * [1.0, 1.0 + 0.3, 1.0] + [0.7, 0.9, -1.0]
    return vertices, np.asarray(mesh.faces, np.int32)


def _bent(vertices: np.ndarray, angle: float) -> np.ndarray:
    """The bar rolled into an arc of `angle` in the x y plane; its axis keeps its length."""
    x, y, z = (vertices - [0.7, 0.9, -1.0]).T
    theta = angle * (x + 0.5)
    radius = 1.0 / angle
    return np.stack([(radius - y) * np.sin(theta), radius - (radius - y) * np.cos(theta), z], axis=1)


def test_it_is_exact_at_both_ends(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    other = _bent(vertices, 2.5) + [3.0, -1.0, 0.4]
    blender = MeshBlender.build(vertices + 0.01 * np.sin(30 * vertices[:, [2, 0, 1]]), faces)
    pair = blender.pair(vertices, other)
    np.testing.assert_allclose(blender.at(pair, 0.0), vertices, atol=1e-6)
    np.testing.assert_allclose(blender.at(pair, 1.0), other, atol=1e-6)
    ends = blend_linear([vertices, other], np.array([0.0, 1.0]))
    np.testing.assert_array_equal(ends, other)


def test_bending_half_way_is_half_the_bend(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    first, second = _bent(vertices, 0.1), _bent(vertices, 2.9)
    blender = MeshBlender.build(first, faces)
    middle = blender.at(blender.pair(first, second), 0.5)
    truth = _bent(vertices, 1.5)
    # up to a rigid motion
    a, b = middle - middle.mean(0), truth - truth.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    error = np.linalg.norm(a @ u @ vt - b, axis=1)
    linear = blend_linear([first, second], np.array([0.5, 0.5]))
    assert error.max() < 0.01
    assert abs(volume(middle, faces) / volume(truth, faces) - 1) < 0.005
    assert volume(linear, faces) < 0.98 * volume(truth, faces)


@pytest.mark.parametrize("angle", [2.0, 3.3, 4.5])
def test_a_rigid_turn_is_turned_evenly(bar: tuple[np.ndarray, np.ndarray], angle: float) -> None:
    vertices, faces = bar
    axis = np.array([0.3, 0.8, -0.5]) / np.linalg.norm([0.3, 0.8, -0.5])
    blender = MeshBlender.build(vertices, faces)
    centre = vertices.mean(0)
    other = (vertices - centre) @ exp(axis * angle).T + centre
    shorter = angle if angle <= np.pi else angle - 2 * np.pi
    truth = (vertices - centre) @ exp(axis * shorter / 3).T + centre
    np.testing.assert_allclose(blender.at(blender.pair(vertices, other), 1 / 3), truth, atol=1e-4)


def test_a_twist_beyond_half_a_turn_stays_whole(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar

    def twisted(turn: float) -> np.ndarray:
        local = vertices - [0.2, 0.9, -1.0]
        angle = turn * np.clip((local[:, 0] - 0.15) / 0.7, 0.0, 1.0)
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = local.T
        return np.stack([x, c * y - s * z, s * y + c * z], axis=1)

    blender = MeshBlender.build(vertices, faces)
    pair = blender.pair(twisted(0.0), twisted(4.4))
    assert np.linalg.norm(pair.turns[1], axis=1).max() > 4.2
    error = np.linalg.norm(blender.at(pair, 0.5) - twisted(2.2), axis=1)
    # the other branch would be off by the width of the bar
    assert error.max() < 0.035


def test_loose_pieces_stay_with_the_linear_blend(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    two = np.concatenate([vertices, vertices + [0.0, 0.0, 2.0], [[5.0, 5.0, 5.0]]])
    both = np.concatenate([faces, faces + len(vertices)])
    other = two.copy()
    other[len(vertices) :] += [0.0, 1.0, 0.0]
    blender = MeshBlender.build(two, both)
    np.testing.assert_allclose(
        blender.at(blender.pair(two, other), 0.25), 0.75 * two + 0.25 * other, atol=1e-6
    )


def test_the_way_back_is_the_way_there(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    other = _bent(vertices, 2.0)
    blender = MeshBlender.build(vertices, faces)
    there, back = blender.pair(vertices, other), blender.pair(other, vertices)
    np.testing.assert_allclose(blender.at(there, 0.3), blender.at(back, 0.7), atol=1e-9)


def test_faces_that_name_no_vertex_are_refused(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    with pytest.raises(ValueError, match="must name vertices"):
        MeshBlender.build(vertices[:-1], faces)


def test_a_pair_near_another_keeps_its_branch(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    axis = np.array([0.3, 0.8, -0.5]) / np.linalg.norm([0.3, 0.8, -0.5])
    blender = MeshBlender.build(vertices, faces)
    # turned by a little less, then a little more than half a turn: alone, the second goes the other way round
    before = blender.pair(vertices, vertices @ exp(axis * 3.0).T)
    other = vertices @ exp(axis * 3.3).T
    alone, following = blender.pair(vertices, other), blender.pair(vertices, other, before)
    assert np.linalg.norm(alone.turns[1] - before.turns[1], axis=1).min() > 5.0
    np.testing.assert_allclose(np.linalg.norm(following.turns[1] - before.turns[1], axis=1), 0.3, atol=1e-6)
    np.testing.assert_allclose(blender.at(following, 1.0), other, atol=1e-6)


def _karcher(rotations: list[np.ndarray], weights: np.ndarray) -> np.ndarray:
    mean = rotations[0]
    for _ in range(60):
        step = sum(w * log((mean.T @ r)[None])[0] for w, r in zip(weights, rotations, strict=True))
        mean = mean @ exp(step)
    return mean


def test_several_rigid_turns_blend_to_their_mean(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    centre, random = vertices.mean(0), np.random.default_rng(2)
    rotations = [exp(v) for v in random.normal(size=(4, 3)) * 0.7]
    poses = [(vertices - centre) @ r.T + centre for r in rotations]
    blender = MeshBlender.build(vertices, faces)
    weights = np.array([0.1, 0.4, 0.2, 0.3])
    truth = (vertices - centre) @ _karcher(rotations, weights).T + centre
    np.testing.assert_allclose(blender.blend(blender.poses(poses), weights), truth, atol=1e-5)


def test_the_order_of_several_poses_has_no_say(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    poses = [_bent(vertices, 0.2), _bent(vertices, 2.0) + [0.0, 1.0, 0.0], _bent(vertices[:, [0, 2, 1]], 1.1)]
    weights = np.array([0.2, 0.5, 0.3])
    blender = MeshBlender.build(vertices, faces)
    blended = blender.blend(blender.poses(poses), weights)
    for order in ([1, 2, 0], [2, 1, 0], [0, 2, 1]):
        other = blender.blend(blender.poses([poses[k] for k in order]), weights[order])
        np.testing.assert_allclose(other, blended, atol=1e-9)
    # a pose of weight 0 is not there
    pair = blender.at(blender.pair(poses[0], poses[2]), 0.6)
    without = blender.blend(blender.poses(poses), np.array([0.4, 0.0, 0.6]))
    np.testing.assert_allclose(without, pair, atol=1e-6)
    for k in range(3):
        np.testing.assert_allclose(blender.blend(blender.poses(poses), np.eye(3)[k]), poses[k], atol=1e-6)


def test_several_twists_past_half_a_turn_stay_whole(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar

    def twisted(turn: float) -> np.ndarray:
        x, y, z = (vertices - [0.2, 0.9, -1.0]).T
        angle = turn * np.clip((x - 0.15) / 0.7, 0.0, 1.0)
        return np.stack([x, np.cos(angle) * y - np.sin(angle) * z, np.sin(angle) * y + np.cos(angle) * z], 1)

    blender = MeshBlender.build(vertices, faces)
    poses = blender.poses([twisted(0.0), twisted(4.4), twisted(1.0)])
    blended = blender.blend(poses, np.array([0.3, 0.5, 0.2]))
    assert np.linalg.norm(blended - twisted(2.4), axis=1).max() < 0.035


def test_meshes_of_other_topology_are_refused(bar: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, faces = bar
    blender = MeshBlender.build(vertices, faces)
    with pytest.raises(ValueError, match="vertices, got"):
        blender.pair(vertices, vertices[:-1])
    with pytest.raises(ValueError, match="near must hold 3 poses"):
        blender.poses([vertices] * 3, blender.pair(vertices, vertices))
