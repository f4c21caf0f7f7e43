from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.performance import Performance
from reperform.nodes.skeleton.joints import joints
from reperform.nodes.skeleton.part_labels import part_labels as marked
from reperform.nodes.studio.part_labels import part_labels
from reperform.nodes.studio.perform import perform
from reperform.nodes.studio.twin import twin


@pytest.fixture(scope="module")
def walk() -> Performance:
    return perform(motion="walk", costume="jacket", seconds=0.8, heading=-0.6)


def test_rings_are_where_the_limbs_bend(walk: Performance) -> None:
    found = joints(walk.mesh, part_labels(costume="jacket"), place="ring", root="hips")
    names, true = found.names.tolist(), walk.skeleton.names.tolist()
    for name in ("left_forearm", "right_hand", "left_shin", "right_shin", "right_foot", "chest"):
        gap = found.joints[:, names.index(name)] - walk.skeleton.joints[:, true.index(name)]
        assert np.linalg.norm(gap, axis=1).max() < 0.045, name
        parent = found.parents[names.index(name)]
        assert names[parent] == true[walk.skeleton.parents[true.index(name)]]
    assert (found.parents < np.arange(len(names))).all()


def test_centres_lie_along_their_bones(walk: Performance) -> None:
    found = joints(walk.mesh, part_labels(costume="jacket"), root="hips")
    names, true = found.names.tolist(), walk.skeleton.names.tolist()
    a, b = (walk.skeleton.joints[:, true.index(name)] for name in ("left_shin", "left_foot"))
    centre = found.joints[:, names.index("left_shin")]
    along = np.einsum("tk,tk->t", centre - a, b - a) / np.einsum("tk,tk->t", b - a, b - a)
    assert ((along > 0.3) & (along < 0.7)).all()
    assert np.linalg.norm(centre - a - along[:, None] * (b - a), axis=1).max() < 0.03


@pytest.mark.parametrize("place", ["centre", "ring"])
def test_the_skeleton_moves_with_the_mesh(walk: Performance, place: str) -> None:
    labels, placement = part_labels(costume="jacket"), Placement(1.2, np.array([2.0, -3.0]))
    here = joints(walk.mesh, labels, place=place)
    there = joints(walk.mesh._replace(vertices=apply(walk.mesh.vertices, placement)), labels, place=place)
    np.testing.assert_allclose(apply(here.joints, placement), there.joints, atol=2e-5)


def test_the_marks_of_the_twin_make_its_skeleton(data_folder: Path) -> None:
    person = twin(folder=str(data_folder / "twin"), clip="walk", watertight=True, frames=3)
    labels = marked(file=str(data_folder / "twin" / "watertight.npz"))
    found = joints(person.mesh, labels, place="ring")
    names = found.names.tolist()
    chains = {"hand_l": "forearm_l", "forearm_l": "upper_arm_l", "foot_r": "shin_r", "shin_r": "thigh_r"}
    assert {name: names[found.parents[names.index(name)]] for name in chains} == chains
    assert names[0] == "torso"
    knees = found.joints[:, [names.index("shin_l"), names.index("shin_r")]]
    nearest = np.linalg.norm(knees[:, :, None] - person.skeleton.joints[:, None], axis=3).min(axis=2)
    assert nearest.max() < 0.05


def test_labels_of_another_mesh_and_an_unknown_root_are_refused(walk: Performance) -> None:
    labels = part_labels(costume="jacket")
    with pytest.raises(ValueError, match="must be of the mesh's topology"):
        joints(walk.mesh, labels._replace(label=labels.label[:-1]))
    with pytest.raises(ValueError, match="root 'tail' must be one of hips"):
        joints(walk.mesh, part_labels(costume="jacket"), root="tail")
