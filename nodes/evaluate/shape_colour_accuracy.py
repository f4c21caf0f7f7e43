"""How fast and how true the shape-colour matrices are, against earth mover's distances of all bins."""

from __future__ import annotations

import itertools
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Annotated, NamedTuple

import numpy as np
from scipy.stats import spearmanr

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.signatures import Signatures, common_planes, merged, single
from reperform.nodes.kernels.transitions import find_transitions, window_cost
from reperform.nodes.kernels.turned_transport import least_distance, turned
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.products.shape_colour import ShapeColourHistograms
from reperform.nodes.similarity.shape_colour import shape_colour, shape_colour_signatures
from reperform.nodes.similarity.shape_colour_refined import shape_colour_refined

# cells from which the distances of the exact side are bounded
_CELLS = 160
_TURNS, _COLOUR_WEIGHT = 20, 1.0


class _Frame(NamedTuple):
    take: str
    number: int


class _Exact(NamedTuple):
    """The distance of all bins, how many turns were solved to prove it the least, and the seconds that POT takes for
    one turn (nan: not asked).
    """

    distance: float
    solved: int
    seconds: float


@node(over="dataset", volatile=True, memory=3.0, threads=2)
def shape_colour_accuracy(
    histograms: Dataset[ShapeColourHistograms],
    *,
    pairs: Annotated[int, Param("1", 2, 100_000, "random pairs of frames solved exactly")] = 200,
    source: Annotated[str, Param(about="the take whose transitions are ranked; empty: the first")] = "",
    target: Annotated[str, Param(about="the take they lead to; empty: the last")] = "",
    candidates: Annotated[int, Param("1", 4, 1000, "transitions whose windows are solved exactly")] = 12,
    half_length: Annotated[int, Param("frame", 1, 100, "of the window of a transition (L)")] = 4,
    seed: Annotated[int, Param("1", 0, 2**31, "of the random pairs")] = 0,
) -> Measures:
    """Time and truth of the shape-colour matrices of all frames of all takes, one row.

    `matrix` s: wall time of similarity.shape_colour over all pairs of takes, each once, in two threads. Exact is the
    earth mover's distance between all filled bins, least over the 20 turns: turns are solved in the order of their
    lower bounds until the next bound is over the least (`turns solved`: mean over the random pairs), then POT solves
    the turn found; `solver difference` m: the largest between both solvers. On the random pairs: `spearman` of matrix
    and exact. `speedup`: `exact` s per pair, POT's processor time for one turn (median) times the turns, over
    `measured` s per pair, the matrix' processor time over its pairs of frames; both in one thread.
    `top4 agreement`: the exact windowed costs of the candidate transitions (the cheapest local minima of the
    matrix) are ranked; the share of their four cheapest that are the four cheapest by
    similarity.shape_colour_refined, which takes `refined` s in one thread, and by the matrix (`top4 by cells`).
    Without POT the figures that need it are nan.

    Raises ValueError where a take does not exist or there is no transition.
    Source: 000 section 4.1 (eq 1) and 4.2; Flamary et al. 2021, JMLR 22 (POT).
    """
    takes = list(histograms)
    ends = (source or takes[0], target or takes[-1])
    for take in ends:
        if take not in histograms:
            raise ValueError(f"evaluate.shape_colour_accuracy: no take {take!r} among {', '.join(takes)}")
    read = {t: ShapeColourHistograms(*histograms[t]) for t in takes}
    seconds, busy, matrices = _matrices(read)
    signatures = {t: shape_colour_signatures(read[t], _COLOUR_WEIGHT) for t in takes}
    bins = _Bins(signatures)
    frames = [_Frame(t, k) for t in takes for k in range(len(signatures[t].first) - 1)]
    chosen = _random_pairs(len(frames), pairs, seed)
    with ThreadPoolExecutor(2) as pool:
        exact = list(pool.map(lambda p: bins.exact(frames[p[0]], frames[p[1]], pot=True), chosen))
    ours = [matrices[frames[i].take, frames[j].take][frames[i].number, frames[j].number] for i, j in chosen]
    known = np.array([e.distance for e in exact])
    per_pair = busy / (len(frames) * (len(frames) - 1) / 2)
    alone = _TURNS * float(np.median([e.seconds for e in exact]))
    values = {
        "matrix": (seconds, "s"),
        "frames": (float(len(frames)), "1"),
        "measured": (per_pair, "s"),
        "exact": (alone, "s"),
        "speedup": (alone / per_pair, "1"),
        "spearman": (float(spearmanr(ours, known)[0]), "1"),
        "turns solved": (float(np.mean([e.solved for e in exact])), "1"),
        "solver difference": (bins.difference, "m"),
        "mean ratio": (float(np.mean(np.array(ours) / known)), "1"),
    }
    values |= _agreement(bins, matrices[ends], {t: read[t] for t in ends}, candidates, half_length)
    return Measures(
        np.array([[value for value, _ in values.values()]]),
        np.array(list(values)),
        np.array([unit for _, unit in values.values()]),
    )


