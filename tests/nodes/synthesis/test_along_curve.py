import numpy as np
import pytest

from reperform.nodes.synthesis.along_curve import along_curve

CURVE = ((0.0, 0.0), (0.0, 0.9), (0.45, 1.7), (1.2, 2.1))


@pytest.fixture(scope="module")
def walk(pose_graph, likeness, strides):
    return along_curve(pose_graph, likeness, strides, curve=CURVE, distance_weight=1.0)


def test_the_body_follows_the_curve_to_its_end(walk):
    off = np.linalg.norm((walk.middle - walk.wanted)[:, [0, 2]], axis=1)
    assert np.sqrt(np.square(off).mean()) < 0.12
    assert np.linalg.norm(walk.middle[-1, [0, 2]] - CURVE[-1]) < 0.25
    np.testing.assert_allclose(walk.middle[0, [0, 2]], CURVE[0], atol=1e-9)
    assert walk.bound <= walk.cost


def test_depth_first_search_does_no_better_for_all_its_moves(pose_graph, likeness, strides, walk):
    blind = along_curve(
        pose_graph,
        likeness,
        strides,
        curve=CURVE,
        distance_weight=1.0,
        search="depth_first",
        expansions=200_000,
    )
    assert walk.cost <= blind.cost


def test_prescribed_actions_fill_their_stretches(pose_graph, likeness, strides):
    walk = along_curve(
        pose_graph, likeness, strides, curve=CURVE, actions=("0-0.5 ahead", "1.4-2 r*"), distance_weight=0.2
    )
    ground = walk.middle[:, [0, 2]]
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(ground, axis=0), axis=1))])
    heavier = walk.weight.argmax(axis=1)
    shown = walk.takes[walk.take[np.arange(len(heavier)), heavier]]
    assert set(shown[arc < 0.5]) == {"ahead"}
    assert set(shown[(arc > 1.4) & (arc < 2)]) == {"right"}


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"actions": ("0-1 crawl",)}, "no take is called crawl, there are ahead, left, right"),
        ({"actions": ("0..1 left",)}, "must read FROM-TO TAKE"),
        ({"curve": ((0.0, 0.0),)}, "at least two points"),
        ({"start": "left:99"}, "take left has frames"),
    ],
)
def test_wrong_requests_are_refused(pose_graph, likeness, strides, request_, message):
    with pytest.raises(ValueError, match=message):
        along_curve(pose_graph, likeness, strides, **{"curve": CURVE, **request_})
