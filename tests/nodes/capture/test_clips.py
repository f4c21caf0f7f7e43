from pathlib import Path

import av
import cv2
import numpy as np
import pytest

from reperform.nodes.capture.clips import clips


def write_image(path: Path, value: int, size: tuple[int, int] = (20, 12)) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(path), np.full((size[1], size[0], 3), value, np.uint8))


def write_video(path: Path, frames: int, rate: int = 25) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=rate)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        for k in range(frames):
            picture = np.full((48, 64, 3), 5 * k, np.uint8)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())


def test_numbered_images_come_in_the_order_of_numbers(tmp_path: Path) -> None:
    for camera in ("cam10", "cam2"):
        for frame in (8, 9, 10):
            write_image(tmp_path / camera / f"{frame}.png", frame)
    found = clips(folder=str(tmp_path), pattern="{camera}/{frame}.png")
    assert found.name.tolist() == ["cam2", "cam10"]
    assert found.file[:, 0].tolist() == ["cam2/8.png", "cam2/9.png", "cam2/10.png"]
    assert found.image_size.tolist() == [[20, 12], [20, 12]]
    assert float(found.fps) == 25


def test_equal_content_has_equal_digests_and_changed_content_does_not(tmp_path: Path) -> None:
    for camera, value in (("a", 7), ("b", 7), ("c", 8)):
        write_image(tmp_path / f"{camera}.png", value)
    digest = clips(folder=str(tmp_path), pattern="{camera}.png").digest[0]
    assert digest[0] == digest[1] != digest[2]


def test_first_count_and_step_choose_frames_and_set_the_rate(tmp_path: Path) -> None:
    for camera in "ab":
        write_video(tmp_path / camera / "take.mp4", 10)
    found = clips(folder=str(tmp_path), pattern="{camera}/take.mp4", first=1, count=3, step=2)
    assert found.position[:, 0].tolist() == [1, 3, 5]
    assert float(found.fps) == 12.5
    assert len(set(found.digest.ravel().tolist())) == 3


def test_cameras_are_chosen_and_ordered_by_name(tmp_path: Path) -> None:
    for camera in "abc":
        write_image(tmp_path / f"{camera}.png", 1)
    assert clips(folder=str(tmp_path), pattern="{camera}.png", cameras=["c", "a"]).name.tolist() == ["c", "a"]
    with pytest.raises(ValueError, match="camera d has no file"):
        clips(folder=str(tmp_path), pattern="{camera}.png", cameras=["a", "d"])


def test_different_counts_are_refused_with_the_counts_and_the_cure(tmp_path: Path) -> None:
    write_video(tmp_path / "a.mp4", 4)
    write_video(tmp_path / "b.mp4", 6)
    with pytest.raises(ValueError, match=r"a: 4, b: 6: set count \(at most 4\)"):
        clips(folder=str(tmp_path), pattern="{camera}.mp4")
    assert len(clips(folder=str(tmp_path), pattern="{camera}.mp4", count=4).position) == 4
    with pytest.raises(ValueError, match="camera a has 4"):
        clips(folder=str(tmp_path), pattern="{camera}.mp4", count=5)


def test_a_missing_number_is_named(tmp_path: Path) -> None:
    for camera, frames in (("a", (1, 2, 3)), ("b", (1, 3, 4))):
        for frame in frames:
            write_image(tmp_path / camera / f"{frame}.png", frame)
    with pytest.raises(ValueError, match="frame 2 is there for camera a but not for camera b"):
        clips(folder=str(tmp_path), pattern="{camera}/{frame}.png")
    assert len(clips(folder=str(tmp_path), pattern="{camera}/*.png").position) == 3


def test_sizes_must_agree(tmp_path: Path) -> None:
    write_image(tmp_path / "a.png", 1)
    write_image(tmp_path / "b.png", 1, (24, 12))
    with pytest.raises(ValueError, match="20x12 px in camera a and 24x12 px in camera b"):
        clips(folder=str(tmp_path), pattern="{camera}.png")


@pytest.mark.parametrize("kept", [0.3, 0.8])
def test_a_truncated_video_is_refused(tmp_path: Path, kept: float) -> None:
    write_video(tmp_path / "a.mp4", 30)
    content = (tmp_path / "a.mp4").read_bytes()
    (tmp_path / "a.mp4").write_bytes(content[: int(kept * len(content))])
    with pytest.raises(ValueError, match=r"a\.mp4.*(not a readable video|truncated)"):
        clips(folder=str(tmp_path), pattern="{camera}.mp4")


def test_a_file_that_is_no_image_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_text("no picture")
    with pytest.raises(ValueError, match="not a readable image"):
        clips(folder=str(tmp_path), pattern="{camera}.png")


def test_an_empty_folder_and_a_bad_placeholder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no file below"):
        clips(folder=str(tmp_path), pattern="cam{camera}.png")
    with pytest.raises(ValueError, match="placeholders are"):
        clips(folder=str(tmp_path), pattern="cam{cam}.png")


def test_real_footage_is_indexed(data_folder: Path) -> None:
    captures = data_folder / "captures"
    found = clips(folder=str(captures / "utrecht_seated4"), pattern="cam{camera}/video.avi")
    assert found.position.shape == (426, 4)
    assert float(found.fps) == 50
    found = clips(folder=str(captures / "surrey_dancer8"), pattern="cam{camera}.png")
    assert found.file.shape == (1, 8)
    assert found.image_size[0].tolist() == [1920, 1080]
