import numpy as np

from reperform.nodes.evaluate.frame_surfaces import frame_surfaces
from reperform.nodes.products.mesh import MeshSequence


def test_a_frame_keeps_its_vertices_and_gets_the_faces():
    vertices = np.random.default_rng(0).normal(size=(4, 3)).astype(np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    out = frame_surfaces(MeshSequence(vertices, faces, np.float32(25)))
    np.testing.assert_array_equal(out.vertices, vertices)
    np.testing.assert_array_equal(out.faces, faces)
    assert float(out.fps) == 25.0
