import csv

import cv2
import numpy as np
import pytest
import trimesh

from reperform.nodes.export.export import endings, write
from reperform.nodes.products.clips import Clips
from reperform.nodes.products.footage import Film, Footage, Mattes
from reperform.nodes.products.mesh import MeshSequence, Surfaces, TextureAtlas
from reperform.nodes.products.motion import Animation, Dissimilarity, Provenance
from reperform.nodes.products.performance import BoneRotations, Contacts, Performance, SkeletonSequence
from reperform.nodes.products.table import Table
from reperform.nodes.ragged import Ragged

FPS = np.float32(25)


class Lazy:
    """A field that can only be indexed by frame, as a stored one."""

    def __init__(self, array):
        self.array = array

    def __len__(self):
        return len(self.array)

    def __getitem__(self, index):
        assert isinstance(index, int)
        return self.array[index]


def sequence(frames: int = 3) -> MeshSequence:
    mesh = trimesh.creation.icosphere(subdivisions=1)
    steps = np.arange(frames)[:, None, None] * np.array([0.1, 0.02, -0.03])
    return MeshSequence(
        (mesh.vertices * (0.3, 0.9, 0.2) + steps).astype(np.float32), mesh.faces.astype(np.int32), FPS
    )


def surfaces() -> Surfaces:
    mesh = sequence()
    faces = Ragged([mesh.faces[: len(mesh.faces) - k] for k in range(3)])
    return Surfaces(Ragged(list(mesh.vertices)), faces, FPS)


def performance() -> Performance:
    mesh = sequence()
    count = len(mesh.faces)
    uv = np.random.default_rng(0).uniform(0, 1, (3 * count, 2)).astype(np.float32)
    atlas = TextureAtlas(
        uv, np.arange(3 * count, dtype=np.int32).reshape(-1, 3), np.full((8, 8, 3), 90, np.uint8)
    )
    joints = np.stack([np.array([[0, 1, 0], [0, 1.5, 0.1]]) + k for k in range(3)]).astype(np.float32)
    skeleton = SkeletonSequence(joints, np.array([-1, 0], np.int32), np.array(["hips", "head"]), FPS)
    bones = BoneRotations(np.tile(np.eye(3, dtype=np.float32), (3, 2, 1, 1)), skeleton.parents, FPS)
    return Performance(mesh, atlas, skeleton, Contacts(np.zeros((3, 2), bool)), bones)


def film(frames: int = 5) -> Film:
    images = np.random.default_rng(0).integers(0, 255, (frames, 20, 30, 3), dtype=np.uint8)
    return Film(images, np.zeros((frames, 20, 30), np.uint8), FPS)


def test_what_cannot_be_written_lists_what_can(tmp_path):
    with pytest.raises(ValueError, match=r"film.glb: Film can be written as .mp4 .png .npz, not as '.glb'"):
        write(film(), tmp_path / "film.glb")
    with pytest.raises(ValueError, match=r"walk: MeshSequence .* not as 'no ending'"):
        write(sequence(), tmp_path / "walk")
    with pytest.raises(ValueError, match=r"walk_%04d.obj, or choose .glb or .usd"):
        write(sequence(), tmp_path / "walk.obj")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "product", [film(), sequence(), surfaces(), performance()], ids=lambda p: type(p).__name__
)
def test_every_promised_ending_is_written(tmp_path, product):
    for ending in endings(type(product)):
        name = f"out_%02d{ending}" if ending in (".obj", ".ply") else f"out{ending}"
        write(product, tmp_path / name)
        written = sorted(tmp_path.glob(f"out*{ending}"))
        assert len(written) == (3 if "%" in name else 1), ending
        assert written[0].stat().st_size > 100
    assert not list(tmp_path.glob(".*"))


def test_obj_and_ply_are_the_mesh(tmp_path):
    mesh = sequence()
    for ending in (".obj", ".ply"):
        write(mesh, tmp_path / f"walk_%d{ending}")
        read = trimesh.load(tmp_path / f"walk_2{ending}", process=False)
        np.testing.assert_allclose(read.vertices, mesh.vertices[2], atol=1e-6)
        np.testing.assert_array_equal(read.faces, mesh.faces)


