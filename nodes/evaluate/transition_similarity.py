"""How well tables of similarity stand for blended meshes."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.reference_motions import References, reference_motions, squared_distances
from reperform.nodes.kernels.transition_tables import EdgeTables
from reperform.nodes.kernels.trellis import Trellis, dissimilarities, fill_trellis, new_trellis
from reperform.nodes.motion_graph.edge_tables import edge_tables
from reperform.nodes.motion_graph.exact_transitions import nonlinear_states
from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.parametric import ParametricSpace

_LEVELS = (0, 1, 2)
_REPEATS = 200
# a bound is broken by more than the rounding of float32 tables, in units of the largest distance
_ROUNDING = 1e-5


@node(over="dataset", volatile=True, memory=4.0)
def transition_similarity(
    spaces: Dataset[ParametricSpace],
    *,
    edge: Annotated[str, Param(about="the edge that is measured: SOURCE>TARGET")] = "walk>jump",
    leave: Annotated[
        tuple[float, float], Param("1", 0.0, 1.0, "state in the source: time and control, as shares")
    ] = (0.05, 0.9),
    arrive: Annotated[
        tuple[float, float], Param("1", 0.0, 1.0, "state in the target: time and control, as shares")
    ] = (0.54, 0.65),
    depth: Annotated[int, Param("1", 1, 20, "steps of the trellis")] = 10,
    velocity_weight: Annotated[float, Param("1", 0.0, 100.0, "weight of motion against shape")] = 1.0,
) -> Measures:
    """Table 4.1 of 004: error and time of interpolated similarities at 0, 1 and 2 subdivisions, one row of entries.

    Of all transitions of one trellis: `average error n`, `maximum error n` of the similarity in per cent (s = 1 -
    d / max d, eq 4.4), against d of non-linearly blended meshes; the same with `eq 4.5 ..` for the sum without
    variances; `offline n` s, `online n` s (states and similarities, median), `exact` s (blending every mesh once).
    `violations` counts where, at any level, eq 4.5 is no bound of the distance of the played meshes, blends of
    references, worked out from their vertices; `violations nonlinear` is the share of transitions where it is none for
    the non-linear meshes, which it does not promise.

    Source: 004 table 4.1, figs 4.7-4.8, eqs 4.4-4.5 and appendix A.
    """
    source, target = (spaces[name] for name in edge.split(">"))
    chosen = {name: spaces[name] for name in edge.split(">")}
    values: dict[str, tuple[float, str]] = {}
    built = {}
    # the first build compiles what is needed
    for level in (_LEVELS[-1], *_LEVELS):
        start = time.perf_counter()
        graph = parametric(chosen, edges=(edge,), subdivisions=level, velocity_weight=velocity_weight)
        values[f"offline {level}"] = (time.perf_counter() - start, "s")
        built[level] = edge_tables(graph, 0)
    exact_seconds, truth = np.nan, np.zeros(0)
    broken = 0
    for level in _LEVELS:
        tables = built[level]
        fill, a, b = _trellises(tables, leave, arrive, depth)
        found = np.zeros((a.size[0], b.size[0]))
        values[f"online {level}"] = (_online(tables, fill, a, b, found), "s")
        if level == 0:
            start = time.perf_counter()
            truth = _exact(source, target, tables, a, b, velocity_weight)
            exact_seconds = time.perf_counter() - start
        bound = np.zeros_like(found)
        dissimilarities(tables, a, b, False, bound)
        for name, shown in (("", found), ("eq 4.5 ", bound)):
            error = 100.0 * np.abs(shown - truth / tables.largest)
            values[f"{name}average error {level}"] = (float(error.mean()), "%")
            values[f"{name}maximum error {level}"] = (float(error.max()), "%")
        played = _played(source, target, level, a, b, velocity_weight) / tables.largest
        broken += int((bound < played - _ROUNDING).sum())
        values[f"violations nonlinear {level}"] = (
            float((bound < truth / tables.largest - _ROUNDING).mean()),
            "1",
        )
    values["exact"] = (exact_seconds, "s")
    values["speedup"] = (exact_seconds / values[f"online {_LEVELS[-1]}"][0], "1")
    values["violations"] = (float(broken), "1")
    values["transitions"] = (float(found.size), "1")
    return Measures(
        np.array([[value for value, _ in values.values()]]),
        np.array(list(values)),
        np.array([unit for _, unit in values.values()]),
    )


def _trellises(
    tables: EdgeTables, leave: tuple[float, float], arrive: tuple[float, float], depth: int
) -> tuple[Callable[[], None], Trellis, Trellis]:
    """The trellis of each space, and what fills them."""
    a, b = new_trellis(tables.source, depth), new_trellis(tables.target, depth)
    poses = tables.source.spread.shape[0], tables.target.spread.shape[0] - 1
    start = np.full(tables.source.control.shape[1], leave[1])
    end = np.full(tables.target.control.shape[1], arrive[1])

    def fill() -> None:
        fill_trellis(tables.source, leave[0] * poses[0], start, 1, depth, 0.1, a)
        fill_trellis(tables.target, arrive[0] * poses[1], end, -1, depth, 0.1, b)

    fill()
    return fill, a, b


def _online(tables: EdgeTables, fill: Callable[[], None], a: Trellis, b: Trellis, out: np.ndarray) -> float:
    """Median seconds of laying the trellises out and of all similarities between them."""
    dissimilarities(tables, a, b, True, out)
    taken = []
    for _ in range(_REPEATS):
        start = time.perf_counter()
        fill()
        dissimilarities(tables, a, b, True, out)
        taken.append(time.perf_counter() - start)
    return float(np.median(taken))


def _exact(
    source: ParametricSpace,
    target: ParametricSpace,
    tables: EdgeTables,
    a: Trellis,
    b: Trellis,
    velocity_weight: float,
) -> np.ndarray:
    """Squared distances (states, states) of non-linear blends; tables: without subdivisions, whose references are
    the inputs.
    """
    features = []
    for space, side, states in ((source, tables.source, a), (target, tables.target, b)):
        count = states.size[0]
        weights = np.zeros((count, len(side.control)))
        for corner in range(states.reference.shape[1]):
            weights[np.arange(count), states.reference[:count, corner]] += states.weight[:count, corner]
        features.append(nonlinear_states(space, states.pose[:count], weights, velocity_weight))
    return squared_distances(*features)


def _played(
    source: ParametricSpace,
    target: ParametricSpace,
    level: int,
    a: Trellis,
    b: Trellis,
    velocity_weight: float,
) -> np.ndarray:
    """Squared distances (states, states) of blends of references, from their vertices and velocities."""
    features = []
    for space, states in ((source, a), (target, b)):
        references = _references(space, level, velocity_weight)
        rows = range(states.size[0])
        features.append(
            np.stack(
                [states.weight[k] @ references.features[states.pose[k]][states.reference[k]] for k in rows]
            )
        )
    return squared_distances(features[0].astype(np.float64), features[1].astype(np.float64))


def _references(space: ParametricSpace, level: int, velocity_weight: float) -> References:
    fields = (space.vertices, space.motion, space.seconds, space.faces, space.cells)
    vertices, motion, seconds, faces, cells = (np.asarray(field) for field in fields)
    return reference_motions(
        vertices, motion, seconds, bool(np.asarray(space.cyclic)), faces, cells, level, velocity_weight, True
    )
