"""A motion of known slides (a body carried along while the capture stands still), and turned slabs to blend."""

import numpy as np
import pytest
import trimesh

from reperform.nodes.kernels.rotation import exp
from reperform.nodes.products.blend_measures import PosePairs
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation, Provenance

AXIS = np.array([0.2, 1.0, -0.4]) / np.linalg.norm([0.2, 1.0, -0.4])


@pytest.fixture
def standing() -> dict[str, MeshSequence]:
    """Two uneven columns that join above, on the ground for 30 frames."""
    frame = trimesh.creation.box(extents=[0.5, 0.3, 0.2]).subdivide()
    frame.apply_translation([0.02, 0.45, 0.0])
    legs = [trimesh.creation.box(extents=[0.09, 0.5, 0.11]).subdivide() for _ in range(2)]
    for leg, x, z in zip(legs, (0.2, -0.17), (0.01, -0.03), strict=True):
        leg.apply_translation([x, 0.25, z])
    mesh = trimesh.util.concatenate([frame, *legs])
    vertices = np.tile(np.asarray(mesh.vertices, np.float32), (30, 1, 1))
    return {"stand": MeshSequence(vertices, np.asarray(mesh.faces, np.int32), np.float32(25))}


@pytest.fixture
def carried(standing: dict[str, MeshSequence]) -> Animation:
    """The capture played at 0.3 m/s along x and 0.4 m/s along z, larger by 1 % in its last frame."""
    take = standing["stand"]
    count = len(take.vertices)
    way = np.arange(count)[:, None] / 25.0 * np.array([0.3, 0.0, 0.4])
    vertices = take.vertices + way[:, None].astype(np.float32)
    vertices[-1] = (vertices[-1] - vertices[-1].mean(axis=0)) * np.float32(1.01) + vertices[-1].mean(axis=0)
    frames = np.tile(np.arange(count, dtype=np.int32)[:, None], (1, 2))
    weight = np.tile(np.array([0.25, 0.75], np.float32), (count, 1))
    source = Provenance(
        np.array(["stand"]), 0 * frames, frames, weight, np.zeros((count, 2)), np.zeros((count, 2, 2))
    )
    return Animation(take._replace(vertices=vertices), source)


@pytest.fixture(scope="session")
def slab():
    box = trimesh.creation.box(extents=[0.5, 1.0, 0.2]).subdivide().subdivide()
    vertices = np.asarray(box.vertices) * [1.0, 1.0, 1.3]
    vertices[:, 0] += 0.1 * np.sin(2 * vertices[:, 1])
    return vertices, np.asarray(box.faces, np.int32)


@pytest.fixture(scope="session")
def turned_pairs(slab):
    """A rigid slab turned about a slanted axis by 1 and by 2 radians; half way is known."""
    vertices, faces = slab
    poses = [np.array([vertices @ exp(AXIS * a * s).T for a in (1.0, 2.0)], np.float32) for s in (0, 1, 0.5)]
    return PosePairs(np.array(["one", "two"]), poses[0], poses[1], poses[2], faces)


@pytest.fixture(scope="session")
def turning_takes(slab):
    vertices, faces = slab
    fps = np.asarray(25.0, np.float32)
    return {
        name: MeshSequence(
            np.array([vertices @ exp(AXIS * speed * k).T for k in range(3)], np.float32), faces, fps
        )
        for name, speed in (("slow", 0.2), ("fast", 0.9))
    }
