import numpy as np
import pytest

from reperform.nodes.studio.actor import build_actor
from reperform.nodes.studio.actor_skeleton import NAMES, REST_JOINTS
from reperform.nodes.studio.part_labels import part_labels


@pytest.mark.parametrize("costume", ["jacket"])
def test_every_vertex_has_a_part_near_its_bone(costume: str) -> None:
    labels = part_labels(costume=costume)
    actor = build_actor(costume)
    assert labels.names.tolist() == list(NAMES)
    assert len(labels.label) == len(actor.vertices)
    for name in ("left_hand", "right_forearm", "head", "left_toe"):
        part = actor.vertices[labels.label == NAMES.index(name)]
        assert np.linalg.norm(part.mean(axis=0) - REST_JOINTS[NAMES.index(name)]) < 0.16
        assert (
            np.sign(part[:, 0]) == {"left": 1, "right": -1}.get(name.split("_")[0], 0)
        ).all() or name == "head"
