import numpy as np
import pytest
import trimesh

from reperform.nodes.blend.nonlinear import nonlinear
from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.kernels.rotation import exp
from reperform.nodes.products.mesh import MeshSequence


def _swinging(angle: float) -> MeshSequence:
    """A slab that swings about its end; `angle` is how far (radians)."""
    box = trimesh.creation.box(extents=[0.2, 1.0, 0.12]).subdivide().subdivide()
    vertices = np.asarray(box.vertices) - [0.05, 0.5, 0.0]
    frames = [vertices @ exp(np.array([0.1, 0.0, 1.0]) * angle * k / 6).T + [0.0, 1.0, 0.0] for k in range(7)]
    faces = np.asarray(box.faces, np.int32)
    return MeshSequence(np.array(frames, np.float32), faces, np.asarray(25.0, np.float32))


def test_both_ends_are_the_takes() -> None:
    takes = _swinging(0.5), _swinging(2.2)
    for weight, take in zip((0.0, 1.0), takes, strict=True):
        np.testing.assert_allclose(
            nonlinear(takes, weight=weight, place=False).vertices, take.vertices, atol=1e-6
        )


def test_limbs_turn_and_keep_their_volume() -> None:
    takes = _swinging(0.5), _swinging(2.2)
    blend = nonlinear(takes, weight=0.5, place=False)
    volumes = volume(blend.vertices, blend.faces)
    np.testing.assert_allclose(volumes, volume(takes[0].vertices[:1], takes[0].faces)[0], rtol=1e-4)
    # up to where the centroid is: the swing half way between the two
    middle, truth = (v - v.mean(axis=1, keepdims=True) for v in (blend.vertices, _swinging(1.35).vertices))
    np.testing.assert_allclose(middle, truth, atol=1e-4)


def test_different_topology_is_refused() -> None:
    a, b = _swinging(0.5), _swinging(1.0)
    with pytest.raises(ValueError, match="one topology"):
        nonlinear((a, b._replace(faces=b.faces[::-1])))
