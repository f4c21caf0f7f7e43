from typing import NamedTuple

import numpy as np
import pytest

from reperform.nodes.kernels.fixed_transitions import fixed_transition
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.reference_motions import reference_motions
from reperform.nodes.kernels.transition_search import best_transition, new_found
from reperform.nodes.kernels.transition_tables import EdgeTables, SpaceTables
from reperform.nodes.kernels.trellis import dissimilarities, fill_trellis, new_trellis
from reperform.nodes.motion_graph.edge_tables import edge_tables, find_edge
from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.motion_graph.space import space
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace


@pytest.fixture(scope="module")
def spaces(takes) -> dict[str, ParametricSpace]:
    return {
        "walk": space(*takes, takes=("slow", "fast")),
        "turn": space(*takes, takes=("right", "left", "slow", "fast"), parameters=("turning", "speed")),
        "hop": space(*takes, takes=("low", "high"), parameters=("height",), cyclic=False),
    }


@pytest.fixture(scope="module")
def graph(spaces) -> ParametricGraph:
    edges = ("walk>hop", "hop>walk", "walk>turn", "turn>hop")
    return parametric(spaces, edges=edges, blend="linear", subdivisions=1, threshold=1.0)


def played(made: ParametricSpace, pose: int, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities per 1/25 s of a linear blend, taken from the world, then brought to the root's frame."""
    before = (pose - 1) % made.vertices.shape[1]
    dx, dz, yaw = weights @ made.motion[:, before]
    now = apply(
        np.tensordot(weights, made.vertices[:, pose].astype(float), 1), Placement(yaw, np.array([dx, dz]))
    )
    then = np.tensordot(weights, made.vertices[:, before].astype(float), 1)
    velocity = (now - then) / (25 * (weights @ made.seconds[:, before]))
    c, s = np.cos(yaw), np.sin(yaw)
    back = velocity @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return np.tensordot(weights, made.vertices[:, pose].astype(float), 1), back


def test_tables_hold_the_distance_of_played_meshes(graph, spaces):
    tables = edge_tables(graph, find_edge(graph, "walk", "turn"))
    a, b = (
        played(spaces["walk"], 7, np.array([1.0, 0.0])),
        played(spaces["turn"], 11, np.array([0.0, 1.0, 0.0, 0.0])),
    )
    exact = sum(((x - y) ** 2).sum() for x, y in zip(a, b, strict=True)) / len(a[0])
    assert tables.distance[7, 0, 11, 1] == pytest.approx(exact, rel=1e-4)


def trellises(tables: EdgeTables, depth: int):
    a, b = new_trellis(tables.source, depth), new_trellis(tables.target, depth)
    fill_trellis(tables.source, 3.0, np.full(tables.source.control.shape[1], 0.37), 1, depth, 0.1, a)
    fill_trellis(tables.target, 20.0, np.full(tables.target.control.shape[1], 0.81), -1, depth, 0.1, b)
    return a, b


@pytest.mark.parametrize("edge", ["walk>hop", "turn>hop", "walk>turn"])
def test_the_bound_holds_and_the_variance_makes_it_exact(graph, edge):
    """Features of references, blended as weights say, give the distance itself: no bound, no table."""
    tables = edge_tables(graph, find_edge(graph, *edge.split(">")))
    a, b = trellises(tables, 6)
    bound, exact = (np.zeros((a.size[0], b.size[0])) for _ in range(2))
    dissimilarities(tables, a, b, False, bound)
    dissimilarities(tables, a, b, True, exact)
    rng = np.random.default_rng(3)
    # points with the distances of the tables: classical scaling of all references of two poses
    for s, t in zip(rng.integers(0, a.size[0], 40), rng.integers(0, b.size[0], 40), strict=True):
        i, j = a.pose[s], b.pose[t]
        cross = tables.distance[i][:, j].astype(float)
        square = np.block([[tables.source.spread[i], cross], [cross.T, tables.target.spread[j]]])
        centre = np.eye(len(square)) - 1 / len(square)
        values, vectors = np.linalg.eigh(-0.5 * centre @ square @ centre)
        points = vectors * np.sqrt(np.maximum(values, 0))
        x = a.weight[s] @ points[a.reference[s]]
        y = b.weight[t] @ points[len(cross) + b.reference[t]]
        true = ((x - y) ** 2).sum() / tables.largest
        assert bound[s, t] >= true - 1e-6
        assert exact[s, t] == pytest.approx(true, abs=2e-5)


def every_state(
    side: SpaceTables, features: np.ndarray, pose: int, control: np.ndarray, direction: int, depth: int
) -> tuple[np.ndarray, np.ndarray]:
    """All states within a depth, at every quarter of every pose: features (S, F), seconds (S,).

    features (K, R, F): of references, blended as weights say, and linear from pose to pose.
    """
    poses, room, rows = side.spread.shape[0], new_trellis(side, 40), []
    step_seconds = np.diff(side.clock, axis=1)
    last = round(depth * 0.1 * poses)
    if not side.cyclic:
        last = min(last, poses - 1 - pose if direction > 0 else pose)
    for moment in range(last + 1):
        at, on = pose + direction * moment, pose + direction * (moment + 1)
        passed = np.arange(min(pose, at), max(pose, at)) % poses
        changes = int(moment / (0.1 * poses) + 1e-9)
        for axis in range(len(control)):
            for j in range(-changes, changes + 1):
                u = control.copy()
                u[axis] = min(max(u[axis] + 0.1 * j, 0), 1)
                fill_trellis(side, at % poses, u, 1, 0, 0.1, room)
                reference, weight = room.reference[0].copy(), room.weight[0].copy()
                seconds = weight @ step_seconds[reference][:, passed].sum(axis=1)
                here, there = (weight @ features[k % poses, reference] for k in (at, on))
                pace = weight @ step_seconds[reference, min(at, on) % poses]
                for part in (0.0, 0.25, 0.5, 0.75) if moment < last else (0.0,):
                    rows.append((here + part * (there - here), seconds + part * pace))
    return np.array([row for row, _ in rows]), np.array([seconds for _, seconds in rows])


def state(side: SpaceTables, features: np.ndarray, pose: float, control: np.ndarray) -> np.ndarray:
    """Features (F,) at a pose between two."""
    poses, room = side.spread.shape[0], new_trellis(side, 40)
    before = int(np.floor(pose))
    fill_trellis(side, before % poses, control, 1, 0, 0.1, room)
    here, there = (room.weight[0] @ features[k % poses, room.reference[0]] for k in (before, before + 1))
    return here + (pose - before) * (there - here)


def test_the_search_finds_the_cheapest_of_all_states(graph, spaces):
    """Against features of references themselves: no tables, no bound, no polynomial."""
    features = {}
    for name, made in spaces.items():
        fields = (made.vertices, made.motion, made.seconds, bool(made.cyclic), made.faces, made.cells)
        features[name] = reference_motions(*fields, 1, 1.0, False).features.astype(float)
    between = 0
    for edge, weight in (("walk>hop", 5.0), ("walk>hop", 0.3), ("turn>hop", 1.0), ("hop>walk", 1.0)):
        one, two = (features[name] for name in edge.split(">"))
        tables = edge_tables(graph, find_edge(graph, *edge.split(">")))
        u, v = (
            np.full(side.control.shape[1], c) for side, c in ((tables.source, 0.37), (tables.target, 0.81))
        )
        depth, start, end = 3, 9, 20
        found = new_found(tables)
        room = (tables, start, u, end, v, depth, 0.1, weight)
        assert best_transition(*room, 1.0, found)
        here = state(tables.source, one, found.source_pose[0], found.source_control)
        there = state(tables.target, two, found.target_pose[0], found.target_control)
        scale = 1000 / tables.largest
        assert found.cost[0] == pytest.approx(scale * ((here - there) ** 2).sum(), rel=1e-3)
        assert found.cost[1] == pytest.approx(weight * 25 * (found.cost[2] + found.cost[3]))
        between += found.source_pose[0] % 1 > 0 or found.target_pose[0] % 1 > 0
        (a, waited), (b, passed) = (
            every_state(tables.source, one, start, u, 1, depth),
            every_state(tables.target, two, end, v, -1, depth),
        )
        square = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1) - 2 * a @ b.T
        costs = scale * square + weight * 25 * (waited[:, None] + passed)
        cost = found.cost[0] + found.cost[1]
        assert cost <= costs.min() * (1 + 1e-4)
        # a quarter of a step is near enough to tell
        strides = [np.linalg.norm(np.diff(f, axis=0), axis=-1).max() for f in (one, two)]
        assert cost > costs.min() - scale * sum(strides) ** 2 / 64
        assert not best_transition(*room, 0.9 * square.min() / tables.largest, found)
    assert between >= 2


