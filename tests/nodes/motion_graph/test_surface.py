import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, align, apply
from reperform.nodes.motion_graph.surface import surface
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity, MotionGraph
from reperform.nodes.similarity.vertex_velocity import vertex_velocity

Scene = tuple[dict[tuple[str, str], Dissimilarity], dict[str, MeshSequence]]


def _take(frames: int, phase: float, yaw: float, offset: tuple[float, float]) -> MeshSequence:
    """A tetrahedral fan of points that swings with period 16 frames and walks along its z."""
    rest = np.random.default_rng(9).normal(size=(30, 3)) * [0.3, 0.8, 0.2]
    angle = 2 * np.pi * (np.arange(frames) + phase) / 16
    out = np.repeat(rest[None], frames, axis=0)
    out[:, :, 2] += 0.3 * np.sin(angle)[:, None] * rest[:, 1] + 0.04 * np.arange(frames)[:, None]
    placed = apply(out, Placement(yaw, np.array(offset)))
    faces = np.array([[0, 1, 2], [1, 3, 2]], np.int32)
    return MeshSequence(placed.astype(np.float32), faces, np.asarray(25.0, np.float32))


@pytest.fixture(scope="module")
def scene() -> Scene:
    meshes = {"a": _take(50, 0.0, 0.3, (0.2, 1.0)), "b": _take(44, 5.0, 2.0, (-1.0, 0.4))}
    return {(p, q): vertex_velocity((meshes[p], meshes[q])) for p in meshes for q in meshes}, meshes


def _rows(graph: MotionGraph) -> list[tuple[str, int, str, int]]:
    return [
        (str(graph.takes[s]), int(m), str(graph.takes[t]), int(n))
        for s, m, t, n in zip(graph.source, graph.source_frame, graph.target, graph.target_frame, strict=True)
    ]


def test_transitions_join_equal_phases(scene: Scene) -> None:
    graph = surface(*scene)
    rows = _rows(graph)
    assert {(p, q) for p, _, q, _ in rows} == {("a", "a"), ("a", "b"), ("b", "a"), ("b", "b")}
    phase = {"a": 0, "b": 5}
    for p, m, q, n in rows:
        assert (m + phase[p] - n - phase[q]) % 16 in (0, 1, 15)
        assert p != q or m != n
    counts = [rows.count(row) for row in rows]
    assert max(counts) == 1
    assert len(rows) <= 16
    assert graph.core.any()
    lengths = graph.length
    assert (graph.source_frame - lengths >= 0).all()
    assert (graph.target_frame + lengths < graph.frames[graph.target]).all()


def test_placements_lay_the_target_on_the_source(scene: Scene) -> None:
    graph, meshes = surface(*scene), scene[1]
    for k, (p, m, q, n) in enumerate(_rows(graph)):
        placed = apply(meshes[q].vertices[n], Placement(float(graph.yaw[k]), graph.offset[k]))
        gap = np.linalg.norm(placed - meshes[p].vertices[m], axis=1).max()
        assert gap < 0.12
        best, _ = align(meshes[p].vertices[m], meshes[q].vertices[n])
        assert abs(best.yaw - graph.yaw[k]) < 0.1


def test_costs_are_shares_of_the_largest_dissimilarity(scene: Scene) -> None:
    similarity, meshes = scene
    graph = surface(similarity, meshes)
    largest = max(float(product.distance.max()) for product in similarity.values())
    k = int(np.argmax(graph.cost))
    p, m, q, n = _rows(graph)[k]
    length = int(graph.length[k])
    window = np.arange(-length, length + 1)
    weights = length - np.abs(window)
    values = similarity[p, q].distance[m + window, n + window]
    assert graph.cost[k] == pytest.approx(weights @ values / weights.sum() / largest, rel=1e-5)


def test_edits(scene: Scene) -> None:
    everything = _rows(surface(*scene))
    without = _rows(surface(*scene, remove=("a>b",)))
    assert without == [row for row in everything if (row[0], row[2]) != ("a", "b")]
    assert {row[0] + row[2] for row in _rows(surface(*scene, only=("a>b", "b>a")))} == {"ab", "ba"}
    assert {row[0] + row[2] for row in _rows(surface(*scene, self_transitions=False))} == {"ab", "ba"}
    forbidden = surface(*scene, forbid=("a:20-25",))
    for source, target, m, n, length in zip(
        forbidden.source, forbidden.target, forbidden.source_frame, forbidden.target_frame, forbidden.length,
        strict=True,
    ):  # fmt: skip
        for take, frame in ((source, m), (target, n)):
            if take == 0:
                assert frame + length <= 20 or frame - length >= 25


def test_a_single_take_loops() -> None:
    meshes = {"only": _take(60, 0.0, 0.0, (0.0, 0.0))}
    graph = surface({("only", "only"): vertex_velocity((meshes["only"], meshes["only"]))}, meshes)
    assert graph.core.any()
    assert (np.abs(graph.source_frame - graph.target_frame) >= 10).all()


def test_what_cannot_be_joined_is_said(scene: Scene) -> None:
    similarity, meshes = scene
    with pytest.raises(ValueError, match="no transition"):
        surface(similarity, meshes, threshold=0.0)
    with pytest.raises(ValueError, match="no transition"):
        surface(similarity, meshes, shortest=2.0, longest=2.0)
    with pytest.raises(ValueError, match="must not be below"):
        surface(similarity, meshes, shortest=0.5, longest=0.2)
    with pytest.raises(ValueError, match="names take 'c'"):
        surface(similarity, meshes, remove=("c>a",))
    with pytest.raises(ValueError, match="one topology; b differs from a"):
        surface(similarity, {**meshes, "b": meshes["b"]._replace(faces=meshes["b"].faces[::-1])})
    with pytest.raises(ValueError, match="one frame rate"):
        surface(similarity, {**meshes, "b": meshes["b"]._replace(fps=np.asarray(30.0, np.float32))})
    with pytest.raises(ValueError, match="matrix a, a must be"):
        surface(similarity, {**meshes, "a": meshes["a"]._replace(vertices=meshes["a"].vertices[:-1])})


def test_a_take_of_three_frames_joins_nothing_and_is_said(scene: Scene) -> None:
    short = {"only": _take(3, 0.0, 0.0, (0.0, 0.0))}
    matrix = vertex_velocity((short["only"], short["only"]))
    with pytest.raises(ValueError, match=r"no transition among takes only .* use longer takes"):
        surface({("only", "only"): matrix}, short)
    meshes = {**scene[1], "c": _take(3, 2.0, 0.0, (0.0, 0.0))}
    graph = surface({(p, q): vertex_velocity((meshes[p], meshes[q])) for p in meshes for q in meshes}, meshes)
    assert graph.takes.tolist() == ["a", "b", "c"]
    assert 2 not in graph.source
    assert 2 not in graph.target
