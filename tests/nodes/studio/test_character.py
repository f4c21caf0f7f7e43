import numpy as np
import pytest

from reperform.nodes.studio.character import character


@pytest.fixture(scope="module")
def folder(data_folder):
    return data_folder / "characters"


def test_a_pose_clip_is_the_bind_pose(folder):
    """The T pose moves no vertex away from the skin's own bind pose, up to the file's scale and the ground shift."""
    take = character(file=str(folder / "Soldier.glb"), animation="TPose", fps=25, seconds=0.08)
    vertices = take.mesh.vertices[0]
    spread = np.ptp(vertices, axis=0)
    assert 1.6 < spread[1] < 2.0
    assert spread[0] > 1.4
    assert vertices[:, 1].min() == pytest.approx(0, abs=1e-5)
    assert take.texture.image.std() > 20


@pytest.mark.parametrize(
    ("name", "clip", "facing", "speed"),
    [
        ("Soldier", "Walk", np.pi, 1.65),
        ("Knight", "Walking_A", 0.0, 1.0),
        ("human-base-animations", "Walk_Loop", 0.0, 1.2),
    ],
)
def test_a_walking_character_travels_and_plants_its_feet(folder, name, clip, facing, speed):
    take = character(
        file=str(folder / f"{name}.glb"), animation=clip, facing=facing, speed=speed, seconds=1.2, heading=0.5
    )
    assert take.mesh.vertices.shape[0] == 30
    assert take.mesh.faces.max() < take.mesh.vertices.shape[1]
    assert len(take.texture.faces_uv) == len(take.mesh.faces)
    moved = take.mesh.vertices[-1].mean(axis=0) - take.mesh.vertices[0].mean(axis=0)
    direction = moved[[0, 2]] / np.linalg.norm(moved[[0, 2]])
    np.testing.assert_allclose(direction, [np.sin(0.5), np.cos(0.5)], atol=0.1)
    assert take.contacts.planted.any(axis=0).all() and not take.contacts.planted.all()
    lengths = np.linalg.norm(
        take.skeleton.joints[:, 1:] - take.skeleton.joints[:, take.skeleton.parents[1:]], axis=-1
    )
    kept = take.skeleton.parents[1:] > 0
    assert np.median(np.ptp(lengths[:, kept], axis=0)) < 1e-4
    assert (take.skeleton.parents < np.arange(len(take.skeleton.parents))).all()


def test_parts_can_be_left_out_and_height_set(folder):
    path = str(folder / "Knight.glb")
    whole = character(file=path, animation="Idle", seconds=0.1)
    bare = character(
        file=path, animation="Idle", seconds=0.1, stature=1.7, leave_out=["1H_Sword", "2H_Sword"]
    )
    assert len(bare.mesh.faces) < len(whole.mesh.faces)
    assert np.ptp(bare.mesh.vertices[0, :, 1]) == pytest.approx(1.7, abs=1e-3)


def test_a_missing_clip_names_the_nearest(folder):
    with pytest.raises(ValueError, match=r"Soldier\.glb: has no clip 'Wlak'; did you mean 'Walk'\?"):
        character(file=str(folder / "Soldier.glb"), animation="Wlak")


def test_a_truncated_file_is_named(folder, tmp_path):
    short = tmp_path / "short.glb"
    short.write_bytes((folder / "Soldier.glb").read_bytes()[:50000])
    with pytest.raises(
        ValueError, match=r"short\.glb: must have .* bytes by its header, got 50000: it is truncated"
    ):
        character(file=str(short), animation="Walk")
