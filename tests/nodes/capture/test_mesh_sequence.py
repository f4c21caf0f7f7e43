from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.capture.mesh_sequence import mesh_sequence


@pytest.fixture
def archive(tmp_path: Path) -> Path:
    random = np.random.default_rng(0)
    path = tmp_path / "dance.npz"
    np.savez(path, vertices=random.normal(size=(9, 4, 3)), faces=np.array([[0, 1, 2], [0, 2, 3]], np.int64))
    return path


def test_a_take_is_cut_and_scaled(archive: Path) -> None:
    take = mesh_sequence(file=str(archive), first=2, count=5, fps=30.0, scale=0.001)
    whole = np.load(archive)["vertices"]
    np.testing.assert_allclose(take.vertices, whole[2:7] * 0.001, rtol=1e-6)
    assert take.vertices.dtype == np.float32
    assert take.faces.dtype == np.int32
    assert take.fps == 30.0
    assert len(mesh_sequence(file=str(archive), first=6, fps=30.0).vertices) == 3


def test_the_frame_rate_of_the_file_counts_unless_another_is_given(tmp_path: Path) -> None:
    path = tmp_path / "with_rate.npz"
    np.savez(path, points=np.zeros((2, 3, 3)), triangles=np.array([[0, 1, 2]]), fps=np.float32(12.0))
    names = {"vertices": "points", "faces": "triangles"}
    assert mesh_sequence(file=str(path), **names).fps == 12.0
    assert mesh_sequence(file=str(path), **names, fps=24.0).fps == 24.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"first": 9}, "has 9 frames"),
        ({"first": 5, "count": 5}, "frames 5 .. 9 were asked"),
        ({"fps": 0.0}, "does not state a frame rate"),
        ({"vertices": "points"}, "must hold an array 'points', it holds vertices, faces"),
        ({"vertices": "faces"}, r"must be \(frame, vertex, 3\)"),
    ],
)
def test_what_does_not_fit_is_refused(archive: Path, arguments: dict[str, int], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        mesh_sequence(**{"file": str(archive), "fps": 25.0, **arguments})


def test_damaged_files_are_refused(tmp_path: Path, archive: Path) -> None:
    cut = tmp_path / "cut.npz"
    cut.write_bytes(archive.read_bytes()[:200])
    for path in (cut, tmp_path / "none.npz"):
        with pytest.raises(ValueError, match="cannot be read"):
            mesh_sequence(file=str(path), fps=25.0)


def test_faces_and_coordinates_must_make_sense(tmp_path: Path) -> None:
    path = tmp_path / "odd.npz"
    np.savez(path, vertices=np.zeros((2, 3, 3)), faces=np.array([[0, 1, 3]]))
    with pytest.raises(ValueError, match=r"name vertices 0 .. 2, got 0 .. 3"):
        mesh_sequence(file=str(path), fps=25.0)
    np.savez(path, vertices=np.full((2, 3, 3), np.nan), faces=np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="must be finite"):
        mesh_sequence(file=str(path), fps=25.0)


def test_a_real_sequence(data_folder: Path) -> None:
    take = mesh_sequence(file=str(data_folder / "sequences" / "samba.npz"), first=30, count=20, fps=25.0)
    assert take.vertices.shape == (20, 9971, 3)
    assert 1.7 < np.ptp(take.vertices[0, :, 1]) < 1.8
