"""Silhouettes against mattes with known overlap."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.evaluate.silhouette_iou import silhouette_iou
from reperform.nodes.kernels.camera import look_at
from reperform.nodes.kernels.silhouette import silhouette
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Mattes
from reperform.nodes.products.mesh import Surfaces

SIZE = (150, 110)
FPS = np.float32(25)


def rig(lens) -> Cameras:
    poses = [look_at(np.array(eye), np.array([0.1, 0.8, 0.0])) for eye in ([3, 1.2, 0.4], [-0.5, 1.6, 2.7])]
    matrix = np.array([[170.0, 0, 71], [0, 165.0, 58], [0, 0, 1]])
    return Cameras(
        np.stack([matrix] * 2), np.stack([pose[0] for pose in poses]), np.stack([pose[1] for pose in poses]),
        np.tile(lens, (2, 1)), np.tile(np.int32(SIZE), (2, 1)), np.array(["west", "south"]),
    )  # fmt: skip


def body(scale=(0.3, 0.55, 0.2)) -> Surfaces:
    ball = trimesh.creation.icosphere(3)
    return Surfaces(
        (ball.vertices * scale + [0.12, 0.8, 0.05]).astype(np.float32), ball.faces.astype(np.int32), FPS
    )


@pytest.mark.parametrize("lens", [np.zeros(5), np.array([-0.3, 0.1, 0.002, -0.001, 0.0])])
def test_own_silhouettes_fit_wholly_and_scaled_ones_by_their_area(lens):
    cameras, solid = rig(lens), body()
    seen = [
        silhouette(solid.vertices, solid.faces, *camera, *SIZE[::-1])
        for camera in zip(*cameras[:4], strict=True)
    ]
    mattes = Mattes(np.where(seen, 255, 0).astype(np.uint8), FPS)
    found = silhouette_iou(mattes, cameras, solid)
    assert found.value.tolist() == [1.0, 1.0]
    assert found.name.tolist() == ["west", "south"]
    smaller = silhouette_iou(mattes, cameras, body((0.27, 0.495, 0.18)))
    assert smaller.value == pytest.approx([0.81, 0.81], abs=0.025)


def test_half_transparent_pixels_are_covered_from_one_half_on():
    cameras, solid = rig(np.zeros(5)), body()
    faint = Mattes(np.full((2, *SIZE[::-1]), 127, np.uint8), FPS)
    assert silhouette_iou(faint, cameras, solid).value.tolist() == [0.0, 0.0]


def test_other_cameras_are_refused():
    with pytest.raises(ValueError, match="3 mattes and 2 cameras"):
        silhouette_iou(Mattes(np.zeros((3, *SIZE[::-1]), np.uint8), FPS), rig(np.zeros(5)), body())
