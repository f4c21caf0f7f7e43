from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from reperform.nodes.products.motion import MotionPath
from reperform.viewer.pictures import Look, View, matrices_picture, overview, picture, png
from reperform.viewer.pictures.motion_path import ground_track
from reperform.viewer.pictures.scene import sample_atlas
from reperform.viewer.pictures.skeleton import skeleton_bodies
from reperform.viewer.pictures.tabulate import number

LOOK = Look(size=(360, 240))
NAMES = [
    "footage",
    "plate",
    "mattes",
    "film",
    "occupancy",
    "surfaces",
    "mesh",
    "performance",
    "skeleton",
    "mocap",
    "skeletal_animation",
    "cameras",
    "orbit",
    "matrix",
    "comparison",
    "graph",
    "path",
    "tree",
    "table",
    "contacts",
    "target_grid",
    "key_frame_table",
    "pruned",
]


@pytest.mark.parametrize("name", NAMES)
def test_every_product_has_a_picture_of_the_size_asked(name: str, products: dict[str, Any]) -> None:
    drawn = picture(products[name], 0, LOOK)
    assert (drawn.shape, drawn.dtype) == ((240, 360, 3), np.uint8)
    assert np.ptp(drawn) > 60
    assert np.array_equal(drawn, picture(products[name], 0, LOOK))


@pytest.mark.parametrize("name", ["mesh", "film", "performance"])
def test_overviews(name: str, products: dict[str, Any]) -> None:
    assert overview(products[name], LOOK).shape == (240, 360, 3)


def test_a_frame_that_is_not_there_is_refused(products: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"frames 0 \.\. 11, got 12"):
        picture(products["mesh"], 12, LOOK)


def test_only_products_are_drawn() -> None:
    with pytest.raises(TypeError, match="got ndarray"):
        picture(np.zeros(3), 0, LOOK)


def test_texture_stands_upright_and_on_the_right_side(products: dict[str, Any]) -> None:
    # The atlas is red above and blue below, v up.
    drawn = picture(products["performance"], 0, replace(LOOK, surface="textured", view=View(0.3, 0.0)))
    red = (drawn[..., 0].astype(int) - drawn[..., 2] > 60).nonzero()[0]
    blue = (drawn[..., 2].astype(int) - drawn[..., 0] > 60).nonzero()[0]
    assert red.size > 200
    assert blue.size > 200
    assert red.mean() < blue.mean()


def test_atlas_sampling_by_hand() -> None:
    image = np.array([[[0, 0, 0], [255, 0, 0]], [[0, 255, 0], [0, 0, 255]]], np.uint8)
    uv = np.array([[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]])
    assert np.allclose(sample_atlas(image, uv), [[0, 1, 0], [0, 0, 1], [0, 0, 0], [1, 0, 0]], atol=0.01)


def test_sides_are_told_by_twins_too(products: dict[str, Any]) -> None:
    drawn = picture(products["mocap"], 0, LOOK)
    assert np.array_equal(drawn, picture(products["skeleton"], 0, LOOK))
    names = np.array(["lowerback", "head", "lwrist", "rwrist", "LThumb", "RThumb"])
    bodies = skeleton_bodies(products["skeleton"]._replace(names=names), 0)
    assert len({tuple(body.colour) for body in bodies}) == 3
    left, _, middle = bodies
    assert len(left.vertices) > len(middle.vertices) / 2
    renamed = skeleton_bodies(products["skeleton"]._replace(names=np.array(list("abcdef"))), 0)
    assert len(renamed) == 1


def test_ground_track_by_hand(products: dict[str, Any]) -> None:
    path: MotionPath = products["path"]
    tracks = {take: np.tile([1.0, 0.9, 0.5], (40, 1)) for take in np.asarray(path.provenance.takes).tolist()}
    track = ground_track(path.provenance, tracks)
    assert track is not None
    assert np.allclose(track[0], [1.0, 0.5])
    # The last frame: yaw 0.7 about y, moved by (0.75, 1.5).
    c, s = np.cos(0.7), np.sin(0.7)
    assert np.allclose(track[-1], [c + 0.5 * s + 0.75, -s + 0.5 * c + 1.5], atol=1e-6)


def test_all_pairs_in_one_matrix(products: dict[str, Any]) -> None:
    pairs = {("stand", "stand_to_walk"): products["matrix"]}
    assert matrices_picture(pairs, replace(LOOK, graph=products["graph"])).shape == (240, 360, 3)


def test_png_and_numbers() -> None:
    assert png(np.zeros((2, 3, 3), np.uint8)).startswith(b"\x89PNG")
    assert [number(v) for v in (7.314159, 426.0, float("nan"), 0.00001234)] == [
        "7.314",
        "426",
        "–",
        "1.234e-05",
    ]


def test_what_cannot_be_met_is_grey_and_what_is_open_is_marked(products: dict[str, Any]) -> None:
    grid = products["target_grid"]
    drawn = picture(grid, 0, Look(size=(900, 600))).astype(int)
    grey = (abs(drawn - [201, 208, 214]).max(axis=-1) <= 2).sum()
    red = (abs(drawn - [209, 73, 91]).max(axis=-1) <= 2).sum()
    assert (np.asarray(grid.status) == 0).sum() == 10
    assert (np.asarray(grid.status) == -1).sum() == 1
    assert grey / 10 == pytest.approx(red, rel=0.35)
    assert grey > 5000
