import numpy as np
import pytest

from reperform.nodes.kernels.curve_reach import curve_reach
from reperform.nodes.kernels.curve_walk import Curve, Starts, curve_walk, remaining_cost, trail
from reperform.nodes.kernels.depth_first_walk import depth_first_walk
from reperform.nodes.kernels.graph_moves import graph_moves, play_moves
from reperform.nodes.kernels.ground_plane import Placement, apply

RANDOM = np.random.default_rng(11)
POSE = RANDOM.normal(size=(12, 3)) * (0.2, 0.5, 0.3)
FRAMES = 9


def take(speed, turn, heading):
    place, frames = np.zeros(2), []
    for _ in range(FRAMES):
        frames.append(apply(POSE, Placement(heading, place.copy())))
        place = place + speed * np.array([np.sin(heading), np.cos(heading)])
        heading += turn
    return np.stack(frames)


def path(source, target, length=4):
    return np.column_stack([source + np.arange(length), target - length + 1 + np.arange(length)])


@pytest.fixture(scope="module")
def moves():
    takes = [take(0.06, 0.0, 0.3), take(0.06, 0.07, -1.0), take(0.06, -0.06, 2.0)]
    edges = []
    for a in range(3):
        for b in range(3):
            source, target = FRAMES * a + 5, FRAMES * b + 3
            edges.append((source, target, 0.3 + 0.1 * a + 0.05 * b, path(source, target)))
    return graph_moves(takes, edges, 0.05)


def bend(turn: float, length: float, allowed=None, step=0.01) -> Curve:
    """A curve that turns evenly."""
    heading = turn * step * np.arange(int((length + 1) / step))
    points = np.concatenate(
        [np.zeros((1, 2)), np.cumsum(step * np.column_stack([np.sin(heading), np.cos(heading)]), axis=0)]
    )
    return Curve(
        points, step, length, np.ones((3, len(points)), bool) if allowed is None else allowed(len(points))
    )


def starts(moves, frames=(0, FRAMES, 2 * FRAMES)) -> Starts:
    rows = []
    for frame in frames:
        p = moves.first[moves.leaving[frame]]
        way = moves.middle[p + 1] - moves.middle[p]
        yaw = -np.arctan2(way[0], way[2])
        offset = -apply(moves.middle[p], Placement(yaw, np.zeros(2)))[[0, 2]]
        rows.append((frame, yaw, offset))
    return Starts(
        np.array([row[0] for row in rows]), np.array([row[1] for row in rows]), np.array([row[2] for row in rows]),
        np.zeros((len(rows), 2)),
    )  # fmt: skip


@pytest.mark.parametrize(("turn", "length"), [(0.9, 0.9), (-0.8, 1.1), (0.0, 1.3)])
def test_it_finds_what_going_through_all_walks_finds(moves, turn, length):
    curve = bend(turn, length)
    problem, rest, begin = trail(moves, curve, 2.0), remaining_cost(moves, curve), starts(moves)
    walk = curve_walk(problem, rest, begin, 10_000)
    every, done = depth_first_walk(problem, rest, begin, 20_000_000)
    assert done
    np.testing.assert_allclose(walk.cost, every.cost, rtol=0.02)
    assert walk.cost >= every.cost - 1e-9
    blind, done = depth_first_walk(problem, None, begin, 20_000_000)
    assert done
    np.testing.assert_allclose(blind.cost, every.cost)
    bounded, done = depth_first_walk(problem, rest, begin, 20_000_000, reach=curve_reach(moves, 12))
    assert done
    np.testing.assert_allclose(bounded.cost, every.cost)
    assert bounded.expanded <= every.expanded


def test_depth_first_search_stops_where_it_is_told_to(moves):
    curve = bend(0.9, 0.9)
    problem, rest, begin = trail(moves, curve, 2.0), remaining_cost(moves, curve), starts(moves)
    every, _ = depth_first_walk(problem, rest, begin, 20_000_000)
    early, done = depth_first_walk(problem, None, begin, 20_000_000, enough=1.5 * every.cost)
    whole, _ = depth_first_walk(problem, None, begin, 20_000_000)
    assert not done
    assert every.cost <= early.cost <= 1.5 * every.cost
    assert early.expanded < whole.expanded
    same, _ = depth_first_walk(problem, rest, begin, 20_000_000, below=every.cost * (1 + 1e-9))
    np.testing.assert_allclose(same.cost, every.cost)
    assert depth_first_walk(problem, rest, begin, 20_000_000, below=every.cost * (1 - 1e-9)) == (None, True)


