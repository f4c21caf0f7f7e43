"""Errors of tables between two spaces of a bending tube, one with one parameter, one with two."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.transition_similarity import transition_similarity
from reperform.nodes.products.parametric import ParametricSpace

POSES = 8


def bending(angles: np.ndarray, control: np.ndarray, cells: list[list[int]], lean: float) -> ParametricSpace:
    """An uneven rod whose upper half bends by each angle times a wave over the poses."""
    mesh = trimesh.creation.icosphere(subdivisions=1)
    rest, faces = np.asarray(mesh.vertices) * [0.2, 0.9, 0.12], np.asarray(mesh.faces, np.int32)
    rest[:, 0] += 0.15 * rest[:, 1] ** 2
    wave = np.sin(2 * np.pi * np.arange(POSES) / POSES + lean)
    turn = np.multiply.outer(angles, wave)[..., None] * np.clip(rest[:, 1], 0, None)
    x, y, z = rest.T
    vertices = np.stack(
        [x + 0 * turn, np.cos(turn) * y - np.sin(turn) * z, np.sin(turn) * y + np.cos(turn) * z + lean * y],
        -1,
    )
    n, d = control.shape
    return ParametricSpace(
        np.array([f"take{k}" for k in range(n)]), vertices.astype(np.float32), np.full((n, POSES, 3), [0, 0.02, 0.01]),
        np.full((n, POSES), 0.1), np.zeros((n, POSES, 2), bool), np.zeros((n, POSES)), np.asarray(True),
        np.array(["speed", "turning"][:d]), np.array(["m/s", "rad/s"][:d]), control, control, np.array(cells, np.int32),
        np.eye(n), control, np.zeros(d), np.ones(d), np.full(d, 2, np.int32), np.zeros((2**d, d)), np.zeros((d, 2)),
        np.array([-1, -1], np.int32), np.array([-1, -1], np.int32), np.asarray(False), faces, np.asarray(25, np.float32),
    )  # fmt: skip


def test_errors_fall_with_subdivisions_and_the_bound_holds():
    spaces = {
        "walk": bending(np.array([0.2, 1.3]), np.array([[0.0], [1.0]]), [[0, 1]], 0.0),
        "jump": bending(
            np.array([0.0, 0.9, 0.5]), np.array([[0.0, 0.1], [1.0, 0.0], [0.4, 1.0]]), [[0, 1, 2]], 0.4
        ),
    }
    measured = transition_similarity(spaces, depth=3)
    value = dict(zip(measured.name.tolist(), measured.value[0].tolist(), strict=True))
    assert value["violations"] == 0
    for kind in ("", "eq 4.5 "):
        errors = [value[f"{kind}average error {n}"] for n in (0, 1, 2)]
        assert errors[2] < 0.5 * errors[1] < 0.25 * errors[0]
    assert value["maximum error 2"] >= value["average error 2"]
    # the sum of eq 4.5 lies above the distance of the played meshes by the variances
    assert value["eq 4.5 average error 1"] > value["average error 1"] > 0
    assert value["speedup"] == pytest.approx(value["exact"] / value["online 2"])
    assert value["transitions"] > 50
