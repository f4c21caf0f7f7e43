import numpy as np
import trimesh

from reperform.nodes.kernels.crowd_frame import bounds_into, evaluate_crowd, normals_into
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.hybrid_blend import evaluate_between, new_scratch
from reperform.nodes.kernels.hybrid_build import build_hybrid
from reperform.nodes.kernels.mesh_geometry import vertex_normals


def test_every_character_is_its_own_blend_placed_on_the_ground():
    random = np.random.default_rng(6)
    inputs = random.normal(size=(3, 4, 40, 3)).astype(np.float32)
    lift = random.normal(size=(4, 40, 3)) * 0.2

    def exact(weights):
        return np.einsum("n,ntvk->tvk", weights, inputs) + (1 - float(weights @ weights)) * lift

    fields = build_hybrid(inputs, exact, 0.0, 1, 1).fields
    times, weights = random.uniform(0, 3, 5), random.dirichlet(np.ones(3), 5)
    places, out, scratch = random.normal(size=(5, 3)), np.empty((5, 40, 3), np.float32), new_scratch(fields)
    evaluate_crowd(fields, times, weights, places, out, scratch)
    own = np.empty((40, 3), np.float32)
    for k in range(5):
        evaluate_between(fields, times[k], weights[k], own, scratch)
        placed = apply(own, Placement(float(places[k, 2]), places[k, :2]))
        np.testing.assert_allclose(out[k], placed, atol=1e-5)


def test_normals_and_bounds_are_those_of_the_mesh():
    ball = trimesh.creation.icosphere(subdivisions=2)
    vertices = (np.asarray(ball.vertices) * [0.3, 0.8, 0.5] + [1.0, -2.0, 0.4]).astype(np.float32)
    vertices = np.concatenate([vertices, [[5.0, 5.0, 5.0]]]).astype(np.float32)
    faces = np.asarray(ball.faces, np.int32)
    normals, bounds = np.empty_like(vertices), np.empty((2, 3), np.float32)
    normals_into(vertices, faces, normals)
    np.testing.assert_allclose(normals, vertex_normals(vertices, faces), atol=1e-5)
    bounds_into(vertices, bounds)
    np.testing.assert_array_equal(bounds, [vertices.min(0), vertices.max(0)])