class Moment(NamedTuple):
    """States that differ in their controls alone."""

    pose: int
    beside: int
    weight: np.ndarray
    control: np.ndarray
    seconds: np.ndarray
    pace: np.ndarray


def moments(
    side: SpaceTables, pose: int, control: np.ndarray, direction: int, depth: int, any_pose: bool = False
) -> list[Moment]:
    """All states within a depth, one at a time, with weights of all references."""
    poses, room, out = side.spread.shape[0], new_trellis(side, 40), []
    step_seconds = np.diff(side.clock, axis=1)[:, :poses]
    last = poses - 1 if any_pose else round(depth * 0.1 * poses)
    if not side.cyclic:
        last = min(last, poses - 1 - pose if direction > 0 else pose)
    for k in range(last + 1):
        at, on = pose + direction * k, pose + direction * (k + (k < last or (any_pose and side.cyclic)))
        changes = 0 if any_pose else int(k / (0.1 * poses) + 1e-9)
        weights, controls = [], []
        for axis in range(len(control)):
            for j in range(-changes, changes + 1):
                u = control.copy()
                u[axis] = min(max(u[axis] + 0.1 * j, 0), 1)
                fill_trellis(side, at % poses, u, 1, 0, 0.1, room)
                weight = np.zeros(len(side.control))
                np.add.at(weight, room.reference[0], room.weight[0])
                weights.append(weight)
                controls.append(u)
        passed = np.arange(min(pose, at), max(pose, at)) % poses
        seconds = np.array(weights) @ step_seconds
        counted = 0.0 if any_pose else 1.0
        out.append(
            Moment(
                at % poses, on % poses, np.array(weights), np.array(controls),
                counted * seconds[:, passed].sum(axis=1), counted * (on != at) * seconds[:, min(at, on) % poses],
            )
        )  # fmt: skip
    return out


