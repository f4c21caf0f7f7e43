"""Work along a tree on several threads: a node's turn comes once its parent is done."""

from __future__ import annotations

import heapq
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np


def walk_tree(
    parent: Sequence[int] | np.ndarray,
    order: Sequence[int] | np.ndarray,
    visit: Callable[[int], None],
    threads: int = 2,
) -> None:
    """Call visit(k) for every node of `order` (parents before children) after visit(parent[k]) has returned.

    The first of `order` is the root. Nodes with most generations below them go first, since they hold up most; so
    branches run side by side. What `visit` makes of a node must follow from its ancestors only: then the result does
    not depend on the number of threads.
    Raises what the first failing visit raised; no visit begins after that.
    Source: Hu 1961, Operations Research 9(6) (highest level first).
    """
    children: dict[int, list[int]] = {int(k): [] for k in order}
    height = dict.fromkeys(children, 0)
    for k in map(int, reversed(order[1:])):
        up = int(parent[k])
        children[up].append(k)
        height[up] = max(height[up], height[k] + 1)
    ready = [(-height[int(order[0])], int(order[0]))]
    left = len(children)
    failed: list[BaseException] = []
    change = threading.Condition()

    def take() -> int | None:
        with change:
            change.wait_for(lambda: ready or not left or failed)
            return heapq.heappop(ready)[1] if ready and not failed else None

    def work() -> None:
        nonlocal left
        while (k := take()) is not None:
            try:
                visit(k)
            except BaseException as error:  # raised again where walk_tree was called
                failed.append(error)
            with change:
                left -= 1
                for child in children[k]:
                    heapq.heappush(ready, (-height[child], child))
                change.notify_all()

    with ThreadPoolExecutor(threads, thread_name_prefix="branch") as pool:
        for worker in [pool.submit(work) for _ in range(threads)]:
            worker.result()
    if failed:
        raise failed[0]
