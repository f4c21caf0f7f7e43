import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import Placement, apply
from reperform.nodes.kernels.picture_error import psnr
from reperform.nodes.products.cameras import CameraPath
from reperform.nodes.products.motion import Animation, Provenance
from reperform.nodes.products.played import Played
from reperform.nodes.synthesis.played_animation import played_animation
from reperform.nodes.texture.orbit import circle
from reperform.nodes.texture.render import render, sources

TAKES = np.array(["still", "lean"])


def provenance(weight, frame=(0, 1), take=(0, 1), yaw=(0.0, 0.0), offset=((0, 0), (0, 0))) -> Provenance:
    return Provenance(
        TAKES,
        np.int32(take),
        np.int32(frame),
        np.float32([weight, 1 - weight]),
        np.float32(yaw),
        np.float32(offset),
    )


def dataset(scene):
    return [
        {name: part for name in TAKES.tolist()}
        for part in (scene.mesh, scene.footage, scene.mattes, scene.cameras)
    ]


def camera(middle, angle: float, size: tuple[int, int] = (220, 260)) -> CameraPath:
    path = circle(
        np.asarray(middle)[None], np.radians([angle]), radius=2.5, height=1.3, field_of_view=52, size=size
    )
    return CameraPath(path.matrix[0], path.rotation[0], path.translation[0], path.image_size)


def animation(scene, vertices, source) -> Animation:
    return Animation(scene.mesh._replace(vertices=np.asarray(vertices, np.float32)), source)


def test_a_placed_capture_looks_as_it_did_from_the_placed_camera(scene):
    """Turning and moving performer and camera together changes no pixel of the performer."""
    place = Placement(2.1, np.array([3.0, -1.5]))
    middle = np.array([0.3, 0.9, -0.2])
    there = apply(middle[None], place)[0]
    rest = render(
        animation(scene, scene.mesh.vertices[0], provenance(1.0)),
        camera(middle, 40),
        *dataset(scene),
        grid=0.0,
    )
    moved = render(
        animation(
            scene,
            apply(scene.mesh.vertices[0].astype(np.float64), place),
            provenance(1.0, yaw=(2.1, 0), offset=((3.0, -1.5), (0, 0))),
        ),
        camera(there, 40 + np.degrees(2.1)),
        *dataset(scene),
        grid=0.0,
    )
    both = (rest.coverage == 255) & (moved.coverage == 255)
    assert both.sum() > 3000
    assert (np.abs(rest.coverage.astype(int) - moved.coverage) > 60).sum() < 10
    difference = np.abs(rest.images[both].astype(int) - moved.images[both])
    assert np.percentile(difference, 99.5) <= 3


@pytest.mark.parametrize("alignment", ["none", "dis", "farneback"])
def test_a_new_pose_between_two_captured_ones_is_near_the_truth(scene, alignment):
    vertices = 0.6 * scene.mesh.vertices[0] + 0.4 * scene.mesh.vertices[1]
    view = camera(vertices.mean(axis=0), 95)
    film = render(animation(scene, vertices, provenance(0.6)), view, *dataset(scene), alignment=alignment)
    truth, alpha = scene.truth(vertices, (view.matrix, view.rotation, view.translation), 260, 220, (0, 0, 0))
    assert psnr(film.images, truth, alpha == 255) > 32


def test_what_a_character_plays_looks_as_its_sources_were_filmed(scene):
    """Two takes blended between whole frames, anywhere on the ground: from the record of the play alone."""
    place = Placement(-1.3, np.array([2.0, 0.7]))
    vertices = apply(0.6 * scene.mesh.vertices[0] + 0.4 * scene.mesh.vertices[1].astype(np.float64), place)
    empty = {name: np.zeros(0) for name in Played._fields}
    record = {
        "mesh": scene.mesh._replace(vertices=vertices[None].astype(np.float32)),
        "takes": TAKES,
        "take": np.int32([[1, 0, 0]]),
        "source_frame": np.array([[0.8, 0.1, 0.0]]),
        "weight": np.array([[0.38, 0.57, 0.05]]),
    }
    meshes, footage, mattes, cameras = dataset(scene)
    made = played_animation(Played(**empty | record), meshes)
    one = Animation(
        scene.mesh._replace(vertices=made.mesh.vertices[0]),
        Provenance(TAKES, *(x[0] for x in made.provenance[1:])),
    )
    view = camera(vertices.mean(axis=0), 20)
    film = render(one, view, meshes, footage, mattes, cameras)
    truth, alpha = scene.truth(vertices, (view.matrix, view.rotation, view.translation), 260, 220, (0, 0, 0))
    assert (alpha == 255).sum() > 3000
    assert psnr(film.images, truth, alpha == 255) > 32


def test_end_points_are_the_captured_renders_exactly(scene):
    view = camera([0.3, 0.9, -0.2], 95)
    for k in range(2):
        vertices = scene.mesh.vertices[k]
        alone = render(animation(scene, vertices, provenance(1.0, frame=(k, k))), view, *dataset(scene))
        end = render(animation(scene, vertices, provenance(1.0 - k)), view, *dataset(scene))
        np.testing.assert_array_equal(alone.images, end.images)


def test_two_names_for_one_source_are_one_source(scene):
    split = provenance(0.3, frame=(1, 1), take=(0, 0))
    assert sources(split) == [("still", 1, pytest.approx(1.0), 0.0)]


def test_refusals_name_the_take(scene):
    view = camera([0.3, 0.9, -0.2], 95)
    vertices = scene.mesh.vertices[0]
    meshes, footage, mattes, cameras = dataset(scene)
    with pytest.raises(ValueError, match="take 'lean' must be in the meshes, got \\['still'\\]"):
        render(
            animation(scene, vertices, provenance(0.5)),
            view,
            {"still": meshes["still"]},
            footage,
            mattes,
            cameras,
        )
    with pytest.raises(ValueError, match="frame 7 of take 'still' must be under 2"):
        render(
            animation(scene, vertices, provenance(1.0, frame=(7, 0))), view, meshes, footage, mattes, cameras
        )
    other = {name: mesh._replace(faces=mesh.faces[1:]) for name, mesh in meshes.items()}
    with pytest.raises(ValueError, match="the animation's topology"):
        render(animation(scene, vertices, provenance(1.0)), view, other, footage, mattes, cameras)
    with pytest.raises(ValueError, match="positive weight"):
        sources(provenance(1.0)._replace(weight=np.zeros(2)))
