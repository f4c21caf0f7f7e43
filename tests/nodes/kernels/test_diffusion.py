import numpy as np
import scipy.sparse

from reperform.nodes.kernels.diffusion import diffuse


def test_it_nears_the_least_squares_solution() -> None:
    random = np.random.default_rng(1)
    count = 9
    links = [(k, k + 1) for k in range(count - 1)] + [(0, 5), (2, 7)]
    rows, columns = np.array(links + [link[::-1] for link in links]).T
    adjacency = scipy.sparse.csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(count, count))
    target, weight = random.normal(size=count), random.uniform(0, 2, count)
    weight[3] = 0
    degree = np.asarray(adjacency.sum(axis=1)).ravel()
    system = np.diag(weight + 0.1 + 0.7 * degree) - 0.7 * adjacency.toarray()
    found = diffuse(target, weight, adjacency, smooth=0.7, keep=0.1, rounds=400)
    np.testing.assert_allclose(found, np.linalg.solve(system, weight * target), atol=1e-9)
