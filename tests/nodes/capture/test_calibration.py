from pathlib import Path

import cv2
import numpy as np
import pytest

from reperform.nodes.capture.calibration import calibration
from reperform.nodes.kernels.camera import centre, project

TURN = cv2.Rodrigues(np.array([0.3, -0.8, 0.2]))[0]


def surrey(rotation: np.ndarray = TURN, cameras: int = 2) -> str:
    one = "10 1089 20 1939\n1001 1002 975.5 545.5\n-7e-05\n"
    one += " ".join(f"{x:.6g}" for x in rotation.ravel()) + "\n1.5 -0.25 4\n"
    return f"{cameras} 1\n" + cameras * one


def write_opencv(path: Path, **fields: object) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for name, value in fields.items():
        storage.write(name, value)
    storage.release()


def opencv_fields() -> dict[str, object]:
    return {
        "CameraMatrix": np.array([[500.0, 0, 320], [0, 505, 240], [0, 0, 1]]),
        "DistortionCoeffs": np.array([[-0.3, 0.1, 0.001, -0.002, 0.05]]).T,
        "RotationValues": cv2.Rodrigues(TURN)[0],
        "TranslationValues": np.array([[100.0], [200], [3000]]),
    }


def test_surrey_text_is_read_with_its_window(tmp_path: Path) -> None:
    (tmp_path / "rig.txt").write_text(surrey())
    rig = calibration(file=str(tmp_path / "rig.txt"))
    assert rig.name.tolist() == ["0", "1"]
    assert rig.image_size.tolist() == [[1920, 1080]] * 2
    assert np.allclose(rig.matrix[0], [[1001, 0, 955.5], [0, 1002, 535.5], [0, 0, 1]])
    assert np.allclose(rig.rotation[1], TURN, atol=2e-6)
    assert np.abs(rig.rotation[0] @ rig.rotation[0].T - np.eye(3)).max() < 1e-12
    assert rig.translation[0].tolist() == [1.5, -0.25, 4]
    assert rig.distortion[0].tolist() == [-7e-05, 0, 0, 0, 0]


def test_z_up_millimetres_become_y_up_metres_and_pixels_stay(tmp_path: Path) -> None:
    write_opencv(tmp_path / "cam3" / "config.xml", **opencv_fields())
    rig = calibration(file=str(tmp_path), scale=0.001, up="z", width=640, height=480)
    assert rig.name.tolist() == ["3"]
    points_mm = np.array([[120.0, -80, 400], [-300, 250, 90]])
    points = points_mm[:, [0, 2, 1]] * [1, 1, -1] / 1000
    fields = opencv_fields()
    expected = cv2.projectPoints(
        points_mm,
        fields["RotationValues"],
        fields["TranslationValues"],
        fields["CameraMatrix"],
        fields["DistortionCoeffs"],
    )[0].reshape(-1, 2)
    pixels, depth = project(points, rig.matrix[0], rig.rotation[0], rig.translation[0], rig.distortion[0])
    assert np.allclose(pixels, expected, atol=1e-6)
    assert np.all((depth > 2) & (depth < 4))
    assert np.linalg.det(rig.rotation[0]) > 0


@pytest.mark.parametrize("ending", ["xml", "yml", "json"])
def test_every_opencv_format_and_a_rotation_matrix_are_read(tmp_path: Path, ending: str) -> None:
    fields = opencv_fields() | {"image_width": 640, "image_height": 480}
    fields["R"] = TURN
    del fields["RotationValues"]
    write_opencv(tmp_path / f"one.{ending}", **fields)
    rig = calibration(file=str(tmp_path / f"one.{ending}"))
    assert rig.image_size.tolist() == [[640, 480]]
    assert np.allclose(rig.rotation[0], TURN)


def test_wrong_token_counts_and_words_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "rig.txt"
    for text, message in (
        (surrey() + " 7", r"2 cameras need 2 \+ 21 x 2 = 44 numbers, got 45"),
        (surrey().rsplit(" ", 3)[0], "got 40: camera 1 is incomplete"),
        (surrey().replace("1001", "x1"), "numbers only"),
        ("", "number of cameras"),
    ):
        path.write_text(text)
        with pytest.raises(ValueError, match=message):
            calibration(file=str(path))


def test_what_is_no_rotation_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "rig.txt"
    for bad in (TURN * 1.01, TURN[[1, 0, 2]], np.zeros((3, 3))):
        path.write_text(surrey(bad))
        with pytest.raises(ValueError, match="camera 0: the rotation must be orthonormal and right-handed"):
            calibration(file=str(path))


def test_missing_fields_sizes_and_cameras_are_refused(tmp_path: Path) -> None:
    fields = opencv_fields()
    write_opencv(tmp_path / "cam1" / "config.xml", **fields)
    with pytest.raises(ValueError, match="set width and height"):
        calibration(file=str(tmp_path))
    with pytest.raises(ValueError, match="belongs to another image size"):
        calibration(file=str(tmp_path), width=320, height=240)
    with pytest.raises(ValueError, match="camera 7 is not in"):
        calibration(file=str(tmp_path), width=640, height=480, cameras=["7"])
    del fields["TranslationValues"]
    write_opencv(tmp_path / "cam1" / "config.xml", **fields)
    with pytest.raises(ValueError, match="TranslationValues is missing"):
        calibration(file=str(tmp_path), width=640, height=480)
    with pytest.raises(ValueError, match="does not exist"):
        calibration(file=str(tmp_path / "none.txt"))


def test_a_broken_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text("<?xml version='1.0'?><opencv_storage><CameraMatrix>")
    with pytest.raises(ValueError, match=r"a\.xml"):
        calibration(file=str(tmp_path / "a.xml"), width=640, height=480)


def test_real_rigs_stand_where_they_stood(data_folder: Path) -> None:
    captures = data_folder / "captures"
    rig = calibration(file=str(captures / "surrey_dancer8" / "calibration.txt"))
    height = centre(rig.rotation, rig.translation)[:, 1]
    assert np.all((height > 2.1) & (height < 2.45))
    rig = calibration(file=str(captures / "utrecht_seated4"), scale=0.001, up="z", width=644, height=486)
    assert np.allclose(centre(rig.rotation, rig.translation)[0], [3.339, 1.420, -2.931], atol=2e-3)
