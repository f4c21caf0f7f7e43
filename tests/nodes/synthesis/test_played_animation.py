import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.played import Played
from reperform.nodes.synthesis.played_animation import played_animation


def _played(shown: np.ndarray, faces: np.ndarray, take, moment, weight) -> Played:
    """Only what provenance is made of; everything else is empty."""
    empty = {name: np.zeros(0) for name in Played._fields}
    mesh = MeshSequence(shown.astype(np.float32), faces, np.array(25.0, np.float32))
    given = {"mesh": mesh, "takes": np.array(["walk", "jump", "idle"]), "take": np.int32(take)}
    return Played(**empty | given | {"source_frame": np.array(moment), "weight": np.array(weight)})


@pytest.fixture
def scene(meshes):
    return {"walk": meshes["slow"], "jump": meshes["turn"]}


def test_captured_frames_are_placed_where_they_were_played(scene):
    places = [Placement(0.7, np.array([1.0, -2.0])), Placement(-2.5, np.array([0.3, 4.0]))]
    own = [("walk", 12), ("jump", 64)]
    shown = np.stack(
        [apply(scene[take].vertices[f], place) for (take, f), place in zip(own, places, strict=True)]
    )
    made = played_animation(
        _played(
            shown, scene["walk"].faces,
            [[0, 1, 0], [0, 1, 0]], [[11.8, 3.0, 5.0], [3.0, 65.0, 5.0]], [[0.6, 0.3, 0.1], [0.2, 0.8, 0.0]],
        ),
        scene,
    ).provenance  # fmt: skip
    assert made.take.tolist() == [[0, 1], [1, 0]]
    assert made.source_frame.tolist() == [[12, 3], [64, 3]]
    np.testing.assert_allclose(made.weight, [[2 / 3, 1 / 3], [0.8, 0.2]], atol=1e-6)
    for f, place in enumerate(places):
        assert made.yaw[f, 0] == pytest.approx(place.yaw, abs=1e-5)
        np.testing.assert_allclose(made.offset[f, 0], place.offset, atol=1e-5)


def test_a_take_that_is_missing_or_differs_is_named(scene):
    played = _played(scene["walk"].vertices[:1], scene["walk"].faces, [[2, 0]], [[0.0, 0.0]], [[1.0, 0.0]])
    with pytest.raises(ValueError, match="'idle' was played and must be given"):
        played_animation(played, scene)
    other = scene["walk"]._replace(faces=scene["walk"].faces[1:])
    with pytest.raises(ValueError, match="idle differs"):
        played_animation(played, {**scene, "idle": other})