def costs_between(
    tables: EdgeTables, one: Moment, two: Moment, part: np.ndarray, share: np.ndarray, weight: float
) -> tuple[np.ndarray, np.ndarray]:
    """E_S and lambda E_L, (S, T, A, B): part (A,) of the way to the next pose of the source, share (B,) of the target's.

    The squared distance of two weighted sums of points, their weights of sum 1, from the points' distances alone.
    """
    steps = [np.stack([1 - a, a], 1) for a in (part, share)]
    x = np.einsum("sr,ap->sapr", one.weight, steps[0])
    y = np.einsum("tr,bq->tbqr", two.weight, steps[1])
    table = tables.distance[[one.pose, one.beside]][:, :, [two.pose, two.beside]].astype(float)
    total = np.einsum("sapr,prqk,tbqk->stab", x, table, y)
    for side, moment, along, axes in (
        (tables.source, one, part, (1, 3)),
        (tables.target, two, share, (0, 2)),
    ):
        spread = side.spread[[moment.pose, moment.beside]].astype(float)
        # a blend of both poses: the mean spread within each, and what lies between them
        within = 0.5 * np.einsum("sr,prk,sk->sp", moment.weight, spread, moment.weight)
        first = moment.pose if moment.beside == (moment.pose + 1) % len(side.spread) else moment.beside
        square = np.einsum("sr,rk,sk->s", moment.weight, side.stride[first].astype(float), moment.weight)
        square *= moment.pose != moment.beside
        own = within @ np.stack([1 - along, along]) + square[:, None] * along * (1 - along)
        total -= np.expand_dims(own, axes)
    waits = (one.seconds[:, None] + part * one.pace[:, None])[:, None, :, None]
    waits = waits + (two.seconds[:, None] + share * two.pace[:, None])[None, :, None, :]
    return 1000 / tables.largest * np.maximum(total, 0), weight * 25 * waits


