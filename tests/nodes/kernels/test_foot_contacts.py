from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.products.performance import Performance
from reperform.nodes.studio.perform import perform


@pytest.fixture(scope="module")
def walk() -> Performance:
    return perform(motion="walk", costume="skirt", seconds=1.8, heading=0.7)


def agreement(walk: Performance, vertices: np.ndarray) -> np.ndarray:
    found = foot_contacts([vertices], walk.mesh.faces, 25.0)
    assert found.foot.max() == 1
    return np.asarray((found.planted[0] == walk.contacts.planted).mean(axis=0))


def test_it_finds_the_contacts_of_an_actor_who_knows_them_left_first(walk: Performance) -> None:
    assert agreement(walk, walk.mesh.vertices).min() >= 0.9


def test_noise_of_the_surface_does_not_disturb_it(walk: Performance) -> None:
    noise = np.random.default_rng(3).normal(0.0, 0.004, walk.mesh.vertices.shape).astype(np.float32)
    assert agreement(walk, walk.mesh.vertices + noise).min() >= 0.85


def test_soles_lie_under_the_ball_of_each_foot(walk: Performance) -> None:
    found = foot_contacts([walk.mesh.vertices], walk.mesh.faces, 25.0)
    names = walk.skeleton.names.tolist()
    for k, name in enumerate(("left_toe", "right_toe")):
        toe = walk.skeleton.joints[:, names.index(name)]
        sole = walk.mesh.vertices[:, found.foot == k].mean(axis=1)
        assert np.linalg.norm((sole - toe)[:, [0, 2]], axis=1).max() < 0.09


def test_where_the_stage_is_and_how_it_is_turned_says_nothing(walk: Performance) -> None:
    moved = apply(walk.mesh.vertices, Placement(2.1, np.array([3.0, -1.0])))
    here = foot_contacts([walk.mesh.vertices], walk.mesh.faces, 25.0)
    there = foot_contacts([moved + np.float32([0, 0.015, 0])], walk.mesh.faces, 25.0)
    np.testing.assert_array_equal(here.foot, there.foot)
    np.testing.assert_array_equal(here.planted[0], there.planted[0])


def test_mirrored_left_is_right(walk: Performance) -> None:
    mirrored = walk.mesh.vertices * np.float32([-1, 1, 1])
    here = foot_contacts([walk.mesh.vertices], walk.mesh.faces, 25.0)
    there = foot_contacts([mirrored], walk.mesh.faces[:, ::-1], 25.0)
    np.testing.assert_array_equal(here.planted[0][:, ::-1], there.planted[0])


def test_what_never_rests_has_no_feet(walk: Performance) -> None:
    drift = np.arange(len(walk.mesh.vertices), dtype=np.float32)[:, None, None] * np.float32([0.1, 0, 0.02])
    found = foot_contacts([walk.mesh.vertices[:1] + drift], walk.mesh.faces, 25.0)
    assert found.foot.max() == -1
    assert found.planted[0].shape == (len(walk.mesh.vertices), 0)


def test_a_captured_dancer_in_a_skirt_stands_on_two_feet(data_folder: Path) -> None:
    with np.load(data_folder / "sequences" / "samba.npz") as stored:
        vertices, faces = stored["vertices"], stored["faces"]
    found = foot_contacts([vertices[:80], vertices[80:]], faces, 25.0)
    assert found.foot.max() == 1
    rests = np.concatenate(found.planted)
    assert rests.any(axis=1).mean() > 0.95
    assert 0.5 < rests.mean() < 0.95
    assert (vertices[:, found.foot >= 0, 1].min(axis=0) < 0.07).all()


def test_soles_of_a_clothed_walker_lie_on_the_feet_as_labelled(data_folder: Path) -> None:
    with np.load(data_folder / "twin" / "watertight.npz") as stored:
        walk, faces = stored["walk"].astype(np.float32), stored["faces"]
        part = stored["label_names"][stored["labels"]]
    found = foot_contacts([walk], faces, 25.0)
    assert set(part[found.foot == 0]) == {"foot_l"}
    assert set(part[found.foot == 1]) == {"foot_r"}
    # a walk: never two feet in the air, and each in the air for a part of the time
    early = found.planted[0][:50]
    assert early.any(axis=1).mean() > 0.9
    assert (early.mean(axis=0) < 0.8).all()


def test_takes_of_different_meshes_are_refused(walk: Performance) -> None:
    with pytest.raises(ValueError, match=r"must be \(T, V, 3\) with one V"):
        foot_contacts([walk.mesh.vertices, walk.mesh.vertices[:, 1:]], walk.mesh.faces, 25.0)
