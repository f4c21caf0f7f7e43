import re
from collections.abc import Mapping

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import align
from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import MotionGraph
from reperform.nodes.similarity.vertex_velocity import vertex_velocity
from reperform.nodes.synthesis.animate import animate
from reperform.nodes.synthesis.key_frames import key_frames


@pytest.mark.parametrize(("distance", "duration"), [(4.0, 5.0), (6.0, 5.8), (7.5, 9.0)])
def test_targets_are_met_and_what_is_promised_is_what_is_played(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence], distance: float, duration: float
) -> None:
    path = key_frames(graph, meshes, start="slow:3", end="turn:40", distance=distance, duration=duration)
    assert abs(path.distance[0] - distance) <= 0.05
    assert abs(path.duration[0] - duration) <= 0.08 + 1e-6
    assert path.cost >= path.bound
    assert path.cost - path.bound < 0.05
    played = animate(path, meshes)
    track = played.mesh.vertices[:, :, [0, 2]].astype(float).mean(axis=1)
    assert np.linalg.norm(np.diff(track, axis=0), axis=1).sum() == pytest.approx(path.distance[0], abs=1e-4)
    assert len(track) / 25 == pytest.approx(path.duration[0])
    assert np.linalg.norm(track[-1] - track[0]) == pytest.approx(path.displacement, abs=1e-4)