def test_a_crowded_stretch_costs_no_less_and_follows_fewer(moves):
    curve = bend(0.9, 1.1)
    problem, rest, begin = trail(moves, curve, 2.0), remaining_cost(moves, curve), starts(moves)
    free, crowded = (curve_walk(problem, rest, begin, beam) for beam in (10_000, 3))
    assert crowded.expanded < free.expanded
    assert crowded.cost >= free.cost - 1e-9


def test_bodies_that_stand_may_set_out_any_way_for_all_the_few_that_are_followed(moves):
    # all but the last of these placements face away from the curve
    curve, one = bend(0.0, 0.9), starts(moves, (0,))
    turned = [np.pi, 2.6, -2.6, 2.2, -2.2, 1.8, -1.8, 0.0]
    middle = moves.middle[moves.first[moves.leaving[0]]]
    offset = np.stack([-apply(middle, Placement(one.yaw[0] + t, np.zeros(2)))[[0, 2]] for t in turned])
    begin = Starts(
        np.zeros(len(turned), int), one.yaw[0] + np.array(turned), offset, np.zeros((len(turned), 2))
    )
    problem, rest = trail(moves, curve, 2.0), remaining_cost(moves, curve)
    assert curve_walk(problem, rest, begin, 4).start == len(turned) - 1


def test_the_bound_is_under_every_walk_and_meets_it_where_the_curve_costs_nothing(moves):
    curve = bend(0.4, 1.0)
    rest, begin = remaining_cost(moves, curve), starts(moves)
    free, _ = depth_first_walk(trail(moves, curve, 0.0), rest, begin, 20_000_000)
    least = rest[0, begin.frame].min()
    assert least <= free.cost + 1e-9
    assert least > 0.85 * free.cost


def test_the_walk_costs_what_its_frames_say(moves):
    curve = bend(0.9, 1.0)
    begin = starts(moves)
    walk = curve_walk(trail(moves, curve, 2.0), remaining_cost(moves, curve), begin, 10_000)
    played = play_moves(moves, walk.chain, begin.yaw[walk.start], begin.offset[walk.start])
    ground = played.middle[:, [0, 2]]
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(ground, axis=0), axis=1))])
    at = np.stack(
        [np.interp(arc, curve.step * np.arange(len(curve.points)), curve.points[:, k]) for k in range(2)], 1
    )
    off = np.linalg.norm(ground - at, axis=1)[1:].sum()
    np.testing.assert_allclose(moves.cost[list(walk.chain)].sum() + 2.0 * off, walk.cost, rtol=1e-6)
    assert arc[-1] >= curve.length


def test_only_what_is_allowed_is_played(moves):
    def right_turns_from_there_on(count):
        allowed = np.ones((3, count), bool)
        allowed[2, :38] = False
        allowed[:2, 41:] = False
        return allowed

    curve = bend(0.0, 1.2, right_turns_from_there_on)
    begin = starts(moves)
    walk = curve_walk(trail(moves, curve, 2.0), remaining_cost(moves, curve), begin, 10_000)
    played = play_moves(moves, walk.chain, begin.yaw[walk.start], begin.offset[walk.start])
    main = played.take[np.arange(len(played.take)), played.weight.argmax(axis=1)]
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(played.middle[:, [0, 2]], axis=0), axis=1))])
    assert (main[(arc > 0.411) & (arc < 1.2)] == 2).all()
    assert (main[(arc > 0.0) & (arc < 0.379)] != 2).all()


def test_no_walk_where_nothing_is_allowed(moves):
    curve = bend(0.0, 1.0, lambda count: np.zeros((3, count), bool))
    assert curve_walk(trail(moves, curve, 2.0), remaining_cost(moves, curve), starts(moves), 100) is None