@pytest.mark.parametrize("edge", ["walk>hop", "hop>walk", "turn>hop", "walk>turn"])
def test_the_search_is_a_plain_comparison_of_all_states(graph, edge):
    """Every pair of states and of parts of steps in turn, from the tables alone: no bound, no order, nothing shared."""
    tables = edge_tables(graph, find_edge(graph, *edge.split(">")))
    rng, depth, found = np.random.default_rng(2), 3, new_found(tables)
    parts = np.linspace(0, 1, 5)
    for weight, any_pose in ((5.0, False), (0.3, False), (1.0, True)):
        (start, u), (end, v) = (
            (int(rng.integers(8, side.spread.shape[0])), rng.random(side.control.shape[1]))
            for side in (tables.source, tables.target)
        )
        goal = -1 if any_pose else end
        assert best_transition(tables, start, u, goal, v, depth, 0.1, weight, 1.0, found)
        ones = moments(tables.source, start, u, 1, depth)
        last = tables.target.spread.shape[0] - 1
        twos = moments(tables.target, last if any_pose else end, v, -1, depth, any_pose)
        least = min(
            sum(costs_between(tables, one, two, parts, parts, weight)).min() for one in ones for two in twos
        )
        assert found.cost[:2].sum() <= least * (1 + 1e-6)
        # what is found is one of them
        leave, enter = found.source_pose[0], found.target_pose[0]
        one = next(m for m in ones if m.pose == int(leave))
        two = next(m for m in twos if m.pose == int(np.ceil(enter)) % (last + 1))
        s = np.flatnonzero((np.abs(one.control - found.source_control) < 1e-12).all(axis=1))[0]
        t = np.flatnonzero((np.abs(two.control - found.target_control) < 1e-12).all(axis=1))[0]
        shape, waits = costs_between(
            tables, one, two, np.array([leave % 1]), np.array([np.ceil(enter) - enter]), weight
        )
        assert found.cost[0] == pytest.approx(shape[s, t, 0, 0], rel=1e-6)
        assert found.cost[1] == pytest.approx(waits[s, t, 0, 0], rel=1e-6)


def test_a_trellis_moves_on_in_time_and_little_by_little_in_controls(graph):
    tables = edge_tables(graph, find_edge(graph, "walk", "hop"))
    a, b = trellises(tables, 10)
    poses = tables.source.spread.shape[0]
    n, m = a.size[0], b.size[0]
    step = (a.pose[:n] - 3) % poses
    assert (np.abs(a.control[:n, 0] - 0.37) <= step / poses + 0.03 + (step == 0)).all()
    assert a.control[:n].min() == 0
    assert a.control[:n].max() == 1
    assert a.seconds[:n].max() == pytest.approx(tables.source.clock[:, poses].mean(), rel=0.2)
    # a hop is not run through twice: nothing before its first pose
    assert b.pose[:m].min() >= 0
    assert b.pose[:m].max() == 20
    assert (np.diff(b.pose[:m]) <= 0).all()