def test_key_frames_appear_unblended_and_in_order(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    keys = [("slow", 3), ("fast", 30), ("turn", 30), ("slow", 60)]
    texts = [f"{take}:{frame}" for take, frame in keys]
    path = key_frames(graph, meshes, start=texts[0], via=(texts[1], texts[2]), end=texts[3])
    source = path.provenance
    whole = source.weight[:, 0] == 1.0
    shown = [
        int(
            np.flatnonzero(
                whole & (source.takes[source.take[:, 0]] == take) & (source.source_frame[:, 0] == frame)
            )[0]
        )
        for take, frame in keys
    ]
    assert shown == sorted(shown)
    assert shown[0] == 0
    assert shown[-1] == len(whole) - 1
    assert path.cost == pytest.approx(path.bound)
    assert np.isnan(path.distance[1])


def test_weights_trade_time_against_distance(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    wide = {"distance_tolerance": 3.0, "duration_tolerance": 3.0}
    ends = {"start": "slow:3", "end": "turn:40", "distance": 5.3, "duration": 4.1}
    far = key_frames(graph, meshes, **ends, **wide, distance_weight=1000.0, duration_weight=0.0)
    timely = key_frames(graph, meshes, **ends, **wide, distance_weight=0.0, duration_weight=1000.0)
    assert abs(far.distance[0] - 5.3) < abs(timely.distance[0] - 5.3)
    assert abs(timely.duration[0] - 4.1) < abs(far.duration[0] - 4.1)


def test_an_infeasible_target_is_named_with_the_nearest(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    ends = {"start": "slow:3", "end": "turn:40", "distance": 20.0, "duration": 4.0}
    with pytest.raises(ValueError, match=r"nearest that can be met is [\d.]+ m in [\d.]+ s"):
        key_frames(graph, meshes, **ends)
    path = key_frames(graph, meshes, **ends, nearest=True)
    assert abs(path.distance[0] - 20.0) > 0.05 or abs(path.duration[0] - 4.0) > 0.08


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (("slow", "turn:3"), "must read TAKE:FRAME"),
        (("run:3", "turn:3"), "slow, fast, turn"),
        (("slow:70", "turn:3"), "frames 0 .. 69"),
        (("slow:x", "turn:3"), "whole frame number"),
    ],
)
def test_key_frames_that_do_not_exist_are_refused(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence], keys: tuple[str, str], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        key_frames(graph, meshes, start=keys[0], end=keys[1])


def kept(graph: MotionGraph, rows: np.ndarray) -> MotionGraph:
    """Only some of its transitions."""
    edges = ("source", "target", "source_frame", "target_frame", "length", "cost", "yaw", "offset", "core")
    return graph._replace(**{name: np.asarray(getattr(graph, name))[rows] for name in edges})


def named(error: pytest.ExceptionInfo[ValueError]) -> tuple[float, float]:
    """Distance and duration that the message offers."""
    found = re.search(r"nearest that can be met is ([\d.]+) m in ([\d.]+) s: ask for that", str(error.value))
    assert found is not None
    return float(found[1]), float(found[2])


def test_key_frames_that_cannot_be_joined_are_named(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    alone = kept(graph, np.asarray(graph.source) == np.asarray(graph.target))
    with pytest.raises(ValueError, match="no way leads from slow:3 to fast:9"):
        key_frames(alone, meshes, start="slow:3", end="fast:9")


def test_key_frames_in_an_order_without_a_way_back_are_named(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    takes = list(graph.takes)
    onward = (np.asarray(graph.source) == takes.index("slow")) & (
        np.asarray(graph.target) == takes.index("fast")
    )
    ahead = kept(graph, onward)
    assert len(ahead.source) > 0
    path = key_frames(ahead, meshes, start="slow:3", via=("slow:5",), end="fast:57")
    assert path.cost > 0
    with pytest.raises(
        ValueError, match="shows slow:5, slow:3 in this order: no way leads from slow:5 to slow:3"
    ):
        key_frames(ahead, meshes, start="slow:5", end="slow:3")
    with pytest.raises(ValueError, match="no way leads from slow:3 over fast:57 to slow:5"):
        key_frames(ahead, meshes, start="slow:3", via=("fast:57", "slow:5"), end="fast:58")


def test_less_time_than_the_shortest_way_takes_is_named(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    ends = {"start": "slow:3", "via": ("fast:30", "turn:20"), "end": "slow:60"}
    with pytest.raises(ValueError, match=r"covers 0\.4 s within the tolerances") as error:
        key_frames(graph, meshes, **ends, duration=0.4)
    shortest = named(error)[1]
    path = key_frames(graph, meshes, **ends, duration=shortest, duration_tolerance=0.01)
    assert path.duration[0] == pytest.approx(shortest)
    # a frame less is not to be had
    with pytest.raises(ValueError, match="nearest that can be met") as error:
        key_frames(graph, meshes, **ends, duration=shortest - 0.04, duration_tolerance=0.01)
    assert named(error)[1] == shortest
    # and the longest motion considered counts where no time is asked
    with pytest.raises(ValueError, match="raise longest") as error:
        key_frames(graph, meshes, **ends, longest=shortest - 0.2)
    assert named(error)[1] >= shortest


def test_what_is_named_can_be_met(graph: MotionGraph, meshes: Mapping[str, MeshSequence]) -> None:
    ends = {"start": "slow:3", "end": "turn:40"}
    for distance, duration in ((0.3, 8.0), (25.0, 6.0), (0.2, None)):
        with pytest.raises(ValueError, match="nearest that can be met") as error:
            key_frames(graph, meshes, **ends, distance=distance, duration=duration)
        far, late = named(error)
        path = key_frames(graph, meshes, **ends, distance=far, duration=late)
        assert path.distance[0] == pytest.approx(far, abs=2e-3)
        assert path.duration[0] == pytest.approx(late, abs=1e-3)


def test_a_position_further_away_than_the_distance_is_refused(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    ends = {"start": "slow:3", "end": "turn:40", "distance": 4.0, "duration": 5.0}
    away = {"position": (3.0, -4.0)}
    with pytest.raises(
        ValueError, match=r"no motion of 4 m ends 5\.000 m .* 4\.950 m or more, .* 4\.050 m away or less"
    ):
        key_frames(graph, meshes, **ends, **away)
    assert key_frames(graph, meshes, **ends, **away, nearest=True).displacement < 4.05
    assert key_frames(graph, meshes, **ends, position=(0.0, 4.04)).displacement < 4.05


def test_without_transitions_takes_play_as_captured(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    bare = kept(graph, np.zeros(0, int))
    path = key_frames(bare, meshes, start="slow:3", via=("slow:20",), end="slow:60")
    assert path.duration[0] == pytest.approx(58 / 25)
    assert len(path.transition) == 0
    assert path.cost == 0
    with pytest.raises(ValueError, match="nearest that can be met") as error:
        key_frames(bare, meshes, start="slow:3", end="slow:60", duration=5.0)
    assert named(error)[1] == pytest.approx(58 / 25)
    with pytest.raises(ValueError, match="no way leads from slow:3 to fast:9"):
        key_frames(bare, meshes, start="slow:3", end="fast:9")
    with pytest.raises(ValueError, match="no way leads from slow:60 to slow:3"):
        key_frames(bare, meshes, start="slow:60", end="slow:3")


def test_a_take_of_three_frames_plays_but_joins_nothing(meshes: Mapping[str, MeshSequence]) -> None:
    slow, fast = meshes["slow"], meshes["fast"]
    brief = fast._replace(vertices=np.asarray(fast.vertices)[20:23])
    takes = {"slow": slow, "brief": brief}
    similarity = {(a, b): vertex_velocity((takes[a], takes[b])) for a in takes for b in takes}
    joined = surface(similarity, takes, transitions=4)
    path = key_frames(joined, takes, start="brief:0", end="brief:2")
    assert path.duration[0] == pytest.approx(3 / 25)
    with pytest.raises(ValueError, match="no way leads from slow:3 to brief:1"):
        key_frames(joined, takes, start="slow:3", end="brief:1")
    with pytest.raises(ValueError, match=r"nearest that can be met is .* in 0\.12 s"):
        key_frames(joined, takes, start="brief:0", end="brief:2", duration=2.0)


def test_position_and_heading_draw_the_end_to_them(
    graph: MotionGraph, meshes: Mapping[str, MeshSequence]
) -> None:
    ends = {
        "start": "slow:3",
        "end": "turn:40",
        "duration": 7.0,
        "duration_tolerance": 1.0,
        "duration_weight": 0.1,
    }
    free = animate(key_frames(graph, meshes, **ends), meshes).mesh.vertices
    first = free[0]

    def off(vertices: np.ndarray, place: np.ndarray, turn: float) -> tuple[float, float]:
        gone = (vertices[-1] - first).mean(axis=0)[[0, 2]]
        turned = -align(first, vertices[-1])[0].yaw
        return float(np.linalg.norm(gone - place)), float(abs((turned - turn + np.pi) % (2 * np.pi) - np.pi))

    gains: list[float] = []
    for place, turn in (((1.0, 3.0), -1.0), ((-2.0, 2.0), -2.5)):
        path = key_frames(
            graph, meshes, **ends, position=place, heading=turn, position_weight=30.0, heading_weight=10.0
        )
        directed = off(animate(path, meshes).mesh.vertices, np.array(place), turn)
        undirected = off(free, np.array(place), turn)
        gained = 30 * (undirected[0] - directed[0]) + 10 * (undirected[1] - directed[1])
        assert gained >= -1e-6
        gains.append(gained)
        assert path.cost >= 30 * directed[0] + 10 * directed[1] - 0.02
        assert path.cost >= path.bound
    assert max(gains) > 1.0
    with pytest.raises(ValueError, match="position must be x, z in metres"):
        key_frames(graph, meshes, **ends, position=(1.0, 2.0, 3.0))
