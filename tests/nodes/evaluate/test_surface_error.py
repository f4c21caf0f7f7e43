"""Surface errors of ellipsoids and half figures."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.surface_error import surface_error
from reperform.nodes.products.mesh import MeshSequence, Surfaces

BALL = trimesh.creation.icosphere(4)
FACES = BALL.faces.astype(np.int32)
FPS = np.float32(25)


def at(scale, shift=(0.3, 0.9, -0.2)) -> np.ndarray:
    return (BALL.vertices * scale + np.array(shift)).astype(np.float32)


def test_concentric_spheres():
    found = surface_error(MeshSequence(at(0.4), FACES, FPS), Surfaces(at(0.43), FACES, FPS))
    assert found.value == pytest.approx([0.03] * 3, rel=0.02)


def test_what_is_missing_shows_in_one_direction():
    upper = FACES[BALL.triangles_center[:, 1] > 0]
    found = surface_error(MeshSequence(at(0.4), FACES, FPS), Surfaces(at(0.4), upper, FPS))
    error, excess, missing = found.value
    assert excess == pytest.approx(0, abs=1e-6)
    assert missing > 0.05
    assert error == pytest.approx(missing / 2)


def test_it_does_not_depend_on_order_of_vertices():
    order = np.random.default_rng(2).permutation(len(BALL.vertices))
    place = np.argsort(order)
    truth = MeshSequence(at([0.4, 0.7, 0.3]), FACES, FPS)
    built = at([0.42, 0.69, 0.33], (0.31, 0.88, -0.2))
    same = surface_error(truth, Surfaces(built, FACES, FPS)).value
    shuffled = surface_error(truth, mesh=MeshSequence(built[order], place[FACES].astype(np.int32), FPS)).value
    assert shuffled == pytest.approx(same, rel=1e-9)
