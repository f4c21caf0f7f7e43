import numpy as np
import pytest

from reperform.nodes.kernels.decimate import is_closed
from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.products.mesh import Occupancy
from reperform.nodes.surface.isosurface import isosurface

RADII = np.array([0.21, 0.33, 0.14])


def ellipsoid(voxel: float = 0.01) -> Occupancy:
    """A soft ellipsoid, off the grid's middle, and a speck beside it."""
    grid = np.stack(np.meshgrid(*(voxel * np.arange(n) for n in (60, 84, 52)), indexing="ij"), axis=-1)
    place = (grid - [0.26, 0.41, 0.23]) / RADII
    distance = (np.linalg.norm(place, axis=-1) - 1) * RADII.min()
    field = np.clip(0.5 - distance / (2 * voxel), 0, 1)
    field[52:55, 4:8, 5:7] = 1
    origin = np.array([-1.0, 0.5, 2.0], np.float32)
    return Occupancy(field.astype(np.float32), origin, np.float32(voxel), np.float32(25))


@pytest.mark.parametrize("vertices", [0, 3000, 400])
def test_the_surface_is_the_ellipsoid(vertices: int) -> None:
    surface = isosurface(ellipsoid(), vertices=vertices)
    assert surface.vertices.dtype == np.float32
    assert surface.faces.dtype == np.int32
    place = (surface.vertices - np.array([-0.74, 0.91, 2.23])) / RADII
    assert np.abs(np.linalg.norm(place, axis=1) - 1).max() < 0.03
    assert volume(surface.vertices.astype(float), surface.faces) == pytest.approx(
        4 / 3 * np.pi * RADII.prod(), rel=0.01
    )


@pytest.mark.parametrize("vertices", [3000, 500, 60])
def test_it_is_closed_of_genus_zero_and_within_budget(vertices: int) -> None:
    surface = isosurface(ellipsoid(), vertices=vertices)
    assert len(surface.vertices) == vertices
    assert is_closed(surface.faces)
    assert len(surface.faces) == 2 * vertices - 4
    a, b, c = (surface.vertices[surface.faces[:, k]] for k in range(3))
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-6


def test_an_empty_field_is_refused_with_the_largest_probability() -> None:
    field = ellipsoid()
    with pytest.raises(ValueError, match=r"more probable than level 0.5, the largest is 0.3"):
        isosurface(field._replace(probability=0.3 * field.probability))


def test_the_same_field_gives_the_same_bits() -> None:
    first, second = isosurface(ellipsoid(), vertices=700), isosurface(ellipsoid(), vertices=700)
    assert np.array_equal(first.vertices, second.vertices)
    assert np.array_equal(first.faces, second.faces)