def _matrices(
    read: Mapping[str, ShapeColourHistograms],
) -> tuple[float, float, Mapping[tuple[str, str], np.ndarray]]:
    """Wall and processor seconds for all pairs of takes, each once, and the matrices of the ordered ones."""
    few = {t: _first_frames(read[t], 2) for t in read}
    shape_colour((next(iter(few.values())),) * 2)  # compiled before time is taken
    names = list(itertools.combinations_with_replacement(read, 2))

    def timed(pair: tuple[str, str]) -> tuple[float, np.ndarray]:
        start = time.thread_time()
        distance = shape_colour((read[pair[0]], read[pair[1]])).distance
        return time.thread_time() - start, distance

    start = time.perf_counter()
    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(timed, names))
    seconds = time.perf_counter() - start
    one = {pair: distance for pair, (_, distance) in zip(names, found, strict=True)}
    both = {(b, a): distance.T for (a, b), distance in one.items()} | one
    return seconds, sum(busy for busy, _ in found), both


def _first_frames(histograms: ShapeColourHistograms, count: int) -> ShapeColourHistograms:
    fields = ("bin", "share", "point", "colour", "centre")
    return histograms._replace(**{name: getattr(histograms, name)[:count] for name in fields})


def _random_pairs(frames: int, count: int, seed: int) -> list[tuple[int, int]]:
    """Distinct pairs i < j."""
    i, j = np.triu_indices(frames, 1)
    rng = np.random.default_rng(seed)
    picked = rng.choice(len(i), min(count, len(i)), replace=False)
    return [(int(i[k]), int(j[k])) for k in picked]


class _Bins:
    """All filled bins of all frames, and their distances."""

    def __init__(self, signatures: Mapping[str, Signatures]) -> None:
        self.full = signatures
        self.planes = common_planes(list(signatures.values()), _CELLS)
        self.difference = np.nan

    def exact(self, a: _Frame, b: _Frame, pot: bool = False) -> _Exact:
        """The least over all turns."""
        x, y = single(self.full[a.take], a.number), single(self.full[b.take], b.number)
        every = turned(y, _TURNS)
        cells = (merged(x, self.planes), merged(every, self.planes))
        distance, turn, solved = least_distance(x, 0, every, 0, cells, _TURNS)
        seconds = np.nan
        if pot:
            peer, seconds = _pot(x, single(every, turn))
            self.difference = float(np.fmax(self.difference, abs(peer - distance)))
            distance = peer
        return _Exact(distance, solved, seconds)


def _pot(x: Signatures, y: Signatures) -> tuple[float, float]:
    """POT's distance of two frames and its seconds in this thread; nan without POT."""
    try:
        import ot
    except ImportError:
        return np.nan, np.nan
    cost = np.linalg.norm(x.point[:, None] - y.point[None], axis=2)
    start = time.thread_time()
    value = float(ot.emd2(x.mass / x.mass.sum(), y.mass / y.mass.sum(), cost, numItermax=10_000_000))
    return value, time.thread_time() - start


def _agreement(
    bins: _Bins,
    matrix: np.ndarray,
    takes: Mapping[str, ShapeColourHistograms],
    candidates: int,
    half: int,
) -> dict[str, tuple[float, str]]:
    """Share of the exact four cheapest candidate transitions that are the refined and the given matrix' four."""
    a, b = takes
    best = find_transitions(matrix, candidates, half, half, spread=half)
    if len(best.m) < 4:
        raise ValueError(
            f"evaluate.shape_colour_accuracy: four transitions {a} to {b} needed, got {len(best.m)}: use longer takes"
        )
    places = list(zip(best.m.tolist(), best.n.tolist(), strict=True))
    cells = sorted({(m + k, n + k) for m, n in places for k in range(1 - half, half)})
    with ThreadPoolExecutor(2) as pool:
        solved = list(pool.map(lambda c: bins.exact(_Frame(a, c[0]), _Frame(b, c[1])).distance, cells))
    exact = np.full(matrix.shape, np.nan)
    exact[tuple(np.array(cells).T)] = solved
    start = time.perf_counter()
    refined = shape_colour_refined(
        Dissimilarity(matrix), (takes[a], takes[b]), transitions=8, half_length=half,
        colour_weight=_COLOUR_WEIGHT, turns=_TURNS,
    ).distance  # fmt: skip
    seconds = time.perf_counter() - start
    first, second, third = (
        set(np.argsort([window_cost(known, m, n, half) for m, n in places], kind="stable")[:4].tolist())
        for known in (exact, refined, matrix)
    )
    return {
        "top4 agreement": (len(first & second) / 4, "1"),
        "top4 by cells": (len(first & third) / 4, "1"),
        "refined": (seconds, "s"),
    }
