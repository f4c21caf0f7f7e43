import numpy as np

from reperform.nodes.kernels.transitions import find_transitions, windowed_cost


def test_the_window_is_a_normalised_triangle() -> None:
    distance = np.random.default_rng(0).uniform(size=(11, 13))
    half = 3
    cost = windowed_cost(distance, half)
    m, n = 5, 7
    alpha = (np.arange(-half, half + 1) + half) / (2 * half)
    weight = np.minimum(1 - alpha, alpha)
    window = distance[m + np.arange(-half, half + 1), n + np.arange(-half, half + 1)]
    np.testing.assert_allclose(cost[m, n], weight @ window / weight.sum())
    assert np.isinf(cost[2]).all()
    assert np.isinf(cost[:, -3:]).all()


def test_it_finds_what_trying_everything_finds() -> None:
    random = np.random.default_rng(4)
    distance = random.uniform(size=(30, 24))
    found = find_transitions(distance, 3, 2, 6)
    # every local minimum at the shortest length, with the best of all lengths that fit
    expected = []
    coarse = windowed_cost(distance, 2)
    for m in range(2, 28):
        for n in range(2, 22):
            around = coarse[max(m - 1, 0) : m + 2, max(n - 1, 0) : n + 2]
            if coarse[m, n] == around.min():
                lengths = [windowed_cost(distance, half)[m, n] for half in range(2, 7)]
                expected.append((min(lengths), m, n, 2 + int(np.argmin(lengths))))
    expected.sort()
    assert [tuple(row) for row in zip(found.m, found.n, found.length, strict=True)] == [
        row[1:] for row in expected[:3]
    ]
    np.testing.assert_allclose(found.cost, [row[0] for row in expected[:3]])


def test_a_long_quiet_valley_is_not_beaten_by_its_deepest_point() -> None:
    # two candidates with the same centre; only one stays similar along its window
    distance = np.ones((40, 40))
    for k in range(-8, 9):
        distance[12 + k, 12 + k] = 0.2
        distance[27 + k, 12 + k] = 0.1 + 0.1 * abs(k)
    found = find_transitions(distance, 2, 5, 8, spread=3)
    assert (found.m[0], found.n[0]) != (27, 12)
    assert found.cost[0] < 0.25


def test_within_one_take_the_diagonal_is_no_transition() -> None:
    phase = np.arange(60) * 2 * np.pi / 20
    points = np.stack([np.cos(phase), np.sin(phase)], axis=1)
    distance = np.linalg.norm(points[:, None] - points[None], axis=2) + 1e-3 * np.arange(60)[:, None]
    found = find_transitions(distance, 4, 3, 8, apart=10, spread=3)
    assert len(found.m) > 0
    assert set(abs(found.m - found.n)) <= {20, 40}


def test_takes_shorter_than_a_window_have_none() -> None:
    assert len(find_transitions(np.zeros((3, 50)), 4, 3, 8).m) == 0
