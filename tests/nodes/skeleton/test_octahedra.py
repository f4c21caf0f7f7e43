import numpy as np
import pytest
import trimesh

from reperform.nodes.products.performance import SkeletonSequence
from reperform.nodes.skeleton.octahedra import octahedra


def skeleton(joints: np.ndarray) -> SkeletonSequence:
    parents = np.array([-1, 0, 1, 1, 0], np.int32)
    return SkeletonSequence(joints.astype(np.float32), parents, np.array(list("abcde")), np.float32(25))


def test_every_bone_is_closed_and_of_the_volume_of_two_pyramids() -> None:
    joints = np.random.default_rng(3).normal(size=(5, 5, 3))
    joints[:, 4] = joints[:, 0]  # a bone without length
    made = octahedra(skeleton(joints), thickness=0.2, least=0)
    wide = octahedra(skeleton(joints), thickness=0.2, least=0.7)
    assert made.vertices.shape == (5, 18, 3)
    lengths = np.linalg.norm(joints[:, [1, 2, 3]] - joints[:, [0, 1, 1]], axis=-1)
    for t, vertices in enumerate(made.vertices):
        mesh = trimesh.Trimesh(vertices, made.faces, process=False)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        # a square of half diagonal s l under heights that add up to l
        np.testing.assert_allclose(mesh.volume, np.sum(2 * 0.2**2 * lengths[t] ** 3) / 3, rtol=1e-5)
        mesh = trimesh.Trimesh(wide.vertices[t], made.faces, process=False)
        widths = np.maximum(0.2 * lengths[t], 0.7)
        np.testing.assert_allclose(mesh.volume, np.sum(2 * widths**2 * lengths[t]) / 3, rtol=1e-5)


def test_corners_do_not_turn_about_a_bone_that_keeps_its_direction() -> None:
    joints = np.repeat(np.random.default_rng(4).normal(size=(1, 5, 3)), 4, axis=0)
    joints += np.random.default_rng(5).normal(size=(4, 1, 3))
    made = octahedra(skeleton(joints)).vertices
    np.testing.assert_allclose(made - made[:, :1], np.repeat(made[:1] - made[:1, :1], 4, axis=0), atol=2e-6)


def test_a_turned_skeleton_has_turned_bones() -> None:
    # about one axis in small steps, so that bones which lie across it are carried by just that rotation
    flat = np.random.default_rng(6).normal(size=(5, 3)) * [1, 0, 1]
    angle = np.linspace(0, 2.5, 6)
    turn = np.zeros((6, 3, 3))
    turn[:, 0, 0] = turn[:, 2, 2] = np.cos(angle)
    turn[:, 0, 2], turn[:, 2, 0] = np.sin(angle), -np.sin(angle)
    turn[:, 1, 1] = 1
    made = octahedra(skeleton(flat @ turn.swapaxes(1, 2))).vertices
    np.testing.assert_allclose(made, made[0] @ turn.swapaxes(1, 2), atol=1e-5)


def test_a_skeleton_without_bones_is_refused() -> None:
    with pytest.raises(ValueError, match=r"skeleton\.octahedra: at least one bone must be 1 mm"):
        octahedra(skeleton(np.zeros((2, 5, 3))))
