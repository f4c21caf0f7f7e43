"""What the essential graph costs to make, as the database grows."""

from __future__ import annotations

import time
import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.pose_transitions import pose_transitions
from reperform.nodes.product import Dataset
from reperform.nodes.products.essential import PoseGraph, PoseTransitions
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.similarity.deformation_gradient import deformation_gradient

Takes = dict[str, MeshSequence]


@node(over="dataset", memory=4.0, threads=2, volatile=True)
def pose_graph_growth(
    meshes: Dataset[MeshSequence],
    *,
    frames: Annotated[
        tuple[int, ...], Param("frame", 2, 100000, "sizes of the databases, takes one after the other")
    ] = (100, 200, 400, 800),
    alpha: Annotated[float, Param("1/frame", 1e-6, 100.0, "what a frame of duration costs")] = 0.01,
) -> Measures:
    """Time and memory from meshes to the essential graph on two threads, for databases of several sizes.

    Similarity, transitions of every ordered pair of takes and the union of shortest paths, as the nodes make them
    with their defaults. Entries per size n: `time n` (s) and `memory n` (B, peak of arrays that are held beyond the
    meshes, in a run of its own); then `time exponent` and `memory exponent`, slopes of their logarithms over that of
    n. nan where the takes have fewer frames than a size.

    Source: definition.
    """
    _make(_first(meshes, 12), alpha)  # compiles
    times, peaks = [], []
    for count in frames:
        taken = _first(meshes, count)
        enough = sum(len(take.vertices) for take in taken.values()) == count
        times.append(_time(taken, alpha) if enough else np.nan)
        peaks.append(_peak(taken, alpha) if enough else np.nan)
    values = [*times, *peaks, _exponent(frames, times), _exponent(frames, peaks)]
    names = [
        *(f"time {n}" for n in frames),
        *(f"memory {n}" for n in frames),
        "time exponent",
        "memory exponent",
    ]
    units = ["s"] * len(frames) + ["B"] * len(frames) + ["1", "1"]
    return Measures(np.array([values]), np.array(names), np.array(units))


def _first(meshes: Dataset[MeshSequence], frames: int) -> Takes:
    """The first takes, the last of them cut, with so many frames in all."""
    taken: Takes = {}
    for name, take in meshes.items():
        vertices = np.asarray(take.vertices[: max(frames, 0)])
        if len(vertices):
            taken[name] = take._replace(vertices=vertices)
        frames -= len(vertices)
    return taken


def _make(takes: Takes, alpha: float) -> PoseGraph:
    def one(pair: tuple[str, str]) -> PoseTransitions:
        both = (takes[pair[0]], takes[pair[1]])
        return pose_transitions(deformation_gradient(both), both, alpha=alpha)

    pairs = [(a, b) for a in takes for b in takes]
    with ThreadPoolExecutor(2) as pool:
        return essential(dict(zip(pairs, pool.map(one, pairs), strict=True)))


def _time(takes: Takes, alpha: float) -> float:
    start = time.perf_counter()
    _make(takes, alpha)
    return time.perf_counter() - start


def _peak(takes: Takes, alpha: float) -> float:
    tracemalloc.start()
    try:
        _make(takes, alpha)
        return float(tracemalloc.get_traced_memory()[1])
    finally:
        tracemalloc.stop()


def _exponent(sizes: tuple[int, ...], values: list[float]) -> float:
    known = np.isfinite(values)
    if known.sum() < 2:
        return float("nan")
    return float(np.polyfit(np.log(np.array(sizes)[known]), np.log(np.array(values)[known]), 1)[0])
