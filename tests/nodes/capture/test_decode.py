from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import av
import cv2
import numpy as np
import pytest

from reperform.nodes.capture.clips import clips
from reperform.nodes.capture.decode import decode
from reperform.nodes.products.clips import Clips


def view(index: Clips, frame: int, camera: int) -> Clips:
    return Clips(
        index.file[frame, camera],
        index.position[frame, camera],
        index.digest[frame, camera],
        index.image_size[camera],
        index.name[camera],
        index.fps,
    )


def write_counting_video(path: Path, frames: int, codec: str, options: dict[str, str]) -> None:
    """Frame k shows k in 8 black or white bars."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=30, options=options)
        stream.width, stream.height = 128, 64
        stream.pix_fmt = "yuvj420p" if codec == "mjpeg" else "yuv420p"
        for k in range(frames):
            bits = np.array([255 * (k >> bit & 1) for bit in range(8)], np.uint8)
            picture = np.repeat(np.tile(np.repeat(bits, 16), (64, 1))[..., None], 3, axis=2)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())


def number(picture: np.ndarray) -> int:
    return sum(int(picture[32, 16 * bit + 8, 0] > 127) << bit for bit in range(8))


@pytest.mark.parametrize(
    ("name", "codec", "options"),
    [
        ("v.mp4", "libx264", {"bf": "3", "g": "40"}),
        ("v.mkv", "libx264", {"bf": "2", "g": "250"}),
        ("v.avi", "mpeg4", {"bf": "2", "g": "60"}),
        ("v.avi", "mjpeg", {}),
    ],
)
def test_random_access_is_exact_to_the_frame(tmp_path: Path, name: str, codec: str, options: dict) -> None:
    write_counting_video(tmp_path / name, 200, codec, options)
    index = clips(folder=str(tmp_path), pattern=name)
    assert len(index.position) == 200
    order = np.random.default_rng(3).permutation(200)[:30].tolist() + [50, 51, 52, 199, 0]
    for k in order:
        assert number(decode(view(index, k, 0), folder=str(tmp_path)).images) == k


def test_threads_do_not_disturb_each_other(tmp_path: Path) -> None:
    write_counting_video(tmp_path / "v.mp4", 60, "libx264", {"bf": "2"})
    index = clips(folder=str(tmp_path), pattern="v.mp4")
    with ThreadPoolExecutor(4) as pool:
        numbers = pool.map(
            lambda k: number(decode(view(index, k, 0), folder=str(tmp_path)).images), range(60)
        )
    assert list(numbers) == list(range(60))


def test_colours_are_red_green_blue(tmp_path: Path) -> None:
    picture = np.zeros((10, 14, 3), np.uint8)
    picture[..., 0], picture[2:5, 3:9, 1] = 200, 90
    cv2.imwrite(str(tmp_path / "a.png"), picture[..., ::-1])
    index = clips(folder=str(tmp_path), pattern="{camera}.png")
    assert np.array_equal(decode(view(index, 0, 0), folder=str(tmp_path)).images, picture)


def test_a_damaged_or_missing_picture_is_named(tmp_path: Path) -> None:
    noise = np.random.default_rng(0).integers(0, 255, (40, 60, 3), dtype=np.uint8)
    cv2.imwrite(str(tmp_path / "a.png"), noise)
    index = clips(folder=str(tmp_path), pattern="{camera}.png")
    cv2.imwrite(str(tmp_path / "a.png"), noise[:20])
    with pytest.raises(ValueError, match=r"a\.png \(picture 0\) must be 60x40 px as indexed, got 60x20"):
        decode(view(index, 0, 0), folder=str(tmp_path))
    (tmp_path / "a.png").unlink()
    with pytest.raises(ValueError, match="is gone"):
        decode(view(index, 0, 0), folder=str(tmp_path))


def test_a_picture_past_the_end_is_named(tmp_path: Path) -> None:
    write_counting_video(tmp_path / "v.mp4", 5, "libx264", {})
    index = clips(folder=str(tmp_path), pattern="v.mp4")
    beyond = view(index, 4, 0)._replace(position=np.int32(9))
    with pytest.raises(ValueError, match=r"v\.mp4: picture 9 cannot be decoded.*ends after 5"):
        decode(beyond, folder=str(tmp_path))
    assert number(decode(view(index, 4, 0), folder=str(tmp_path)).images) == 4


def test_packed_pictures_of_real_footage_are_all_found(data_folder: Path) -> None:
    folder = data_folder / "captures" / "utrecht_seated4"
    index = clips(folder=str(folder), pattern="cam{camera}/background.avi", count=132)
    with av.open(str(folder / "cam4" / "background.avi")) as container:
        truth = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    for k in (100, 3, 131):
        assert np.array_equal(decode(view(index, k, 3), folder=str(folder)).images, truth[k])
