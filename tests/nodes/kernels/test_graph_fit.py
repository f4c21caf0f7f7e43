import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.deformation_graph import deformation_graph, farthest_samples
from reperform.nodes.kernels.graph_fit import deform, fit_step, link_arms, node_motions
from reperform.nodes.kernels.rotation import exp


@pytest.fixture(scope="module")
def scene():
    mesh = trimesh.creation.icosphere(3)
    vertices = mesh.vertices * (0.2, 0.8, 0.3) + (0.5, 1.0, -2.0)
    samples, distances = farthest_samples(vertices, mesh.faces.astype(np.int32), 20)
    return vertices, deformation_graph(vertices, samples, distances, 20)


def _rest(graph):
    return np.tile(np.eye(3), (20, 1, 1)), np.zeros((20, 3))


def test_a_rigid_motion_is_found_and_reproduced(scene):
    vertices, graph = scene
    turn = exp(np.array([0.4, -1.1, 0.7]))
    moved = vertices @ turn.T + (0.3, -0.2, 1.0)
    rotation, translation = node_motions(graph, vertices, moved)
    np.testing.assert_allclose(rotation, np.tile(turn, (20, 1, 1)), atol=1e-6)
    np.testing.assert_allclose(deform(graph, vertices, rotation, translation), moved, atol=1e-6)


def test_steps_reach_a_rigid_target_at_no_cost_of_stiffness(scene):
    vertices, graph = scene
    turn = exp(np.array([0.1, 0.5, -0.2]))
    goal = vertices @ turn.T + (0.1, 0.05, -0.2)
    rotation, translation = _rest(graph)
    arms = link_arms(graph, vertices, rotation, rotation)
    pull = np.tile(np.eye(3), (len(vertices), 1, 1))
    for _ in range(8):
        force = goal - deform(graph, vertices, rotation, translation)
        rotation, translation = fit_step(graph, vertices, rotation, translation, arms, pull, force, 10.0)
    np.testing.assert_allclose(deform(graph, vertices, rotation, translation), goal, atol=1e-5)


def test_a_step_solves_the_normal_equations(scene):
    """The step's change of energy matches central differences of the energy itself along random
    directions."""
    vertices, graph = scene
    rng = np.random.default_rng(0)
    rotation = exp(rng.normal(size=(20, 3)) * 0.1)
    translation = rng.normal(size=(20, 3)) * 0.02
    arms = link_arms(graph, vertices, *([np.tile(np.eye(3), (20, 1, 1))] * 2))
    half = rng.normal(size=(len(vertices), 3, 3))
    pull = half @ np.swapaxes(half, 1, 2)
    goal = vertices + rng.normal(size=vertices.shape) * 0.05
    stiffness = 2.0
    weight = stiffness * len(vertices) / len(graph.links)

    def energy(r, t):
        away = goal - deform(graph, vertices, r, t)
        total = np.einsum("vi,vij,vj->", away, pull, away)
        place = graph.places + t
        for side in (0, 1):
            j, k = graph.links[:, side], graph.links[:, 1 - side]
            e = np.einsum("eij,ej->ei", r[j], arms[:, side]) + place[j] - place[k]
            total += weight * (e**2).sum()
        return total

    force = np.einsum("vij,vj->vi", pull, goal - deform(graph, vertices, rotation, translation))
    solved, shifted = fit_step(graph, vertices, rotation, translation, arms, pull, force, stiffness)
    assert energy(solved, shifted) < energy(rotation, translation)
    # at the minimum of the quadratic model a second step from nearby is short
    for _ in range(30):
        force = np.einsum("vij,vj->vi", pull, goal - deform(graph, vertices, solved, shifted))
        solved, shifted = fit_step(graph, vertices, solved, shifted, arms, pull, force, stiffness)
    least = energy(solved, shifted)
    for _ in range(5):
        a, b = rng.normal(size=(2, 20, 3)) * 1e-4
        both = [energy(exp(s * a) @ solved, shifted + s * b) for s in (1, -1)]
        assert (both[0] - both[1]) / 2 == pytest.approx(0, abs=2e-3 * (both[0] + both[1] - 2 * least))
        assert min(both) > least


def test_bending_already_done_has_no_cost(scene):
    vertices, graph = scene
    angle = 1.2 * (vertices[:, 1] - 0.2)
    bent = vertices.copy()
    bent[:, 0] = vertices[:, 0] + 0.4 * np.sin(angle) ** 2
    turned, _ = node_motions(graph, vertices, bent)
    start = graph._replace(places=bent[graph.samples])
    arms = link_arms(graph, vertices, turned, _rest(graph)[0])
    lengths = np.linalg.norm(arms, axis=2)
    true = np.linalg.norm(graph.places[graph.links[:, 0]] - graph.places[graph.links[:, 1]], axis=1)
    assert (lengths <= true[:, None] + 1e-9).all()
    assert (lengths > 0.85 * true[:, None]).all()
    np.testing.assert_allclose(arms[:, 0], -arms[:, 1])
    assert start.places.shape == (20, 3)


def _pulled_apart(scene, slip):
    """How far the upper half of a body comes short of a goal 0.5 m above it, the lower half held."""
    vertices, graph = scene
    goal = vertices + np.outer(vertices[:, 1] > 1.0, (0, 0.5, 0))
    rotation, translation = _rest(graph)
    arms = link_arms(graph, vertices, rotation, rotation)
    pull = np.tile(np.eye(3), (len(vertices), 1, 1))
    # it slips a little at a time, as from frame to frame
    for share in np.linspace(0.1, 1, 10):
        target = vertices + share * (goal - vertices)
        for _ in range(4):
            force = target - deform(graph, vertices, rotation, translation)
            rotation, translation = fit_step(
                graph, vertices, rotation, translation, arms, pull, force, 0.2, slip
            )
    away = np.linalg.norm(deform(graph, vertices, rotation, translation) - goal, axis=1)
    return away[vertices[:, 1] > 1.4].mean()


def test_links_that_are_stretched_too_far_let_go(scene):
    firm, loose = _pulled_apart(scene, np.inf), _pulled_apart(scene, 0.3)
    assert loose < firm / 2


def test_links_that_are_hardly_stretched_hold(scene):
    assert _pulled_apart(scene, 1e3) == pytest.approx(_pulled_apart(scene, np.inf), rel=1e-3)
