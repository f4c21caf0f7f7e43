import av
import numpy as np
import pytest

from reperform.nodes.export.video import write_mp4


def pictures(height: int, width: int, count: int = 7) -> list[np.ndarray]:
    y, x = np.mgrid[:height, :width]
    return [np.stack([x * 2 % 256, y * 3 % 256, 0 * x + 20 * k], -1).astype(np.uint8) for k in range(count)]


@pytest.mark.parametrize("size", [(48, 64), (47, 61)])
def test_comes_back(tmp_path, size):
    made = pictures(*size)
    assert write_mp4(tmp_path / "film.mp4", iter(made), 12.5) == len(made)
    with av.open(str(tmp_path / "film.mp4")) as container:
        stream = container.streams.video[0]
        assert float(stream.average_rate) == 12.5
        assert stream.codec_context.name == "h264"
        assert stream.codec_context.pix_fmt == "yuv420p"
        read = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    assert len(read) == len(made)
    assert read[0].shape == (48, 64 if size[1] == 64 else 62, 3)
    error = np.abs(read[3][: size[0], : size[1]].astype(int) - made[3])
    assert np.median(error) < 8
    assert list(tmp_path.iterdir()) == [tmp_path / "film.mp4"]


def test_same_pictures_same_bytes(tmp_path):
    written = set()
    for k in range(12):
        # Memory that other work has left behind must not reach the file.
        np.random.default_rng(k).integers(0, 255, 150_000 + 10_000 * k, dtype=np.uint8)
        write_mp4(tmp_path / "film.mp4", pictures(32, 48), 25)
        written.add((tmp_path / "film.mp4").read_bytes())
    assert len(written) == 1


def test_a_failure_leaves_the_old_file(tmp_path):
    path = tmp_path / "film.mp4"
    path.write_bytes(b"old")
    with pytest.raises(ValueError, match="picture 2 is 64 x 40"):
        write_mp4(path, [*pictures(48, 64, 2), *pictures(40, 64, 1)], 25)
    with pytest.raises(ValueError, match="at least one picture"):
        write_mp4(path, [], 25)
    with pytest.raises(ValueError, match="RGB uint8"):
        write_mp4(path, [np.zeros((8, 8, 3))], 25)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
