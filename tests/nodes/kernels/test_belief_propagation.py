import itertools

import numpy as np
import scipy.sparse

from reperform.nodes.kernels.belief_propagation import beliefs, neighbour_lists

LABELS, SLOPE, CAP = 4, 0.3, 0.7
# a tree: on trees the min-marginals are exact
EDGES = [(0, 1), (1, 2), (1, 3), (3, 4)]


def test_on_a_tree_they_are_the_min_marginals() -> None:
    random = np.random.default_rng(3)
    cost = random.uniform(0, 1, (5, LABELS)).astype(np.float32)
    rows, columns = np.array(EDGES + [edge[::-1] for edge in EDGES]).T
    graph = neighbour_lists(scipy.sparse.csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(5, 5)))
    shift = {edge: random.uniform(-1.4, 1.4) for edge in EDGES}
    offset = np.array([shift[v, w] if (v, w) in shift else -shift[w, v] for v, w in half_edges(graph)])
    found = beliefs(cost, graph, offset, SLOPE, CAP, 10)
    truth = np.full((5, LABELS), np.inf)
    for labels in itertools.product(range(LABELS), repeat=5):
        energy = sum(cost[v, label] for v, label in enumerate(labels))
        energy += sum(min(SLOPE * abs(labels[w] - labels[v] - shift[v, w]), CAP) for v, w in EDGES)
        for v, label in enumerate(labels):
            truth[v, label] = min(truth[v, label], energy)
    # messages are free up to a constant; a label between two costs less than either by the shape of the line
    found = found - found.min(axis=1, keepdims=True)
    truth = truth - truth.min(axis=1, keepdims=True)
    assert (found.argmin(axis=1) == truth.argmin(axis=1)).all()
    np.testing.assert_allclose(found, truth, atol=1e-5)


def half_edges(graph: tuple[np.ndarray, np.ndarray, np.ndarray]) -> list[tuple[int, int]]:
    start, towards, opposite = graph
    owner = np.repeat(np.arange(len(start) - 1), np.diff(start))
    assert (towards[opposite] == owner).all()
    return [(int(v), int(w)) for v, w in zip(owner, towards, strict=True)]
