import numpy as np
import pytest

from reperform.nodes.kernels.decimate import decimate, is_closed
from reperform.nodes.kernels.flying_edges import isosurface
from reperform.nodes.kernels.mesh_geometry import volume


def ring_with_two_holes() -> tuple[np.ndarray, np.ndarray]:
    """A slab with two tunnels, genus 2, by marching a soft field."""
    x, y, z = np.meshgrid(np.arange(44.0), np.arange(30.0), np.arange(12.0), indexing="ij")
    slab = np.minimum.reduce([x - 3.3, 40.2 - x, y - 3.1, 26.4 - y, z - 2.2, 8.7 - z])
    for cx, cy, r in ((12.3, 14.1, 4.2), (29.6, 15.8, 5.3)):
        slab = np.minimum(slab, np.hypot(x - cx, y - cy) - r)
    return isosurface(np.clip(0.5 + 0.4 * slab, 0, 1).astype(np.float32), 0.5)


@pytest.mark.parametrize("budget", [900, 200, 60])
def test_handles_volume_and_closedness_stay(budget: int) -> None:
    vertices, faces = ring_with_two_holes()
    points, triangles = decimate(vertices, faces, budget)
    assert len(points) == budget
    assert is_closed(triangles)
    assert len(points) - len(triangles) // 2 == -2  # V - E + F of genus 2
    assert volume(points, triangles) == pytest.approx(volume(vertices, faces), rel=0.03)
    assert volume(points, triangles) > 0


def test_a_mesh_within_its_budget_is_left_alone() -> None:
    vertices, faces = ring_with_two_holes()
    points, triangles = decimate(vertices, faces, len(vertices))
    assert np.array_equal(points, vertices)
    assert np.array_equal(triangles, faces)
