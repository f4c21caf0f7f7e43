import numpy as np
import trimesh

from reperform.nodes.kernels.correspondence_error import attach, correspondence_error, swap_rate


def _legs():
    """Two upright rods, left at x = 0.1, right at x = -0.1: vertices, faces, side, limb."""
    left = trimesh.creation.cylinder(0.05, 0.8, sections=8).subdivide()
    left.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    right = left.copy()
    left.apply_translation((0.1, 0.4, 0))
    right.apply_translation((-0.1, 0.4, 0))
    side = np.r_[np.ones(len(left.vertices)), -np.ones(len(right.vertices))]
    both = trimesh.util.concatenate([left, right])
    return both.vertices, both.faces.astype(np.int32), side, np.zeros(len(side), int)


def test_error_is_the_shift_and_nothing_for_the_truth():
    vertices, faces, _, _ = _legs()
    truth = np.stack([vertices, vertices + (0, 0, 0.3)])
    points = attach(vertices[::2], vertices, faces)
    aligned = truth[:, ::2].copy()
    np.testing.assert_allclose(correspondence_error(aligned, points, truth, faces), 0, atol=1e-12)
    aligned[1] += (0.03, 0.04, 0)
    error = correspondence_error(aligned, points, truth, faces)
    np.testing.assert_allclose(error[1], 0.05)


def test_a_surface_on_the_other_leg_is_swapped_though_it_lies_on_the_truth():
    vertices, faces, side, limb = _legs()
    points = attach(vertices, vertices, faces)
    crossed = vertices * (-1, 1, 1)
    rate = swap_rate(np.stack([vertices, crossed]), points, np.stack([vertices] * 2), faces, side, limb)
    np.testing.assert_allclose(rate, [0, 1])


def test_sliding_along_the_own_leg_or_beside_it_is_no_swap():
    vertices, faces, side, limb = _legs()
    points = attach(vertices, vertices, faces)
    aligned = np.stack([vertices + (0, 0.15, 0), vertices + (0, 0, 0.04)])
    rate = swap_rate(aligned, points, np.stack([vertices] * 2), faces, side, limb)
    np.testing.assert_allclose(rate, 0)


def test_without_sides_nothing_swaps():
    vertices, faces, side, limb = _legs()
    points = attach(vertices, vertices, faces)
    assert swap_rate(vertices[None], points, vertices[None], faces, 0 * side, limb) == 0
