import numpy as np

from reperform.nodes.kernels.take_chains import chain_takes


def test_takes_run_in_time_and_join_by_the_shortest_edge():
    # rows 0..3 of take 0, 4..6 of take 1, 7 of take 2
    take = np.array([0, 0, 0, 0, 1, 1, 1, 2])
    frame = np.array([0, 1, 2, 3, 0, 1, 2, 0])
    parent = np.array([0, 0, 1, 4, 5, 1, 3, 6])
    distance = np.array([0, 1, 1, 0.5, 1, 0.3, 0.4, 2.0])
    chained, order = chain_takes(take, frame, parent, distance, 2)
    np.testing.assert_array_equal(chained, [1, 2, 2, 2, 5, 1, 5, 6])
    np.testing.assert_array_equal(order, [2, 3, 1, 0, 5, 6, 4, 7])


def test_every_row_follows_its_parent_whatever_the_root():
    rng = np.random.default_rng(4)
    take = np.repeat([0, 1, 2], [5, 3, 7])
    frame = np.concatenate([rng.permutation(n) for n in (5, 3, 7)])
    parent = np.array([0, *(rng.integers(0, k) for k in range(1, 15))])
    for root in range(15):
        chained, order = chain_takes(take, frame, parent, rng.random(15), root)
        assert sorted(order) == list(range(15))
        assert order[0] == root == chained[root]
        place = np.argsort(order)
        below = np.arange(15) != root
        assert (place[chained[below]] < place[below]).all()
        assert (take[chained] != take).sum() == 2
