import numpy as np

from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.local_minima import local_minima
from reperform.nodes.motion_graph.pose_edges import complete_digraph


def test_edges_are_next_frames_and_minima_among_eight_neighbours(pose_pairs):
    graph = local_minima(pose_pairs)
    cost = complete_digraph(pose_pairs, "test").blended
    ends = np.cumsum(graph.frames)
    take = np.searchsorted(ends, np.arange(len(cost)), side="right")
    for i, j in zip(graph.source.tolist(), graph.target.tolist(), strict=True):
        near = [
            cost[r, c]
            for r in range(max(i - 1, 0), min(i + 2, len(cost)))
            for c in range(max(j - 1, 0), min(j + 2, len(cost)))
            if take[r] == take[i] and take[c] == take[j]
        ]
        assert (take[i] == take[j] and j == i + 1) or cost[i, j] <= min(near)
    assert len({*zip(graph.source.tolist(), graph.target.tolist(), strict=True)}) == len(graph.source)
    assert all((graph.source == p).any() for p in range(len(cost)) if p + 1 not in ends)


def test_no_path_is_cheaper_than_in_the_essential_graph(pose_pairs):
    best, other = essential(pose_pairs), local_minima(pose_pairs)
    assert (best.distance <= other.distance * (1 + 1e-9)).all()
    assert (best.distance < other.distance * (1 - 1e-6)).any()
