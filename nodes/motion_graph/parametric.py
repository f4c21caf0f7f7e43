"""The 4D parametric motion graph: parametric spaces joined by transitions found while the motion plays."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.fixed_transitions import choose_fixed
from reperform.nodes.kernels.reference_motions import References, reference_motions, squared_distances
from reperform.nodes.product import Dataset
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace

_WHO = "motion_graph.parametric"
# fixed transitions are this share of a run apart; they enter a motion that is not cyclic within this share of its
# begin, and leave it within the same of its end, or they could hardly be used
_APART = 0.1
_ENTRY = 0.3


@node(over="dataset", memory=4.0)
def parametric(
    spaces: Dataset[ParametricSpace],
    *,
    edges: Annotated[
        tuple[str, ...], Param(about="transitions that are allowed: SOURCE>TARGET; empty: suggested ones")
    ] = (),
    suggest: Annotated[
        float,
        Param(
            "1", 0.0, 1.0, "least dissimilarity, in units of the largest, up to which an edge is suggested"
        ),
    ] = 0.2,
    subdivisions: Annotated[int, Param("1", 0, 4, "how often weights are bisected for the tables")] = 2,
    velocity_weight: Annotated[
        float, Param("1", 0.0, 100.0, "weight of motion per 1/25 s against shape in the distance")
    ] = 1.0,
    blend: Annotated[Literal["nonlinear", "linear"], Param(about="how references are blended")] = "nonlinear",
    latency_weight: Annotated[
        float,
        Param("1", 0.0, 1000.0, "lambda: thousandths of the largest dissimilarity that 1/25 s is worth"),
    ] = 0.38,
    depth: Annotated[int, Param("1", 1, 20, "steps of the trellis")] = 10,
    step: Annotated[
        float, Param("1", 0.01, 1.0, "of the trellis, as a share of a run and of a control's range")
    ] = 0.1,
    threshold: Annotated[
        float,
        Param("1", 0.0, 1.0, "greatest dissimilarity, in units of the largest, of a transition that is made"),
    ] = 0.5,
    fixed: Annotated[int, Param("1", 1, 100, "fixed transitions per edge, the baseline")] = 10,
) -> ParametricGraph:
    """Spaces as nodes, allowed edges, and tables from which the cost of any transition follows at once.

    spaces: of one topology and dataset. Each cell of weights is bisected into reference motions; the squared distance

        d(x, y) = 1/V (sum |x_v - y_v|^2 + velocity_weight sum |s_v - r_v|^2)

    of all poses of all references of a source and a target is tabulated per edge. At run time the distance of any two
    states is interpolated between references and the best transition of a trellis is taken
    (kernels.transition_search). Edges are those given, or those whose best pair is within `suggest`; `core` marks the
    spaces of the largest strongly connected part.

    Raises ValueError where spaces differ in topology, an edge cannot be read, or nothing joins the spaces.

    Source: 004 sections 4.3-4.4 (eqs 4.1-4.6); 001 section 3.2.
    Departure: dissimilarities are minimised; distances are taken in the frame of the root, that of the body on the
    ground, since takes lie anywhere in the studio; velocities are blended between references as positions are, so that
    the bound of eq 4.5 holds exactly.
    """
    names = tuple(spaces)
    _require_alike(spaces)
    made = [_references(spaces[name], subdivisions, velocity_weight, blend == "nonlinear") for name in names]
    allowed = [_edge(text, names) for text in edges]
    pairs = allowed or [(i, j) for i in range(len(names)) for j in range(len(names)) if i != j]
    tables = {(i, j): _table(made[i], made[j]) for i, j in dict.fromkeys(pairs)}
    largest = max((float(table.max()) for table in tables.values()), default=0.0) or 1.0
    if not allowed:
        tables = {pair: table for pair, table in tables.items() if table.min() <= suggest * largest}
    if not tables:
        raise ValueError(
            f"{_WHO}: nothing joins the spaces {', '.join(names)} within {suggest}: raise suggest, or give edges"
        )
    return _graph(spaces, names, made, tables, largest, subdivisions, fixed)._replace(
        latency_weight=np.array(latency_weight),
        depth=np.array(depth, np.int32),
        step=np.array(step),
        threshold=np.array(threshold),
    )


def _references(
    space: ParametricSpace, subdivisions: int, velocity_weight: float, nonlinear: bool
) -> References:
    fields = (space.vertices, space.motion, space.seconds, space.cyclic, space.faces, space.cells)
    vertices, motion, seconds, cyclic, faces, cells = (np.asarray(field) for field in fields)
    return reference_motions(
        vertices, motion, seconds, bool(cyclic), faces, cells, subdivisions, velocity_weight, nonlinear
    )


def _table(source: References, target: References) -> np.ndarray:
    """Squared distances (Ks, Rs, Kt, Rt)."""
    a, b = source.features, target.features
    flat = squared_distances(a.reshape(-1, a.shape[-1]), b.reshape(-1, b.shape[-1]))
    return flat.reshape(*a.shape[:2], *b.shape[:2])


def _graph(
    spaces: Dataset[ParametricSpace], names: tuple[str, ...], made: list[References],
    tables: dict[tuple[int, int], np.ndarray], largest: float, subdivisions: int, fixed: int,
) -> ParametricGraph:  # fmt: skip
    """The graph, all its tables flat."""
    controls = [
        references.weights @ np.asarray(spaces[name].control)
        for name, references in zip(names, made, strict=True)
    ]
    corners = [np.asarray(spaces[name].cells) for name in names]
    wide = max(control.shape[1] for control in controls)
    spread = [
        np.stack([squared_distances(pose, pose) for pose in references.features]) for references in made
    ]
    cyclic = [bool(np.asarray(spaces[name].cyclic)) for name in names]
    chosen = [_fixed(table, fixed, cyclic[i], cyclic[j]) for (i, j), table in tables.items()]
    costs = [
        table[poses[:, 0], rows[:, 0], poses[:, 1], rows[:, 1]] / largest
        for table, (poses, rows) in zip(tables.values(), chosen, strict=True)
    ]
    source, target = (np.array(column, np.int32) for column in zip(*tables, strict=True))
    zero = np.array(0.0)
    return ParametricGraph(
        spaces=np.array(names),
        poses=np.array([references.features.shape[0] for references in made], np.int32),
        cyclic=np.array(cyclic),
        dimensions=np.array([control.shape[1] for control in controls], np.int32),
        references=np.array([len(control) for control in controls], np.int32),
        cells=np.array([len(cells) for cells in corners], np.int32),
        core=_core(source, target, len(names)),
        takes=np.concatenate([np.asarray(spaces[name].takes) for name in names]),
        take_space=np.repeat(
            np.arange(len(names), dtype=np.int32), [len(spaces[name].takes) for name in names]
        ),
        reference_control=np.concatenate(
            [np.pad(control, ((0, 0), (0, wide - control.shape[1]))) for control in controls]
        ),
        corners=np.concatenate(
            [np.pad(cells, ((0, 0), (0, wide + 1 - cells.shape[1])), constant_values=-1) for cells in corners]
        ),
        lattice=np.concatenate([references.places.ravel() for references in made]),
        halves=np.array(2**subdivisions, np.int32),
        seconds=np.concatenate([references.seconds.ravel() for references in made]),
        spread=np.concatenate([rows.ravel() for rows in spread]),
        stride=np.concatenate(
            [
                _strides(references.features, round_).ravel()
                for references, round_ in zip(made, cyclic, strict=True)
            ]
        ),
        source=source,
        target=target,
        best=np.array([table.min() / largest for table in tables.values()], np.float64),
        distance=np.concatenate([table.ravel() for table in tables.values()]),
        largest=np.array(largest),
        fixed_edge=np.repeat(np.arange(len(chosen), dtype=np.int32), [len(poses) for poses, _ in chosen]),
        fixed_pose=np.concatenate([poses for poses, _ in chosen]),
        fixed_reference=np.concatenate([rows for _, rows in chosen]),
        fixed_cost=np.concatenate(costs).astype(np.float64),
        latency_weight=zero,
        depth=np.array(0, np.int32),
        step=zero,
        threshold=zero,
    )


def _strides(features: np.ndarray, cyclic: bool) -> np.ndarray:
    """Products of the steps from pose to pose (K, R, R) of features (K, R, F); 0 at the end unless cyclic."""
    steps = np.roll(features, -1, axis=0) - features
    if not cyclic:
        steps[-1] = 0.0
    return np.asarray(steps @ steps.transpose(0, 2, 1), np.float32)


def _fixed(
    table: np.ndarray, count: int, source_cyclic: bool, target_cyclic: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Fixed transitions of one edge."""
    leave = 0 if source_cyclic else int((1 - _ENTRY) * table.shape[0])
    enter = None if target_cyclic else int(_ENTRY * table.shape[2])
    return choose_fixed(table, count, max(1, round(_APART * table.shape[0])), leave, enter)


def _core(source: np.ndarray, target: np.ndarray, count: int) -> np.ndarray:
    """The spaces (count,) of the largest strongly connected part; none where no space can be left and entered again."""
    joined = scipy.sparse.csr_matrix((np.ones(len(source)), (source, target)), shape=(count, count))
    _, part = connected_components(joined, directed=True, connection="strong")
    sizes = np.bincount(part)
    return np.asarray((part == np.argmax(sizes)) & (sizes.max() > 1))


def _edge(text: str, names: tuple[str, ...]) -> tuple[int, int]:
    parts = [part.strip() for part in text.split(">")]
    if len(parts) != 2 or not set(parts) <= set(names):
        raise ValueError(f"{_WHO}: an edge is SOURCE>TARGET with spaces of {', '.join(names)}, got {text!r}")
    return names.index(parts[0]), names.index(parts[1])


def _require_alike(spaces: Dataset[ParametricSpace]) -> None:
    first, *others = spaces
    faces = np.asarray(spaces[first].faces)
    for name in others:
        if not np.array_equal(np.asarray(spaces[name].faces), faces):
            raise ValueError(
                f"{_WHO}: spaces must share one topology; {name} differs from {first}: align the takes first"
            )
