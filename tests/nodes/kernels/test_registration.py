import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.registration import (
    Pull,
    Stage,
    make_template,
    misfit,
    predict,
    register,
    register_rigidly,
)
from reperform.nodes.kernels.rotation import exp
from reperform.nodes.kernels.surface_pull import fit_target

PULL = Pull(0.1, 0.3, 0.05)


def _figure(subdivisions, bend):
    """A bent sausage with a thorn, from its own tessellation: (vertices, faces) and where any rest point
    goes."""
    mesh = trimesh.creation.icosphere(subdivisions)
    rest = mesh.vertices * (0.15, 0.6, 0.12)
    rest[:, 0] += 0.15 * np.exp(-40 * ((mesh.vertices - (0.8, 0.6, 0)) ** 2).sum(1))
    return _bend(rest, bend), mesh.faces.astype(np.int32)


def _bend(rest, angle):
    turn = angle * np.clip(rest[:, 1] / 0.6, 0, 1)
    up = rest[:, 1]
    return np.column_stack(
        [
            rest[:, 0] * np.cos(turn) + up * np.sin(turn),
            up * np.cos(turn) - rest[:, 0] * np.sin(turn),
            rest[:, 2],
        ]
    )


@pytest.fixture(scope="module")
def template():
    return make_template(*_figure(3, 0.0), 12, 3)


def _stages(template):
    return tuple(
        Stage(g, s, k, 6) for g, s, k in zip(template.graphs, (0.2, 0.1, 0.05), (1, 0.5, 0.2), strict=True)
    )


def test_follows_a_bend_across_topologies(template):
    target = fit_target(*_figure(4, 0.35), 0.1)
    moved = register(template, template.vertices, target, _stages(template), PULL)
    truth = _bend(template.vertices, 0.35)
    before = np.linalg.norm(template.vertices - truth, axis=1)
    after = np.linalg.norm(moved - truth, axis=1)
    assert before.mean() > 0.03
    assert after.mean() < 0.4 * before.mean()


def test_a_perfect_start_stays(template):
    target = fit_target(*_figure(3, 0.0), 0.1)
    moved = register(template, template.vertices, target, _stages(template), PULL)
    np.testing.assert_allclose(moved, template.vertices, atol=1e-4)


def test_same_answer_twice_and_inputs_kept(template):
    target = fit_target(*_figure(4, 0.2), 0.1)
    start = template.vertices.copy()
    start.setflags(write=False)
    first = register(template, start, target, _stages(template), PULL)
    np.testing.assert_array_equal(first, register(template, start, target, _stages(template), PULL))


def test_rigid_registration_undoes_a_motion(template):
    target = fit_target(*_figure(4, 0.0), 0.1)
    displaced = template.vertices @ exp(np.array([0.05, 0.2, -0.08])).T + (0.04, -0.03, 0.02)
    moved, cost = register_rigidly(template, displaced, target, 0.2, 25, PULL)
    assert np.linalg.norm(moved - template.vertices, axis=1).mean() < 0.01
    assert cost < misfit(template, displaced, target, 0.2, PULL)


def test_prediction_goes_on_with_a_rigid_motion(template):
    step = exp(np.array([0.1, 0.3, 0.05]))
    shift = np.array([0.1, 0.02, -0.05])
    once = template.vertices @ step.T + shift
    twice = once @ step.T + shift
    np.testing.assert_allclose(predict(template, once, template.vertices, 1.0), twice, atol=1e-5)
    np.testing.assert_allclose(predict(template, once, once, 1.0), once, atol=1e-6)
