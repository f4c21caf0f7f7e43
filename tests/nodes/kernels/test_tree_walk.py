"""A tree is walked parents first, branches side by side, and a failure ends the walk."""

import threading

import numpy as np
import pytest

from reperform.nodes.kernels.tree_walk import walk_tree


def _random_tree(count, seed):
    random = np.random.default_rng(seed)
    names = random.permutation(count)
    parent = np.full(count, -1)
    parent[names[0]] = names[0]
    for k in range(1, count):
        parent[names[k]] = names[random.integers(0, k)]
    return parent, names


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_every_node_once_and_after_its_parent(threads):
    parent, order = _random_tree(60, 3)
    depth = {}

    def visit(k):
        depth[k] = 0 if parent[k] == k else depth[parent[k]] + 1

    walk_tree(parent, order, visit, threads)
    expected = {}
    for k in map(int, order):
        expected[k] = 0 if parent[k] == k else expected[parent[k]] + 1
    assert depth == expected


def test_two_branches_run_side_by_side():
    both = threading.Barrier(2, timeout=20)
    walk_tree([0, 0, 0], [0, 1, 2], lambda k: both.wait() if k else None, 2)


def test_the_longest_branch_goes_first():
    seen = []
    walk_tree([0, 0, 0, 2, 3, 0], [0, 1, 2, 3, 4, 5], seen.append, 1)
    assert seen == [0, 2, 3, 1, 4, 5]


def test_a_failure_ends_the_walk():
    seen = []

    def visit(k):
        seen.append(k)
        if k == 2:
            raise ValueError("no picture")

    with pytest.raises(ValueError, match="no picture"):
        walk_tree([0, 0, 1, 2, 3], [0, 1, 2, 3, 4], visit, 2)
    assert seen == [0, 1, 2]