def test_any_pose_of_the_target_will_do_if_none_is_asked(graph):
    tables = edge_tables(graph, find_edge(graph, "hop", "walk"))
    found = new_found(tables)
    assert best_transition(tables, 30.0, np.array([0.5]), -1.0, np.array([0.2]), 10, 0.1, 5.0, 1.0, found)
    assert found.cost[3] == 0
    assert found.target_control[0] == pytest.approx(0.2)


def test_more_subdivisions_come_closer_to_the_distance_of_nonlinear_blends(spaces):
    chosen = {name: spaces[name] for name in ("walk", "hop")}
    errors = []
    truth = parametric(chosen, edges=("walk>hop",), subdivisions=3)
    fine = edge_tables(truth, 0)
    for subdivisions in (0, 1, 2):
        tables = edge_tables(parametric(chosen, edges=("walk>hop",), subdivisions=subdivisions), 0)
        a, b = trellises(tables, 5)
        x, y = trellises(fine, 5)
        rough, best = np.zeros((a.size[0], b.size[0])), np.zeros((a.size[0], b.size[0]))
        dissimilarities(tables, a, b, False, rough)
        dissimilarities(fine, x, y, True, best)
        errors.append(np.abs(rough - best).mean())
    assert errors[1] < 0.4 * errors[0]
    assert errors[2] < 0.4 * errors[1]


def test_fixed_transitions_are_the_best_and_apart(graph):
    edge = find_edge(graph, "walk", "hop")
    tables = edge_tables(graph, edge)
    mine = graph.fixed_edge == edge
    poses, references, cost = graph.fixed_pose[mine], graph.fixed_reference[mine], graph.fixed_cost[mine]
    assert len(poses) == 10
    assert cost[0] == pytest.approx(tables.distance.min() / tables.largest)
    assert (np.diff(cost) >= 0).all()
    gaps = np.abs(poses[:, None] - poses[None]).max(axis=2)
    assert gaps[~np.eye(len(gaps), dtype=bool)].min() >= 2
    out = np.zeros(4)
    one = (tables, poses[:1], references[:1], cost[:1])
    last = int(poses[0, 1])
    assert fixed_transition(*one, int(poses[0, 0]), tables.source.control[references[0, 0]].copy(),
                            last, tables.target.control[references[0, 1]].copy(), 0.1, 5.0, out)  # fmt: skip
    assert out[1:].tolist() == [0, 0, 0]
    if last:
        assert not fixed_transition(*one, 0, np.array([0.5]), last - 1, np.array([0.5]), 0.1, 5.0, out)


def test_edges_are_suggested_where_motions_meet(spaces):
    made = parametric(spaces, blend="linear", subdivisions=0, suggest=0.05)
    pairs = {
        (str(made.spaces[s]), str(made.spaces[t])) for s, t in zip(made.source, made.target, strict=True)
    }
    assert {("walk", "turn"), ("turn", "walk")} <= pairs
    assert made.best.max() <= 0.05
    assert made.core.sum() >= 2
    alone = parametric(spaces, edges=("walk>hop",), blend="linear", subdivisions=0)
    assert not alone.core.any()


def test_errors_say_what_to_do(spaces, graph):
    with pytest.raises(ValueError, match="SOURCE>TARGET"):
        parametric(spaces, edges=("walk>fly",))
    with pytest.raises(ValueError, match="raise suggest"):
        parametric(
            {name: spaces[name] for name in ("walk", "hop")}, blend="linear", subdivisions=0, suggest=0.0
        )
    with pytest.raises(ValueError, match="no edge hop>turn"):
        find_edge(graph, "hop", "turn")
    other = spaces["hop"]._replace(faces=spaces["hop"].faces[:-1])
    with pytest.raises(ValueError, match="one topology"):
        parametric({"walk": spaces["walk"], "hop": other})
