import numpy as np
import pytest

from reperform.nodes.motion_graph.pose_edges import complete_digraph, pose_graph
from reperform.nodes.products.essential import PathCosts, PoseGraph, PoseTransitions
from reperform.viewer.palette import ACCENT, rgb
from reperform.viewer.pictures import Look, picture

LOOK = Look(size=(640, 320))


def transitions() -> dict[tuple[str, str], PoseTransitions]:
    rng = np.random.default_rng(3)
    frames = {"walk": 7, "high_jump": 5}

    def pair(rows: int, columns: int) -> PoseTransitions:
        length = np.full((rows, columns), 4, np.int32)
        deformation = rng.uniform(0.1, 1.0, size=(rows, columns)).astype(np.float32)
        return PoseTransitions(
            deformation, length + 1, length, length, np.array(0.1), np.array(25, np.float32)
        )

    return {(a, b): pair(frames[a], frames[b]) for a in frames for b in frames}


def graph(*edges: tuple[int, int]) -> PoseGraph:
    source, target = (np.array(ends, np.int32) for ends in zip(*edges, strict=True))
    return pose_graph(complete_digraph(transitions(), "test"), source, target)


@pytest.mark.parametrize("size", [(640, 320), (300, 420), (160, 120)])
def test_graphs_have_a_picture_of_any_size(size):
    drawn = picture(graph((0, 1), (1, 9), (9, 2)), 0, Look(size=size))
    assert (drawn.shape, drawn.dtype) == ((size[1], size[0], 3), np.uint8)


def test_captured_frames_and_blended_ones_look_apart():
    def accents(drawn: np.ndarray) -> int:
        return int((np.abs(drawn.astype(int) - rgb(ACCENT)).max(axis=-1) < 12).sum())

    played = accents(picture(graph((0, 1), (1, 2), (2, 3)), 0, LOOK))
    blended = accents(picture(graph((0, 8), (1, 9), (2, 10)), 0, LOOK))
    assert played > 3 > blended


def test_transitions_have_a_picture():
    drawn = picture(transitions()["walk", "high_jump"], 0, LOOK)
    assert drawn.shape == (320, 640, 3)
    assert np.ptp(drawn) > 60


def test_a_panel_is_drawn_for_every_database():
    rising = np.linspace(0.1, 3.0, 50)
    cost = np.stack([np.stack([k * rising, 0.5 * k * rising, 0.6 * k * rising], 1) for k in (1, 2, 3)])
    curves = PathCosts(
        np.array(["demo", "samba", "twin"]),
        np.full(3, 0.1),
        np.full(3, 900, np.int32),
        cost.astype(np.float32),
    )
    drawn = picture(curves, 0, Look(size=(900, 600)))
    assert drawn.shape == (600, 900, 3)
    quarters = [drawn[:300, :450], drawn[:300, 450:], drawn[300:, :450], drawn[300:, 450:]]
    inked = [int((quarter.min(axis=-1) < 120).sum()) for quarter in quarters]
    assert min(inked[:3]) > 5 * inked[3]
