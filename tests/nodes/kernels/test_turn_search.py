import numpy as np
import trimesh

from reperform.nodes.kernels.turn_search import likely_turns, turn_matrix


def test_finds_the_turn_and_the_shift():
    body = trimesh.creation.capsule(1.0, 0.2)
    body.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    arm = trimesh.creation.box((0.6, 0.1, 0.12))
    arm.apply_translation((0.35, -0.3, 0.1))
    mesh = trimesh.util.concatenate([body, arm])
    moved = mesh.vertices @ turn_matrix(2.2).T + (1.0, 0.3, -2.0)
    turns = likely_turns((mesh.vertices, mesh.faces), (moved, mesh.faces), 3)
    yaw, shift = turns[0]
    assert abs(yaw - 2.2) < np.deg2rad(4)
    found = mesh.vertices @ turn_matrix(yaw).T + shift
    assert np.abs(found - moved).max() < 0.06


def test_turns_are_at_most_half_a_turn_and_go_from_z_to_x():
    box = trimesh.creation.box((0.2, 0.5, 1.0))
    turns = likely_turns((box.vertices, box.faces), (box.vertices, box.faces), 5)
    assert all(abs(yaw) <= np.pi for yaw, _ in turns)
    assert abs(turns[0][0]) < 1e-9 or abs(abs(turns[0][0]) - np.pi) < 1e-9
    np.testing.assert_allclose(turn_matrix(np.pi / 2) @ (0, 0, 1), (1, 0, 0), atol=1e-15)
