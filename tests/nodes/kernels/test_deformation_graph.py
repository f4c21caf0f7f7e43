import numpy as np
import trimesh

from reperform.nodes.kernels.deformation_graph import carried, deformation_graph, farthest_samples


def _rod():
    rod = trimesh.creation.capsule(1.0, 0.15, count=(12, 12)).subdivide().subdivide()
    return rod.vertices * (1, 1.2, 1), rod.faces.astype(np.int32)


def test_samples_are_spread_and_nested():
    vertices, faces = _rod()
    samples, distances = farthest_samples(vertices, faces, 20)
    fewer, _ = farthest_samples(vertices, faces, 7)
    np.testing.assert_array_equal(samples[:7], fewer)
    assert len(set(samples)) == 20
    np.testing.assert_allclose(distances[np.arange(20), samples], 0)
    gaps = distances[:, samples] + 10 * np.eye(20)
    assert gaps.min() > 0.5 * distances.min(axis=0).max()
    straight = np.linalg.norm(vertices[samples[3]] - vertices, axis=1)
    assert (distances[3] >= straight - 1e-9).all()


def test_weights_are_a_partition_of_unity_and_links_fit_the_band():
    vertices, faces = _rod()
    samples, distances = farthest_samples(vertices, faces, 40)
    graph = deformation_graph(vertices, samples, distances, 40)
    np.testing.assert_allclose(graph.weight.sum(axis=1), 1)
    assert (graph.weight >= 0).all()
    np.testing.assert_allclose(graph.places, vertices[graph.samples])
    assert sorted(graph.samples) == sorted(samples)
    assert (graph.links[:, 0] < graph.links[:, 1]).all()
    assert (graph.links[:, 1] - graph.links[:, 0]).max() == graph.bandwidth < 25


def test_parts_that_only_touch_do_not_move_each_other():
    vertices, faces = _rod()
    both = np.concatenate([vertices, vertices + (0.31, 0, 0)])
    samples, distances = farthest_samples(both, np.concatenate([faces, faces + len(vertices)]), 16)
    graph = deformation_graph(both, samples, distances, 16)
    other = (graph.samples[graph.influence] < len(vertices)) != (np.arange(len(both)) < len(vertices))[
        :, None
    ]
    np.testing.assert_allclose(graph.weight[other], 0, atol=1e-12)


def test_one_node_moves_all_and_carrying_moves_the_places():
    vertices, faces = _rod()
    samples, distances = farthest_samples(vertices, faces, 3)
    graph = deformation_graph(vertices, samples, distances, 1)
    np.testing.assert_allclose(graph.weight[:, 0], 1)
    assert len(graph.links) == graph.bandwidth == 0
    np.testing.assert_allclose(carried(graph, vertices + 1).places, graph.places + 1)