def test_lazy_fields_are_read_frame_by_frame(tmp_path):
    made = film()
    write(made._replace(images=Lazy(made.images), coverage=Lazy(made.coverage)), tmp_path / "film.mp4")
    write(made._replace(images=Lazy(made.images)), tmp_path / "film_%03d.png")
    np.testing.assert_array_equal(cv2.imread(str(tmp_path / "film_003.png"))[..., ::-1], made.images[3])
    write(surfaces()._replace(vertices=Lazy(surfaces().vertices)), tmp_path / "hull.glb")


def test_animation_is_its_mesh(tmp_path):
    mesh = sequence()
    empty = Provenance(np.array(["a"]), *(np.zeros((3, 2)),) * 4, np.zeros((3, 2, 2)))
    write(Animation(mesh, empty), tmp_path / "a.glb", name="same")
    write(mesh, tmp_path / "b.glb", name="same")
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


def test_usd_holds_every_frame(tmp_path):
    pxr = pytest.importorskip("pxr", reason="usd-core is not installed")
    assert pxr
    from pxr import Usd, UsdGeom

    made = surfaces()
    write(made, tmp_path / "hull.usdc", name="1 hull")
    stage = Usd.Stage.Open(str(tmp_path / "hull.usdc"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/_1_hull/surface"))
    assert stage.GetTimeCodesPerSecond() == 25
    for k in range(3):
        np.testing.assert_allclose(np.array(mesh.GetPointsAttr().Get(k)), made.vertices[k])
        assert (
            np.array(mesh.GetFaceVertexIndicesAttr().Get(k)).reshape(-1, 3).tolist() == made.faces[k].tolist()
        )


def test_npz_comes_back(tmp_path):
    made = performance()
    write(made, tmp_path / "all.npz")
    read = np.load(tmp_path / "all.npz")
    np.testing.assert_array_equal(read["mesh.vertices"], made.mesh.vertices)
    assert read["skeleton.names"].tolist() == ["hips", "head"]
    write(surfaces(), tmp_path / "hull.npz")
    np.testing.assert_array_equal(np.load(tmp_path / "hull.npz")["faces.00002"], surfaces().faces[2])
    names = np.array([["a.png"]])
    clips = Clips(names, np.zeros((1, 1), np.int32), names, np.zeros((1, 2), np.int32), np.array(["c"]), FPS)
    write(clips, tmp_path / "clips.npz")
    assert np.load(tmp_path / "clips.npz")["file"] == names


def test_csv_keeps_all_digits(tmp_path):
    columns = {
        "figure": ["a, b"],
        "value": [1 / 3],
        "unit": ["m"],
        "side": ["<="],
        "target": [0.5],
        "holds": [1],
    }
    table = Table(
        *(np.array(v) for v in columns.values()), np.array([""]), np.array([np.nan]), np.array(["000"])
    )
    write(table, tmp_path / "t.csv")
    with (tmp_path / "t.csv").open(newline="") as file:
        (row,) = csv.DictReader(file)
    assert (row["figure"], float(row["value"]), row["holds"]) == ("a, b", 1 / 3, "1")


def test_pictures(tmp_path):
    distance = np.arange(12, dtype=np.float32).reshape(3, 4)
    write(Dissimilarity(distance), tmp_path / "d.png")
    assert cv2.imread(str(tmp_path / "d.png")).shape == (3, 4, 3)
    footage = Footage(np.zeros((2, 3, 10, 16, 3), np.uint8), FPS)
    write(footage, tmp_path / "f.mp4")
    write(Mattes(footage.images[..., 0], FPS), tmp_path / "m.png")
    assert cv2.imread(str(tmp_path / "m.png")).shape == (20, 64, 3)
    contacts = Contacts(np.zeros((3, 2), bool))
    with pytest.raises(ValueError, match=r"written as .npz"):
        write(contacts, tmp_path / "c.png")
    write(contacts, tmp_path / "c.png", picture=lambda product: np.full((4, 5, 3), 7, np.uint8))
    assert cv2.imread(str(tmp_path / "c.png")).shape == (4, 5, 3)
