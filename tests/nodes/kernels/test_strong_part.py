import numpy as np

from reperform.nodes.kernels.strong_part import follows, strong_part


def _columns(rows: list[tuple[int, int, int, int]]) -> tuple[np.ndarray, ...]:
    return tuple(np.array(column) for column in zip(*rows, strict=True))


def test_a_dead_end_and_a_way_in_are_left_out() -> None:
    # (source, target, departure, arrival): 0 -> 1 and 1 -> 0 loop; 0 -> 2 dies; 3 -> 0 is never come back to
    columns = _columns([(0, 1, 20, 3), (1, 0, 15, 5), (0, 2, 18, 4), (3, 0, 9, 2)])
    np.testing.assert_array_equal(strong_part(*columns), [True, True, False, False])


def test_a_transition_that_leaves_before_it_arrives_cannot_follow() -> None:
    columns = _columns([(0, 1, 20, 16), (1, 0, 15, 5)])
    assert not follows(*columns)[0, 1]
    assert not strong_part(*columns).any()


def test_the_part_that_plays_most_wins() -> None:
    columns = _columns([(0, 0, 20, 15), (1, 1, 50, 10)])
    np.testing.assert_array_equal(strong_part(*columns), [False, True])


def test_a_random_walk_never_dies() -> None:
    random = np.random.default_rng(7)
    rows = [tuple(random.integers([5, 5, 40, 40])) for _ in range(60)]
    source, target, departure, arrival = _columns(rows)
    core = strong_part(source, target, departure, arrival)
    after = follows(source, target, departure, arrival)[np.ix_(core, core)]
    assert core.sum() > 10
    here = 0
    for _ in range(2000):
        choices = np.flatnonzero(after[here])
        assert len(choices)
        here = int(random.choice(choices))


def test_no_transitions_no_part() -> None:
    none = np.zeros(0, int)
    assert strong_part(none, none, none, none).shape == (0,)
