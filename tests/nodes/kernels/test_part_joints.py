import numpy as np

from reperform.nodes.kernels.part_joints import centre_map, part_tree, ring_map

# a strip of triangles: vertices 0 .. 8 zigzag, parts in blocks along it; vertex 9 is loose
FACES = np.array([[k, k + 1, k + 2] if k % 2 else [k + 1, k, k + 2] for k in range(7)], np.int32)
LABEL = np.array([2, 2, 2, 0, 0, 0, 1, 1, -1, 3])


def test_parts_hang_on_each_other_as_they_touch() -> None:
    order, parent = part_tree(LABEL, FACES, 4, 0)
    assert order.tolist() == [0, 1, 2]
    assert parent.tolist() == [-1, 0, 0, -1]
    order, parent = part_tree(LABEL, FACES, 4, 2)
    assert order.tolist() == [2, 0, 1]
    assert parent.tolist() == [2, 0, -1, -1]


def test_centres_weigh_by_area_and_rings_are_where_parts_meet() -> None:
    areas = np.arange(1.0, 11.0)
    centre = centre_map(LABEL, 4, areas).toarray()
    np.testing.assert_allclose(centre[0], [0, 0, 0, 4 / 15, 5 / 15, 6 / 15, 0, 0, 0, 0])
    ring = ring_map(LABEL, FACES, np.array([-1, 0, 0, -1])).toarray()
    np.testing.assert_allclose(ring[1], [0, 0, 0, 0, 0.25, 0.25, 0.25, 0.25, 0, 0])
    np.testing.assert_allclose(ring[2], [0, 0.25, 0.25, 0.25, 0.25, 0, 0, 0, 0, 0])
    assert (ring[[0, 3]] == 0).all()
