from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.export.export import write
from reperform.nodes.products.mocap import Mocap
from reperform.nodes.skeleton.mocap import mocap

# the .bvh of this recording is larger by this factor
LARGER = 1.063


@pytest.fixture(scope="module")
def clips(data_folder: Path) -> Path:
    return data_folder / "mocap" / "cmu"


@pytest.fixture(scope="module")
def walk(clips: Path) -> Mocap:
    return mocap(file=str(clips / "02_01.amc"), skeleton=str(clips / "02.asf"))


def joint(motion: Mocap, name: str) -> np.ndarray:
    return np.asarray(motion.skeleton.joints[:, motion.skeleton.names.tolist().index(name)])


def test_a_recorded_walk_walks(walk: Mocap) -> None:
    assert walk.skeleton.joints.shape == (343, 38, 3)
    hips = joint(walk, "root")[:, [0, 2]]
    assert 1.1 < np.linalg.norm(np.diff(hips, axis=0), axis=1).sum() / (342 / 120) < 1.4
    assert abs(walk.skeleton.joints[..., 1].min()) < 0.02
    assert 1.5 < walk.skeleton.joints[..., 1].max() < 1.8
    assert float(walk.skeleton.fps) == 120


def test_both_formats_of_one_recording_tell_the_same_motion(clips: Path, walk: Mocap) -> None:
    other = mocap(file=str(clips / "02_01.bvh"), scale=0.0254 / 0.45 / LARGER)
    np.testing.assert_allclose(joint(other, "Hips"), joint(walk, "root"), atol=5e-4)
    for theirs, ours in (("LeftToeBase", "ltoes"), ("RightToeBase", "rtoes")):
        assert np.linalg.norm(joint(other, theirs) - joint(walk, ours), axis=1).max() < 0.02
    for theirs, ours in (("LeftFoot", "lfoot"), ("RightForeArm", "rradius"), ("Head", "head")):
        a, b = (joint(m, n) - joint(m, h) for m, n, h in ((other, theirs, "Hips"), (walk, ours, "root")))
        assert np.abs(np.diff(a - b, axis=0)).max() < 0.01


def test_resampling_keeps_bones_and_pace(clips: Path, walk: Mocap) -> None:
    slow = mocap(
        file=str(clips / "02_01.amc"), skeleton=str(clips / "02.asf"), fps=25, first=0.5, seconds=1.2
    )
    assert len(slow.skeleton.joints) == 31
    np.testing.assert_allclose(slow.skeleton.joints[::5], walk.skeleton.joints[60:205:24], atol=1e-5)
    bones = [
        np.linalg.norm(m.skeleton.joints - m.skeleton.joints[:, m.skeleton.parents], axis=2)
        for m in (slow, walk)
    ]
    np.testing.assert_allclose(bones[0][:, 1:], np.tile(bones[1][:1, 1:], (31, 1)), atol=2e-6)


@pytest.mark.parametrize("name", ["131_01", "131_03"])
def test_clips_without_a_leading_zero_and_with_other_names_are_read(clips: Path, name: str) -> None:
    motion = mocap(file=str(clips / f"{name}.bvh"), scale=0.0254 / 0.45, fps=25)
    assert motion.skeleton.joints.shape[1] == 38
    assert abs(motion.skeleton.joints[..., 1].min()) < 0.06
    assert float(motion.skeleton.fps) == 25


def test_what_is_written_comes_back(tmp_path: Path, walk: Mocap) -> None:
    short = Mocap(walk.skeleton._replace(joints=walk.skeleton.joints[:9]), walk.rotation[:9], walk.offset)
    write(short, tmp_path / "walk.bvh")
    again = mocap(file=str(tmp_path / "walk.bvh"))
    assert sorted(again.skeleton.names.tolist()) == sorted(walk.skeleton.names.tolist())
    for name in walk.skeleton.names.tolist():
        np.testing.assert_allclose(joint(again, name), joint(short, name), atol=2e-5)


def test_what_cannot_be_read_is_told(tmp_path: Path, clips: Path) -> None:
    with pytest.raises(ValueError, match="with `skeleton` naming"):
        mocap(file=str(clips / "02_01.amc"))
    with pytest.raises(ValueError, match="cannot be opened"):
        mocap(file=str(tmp_path / "none.bvh"))
    with pytest.raises(ValueError, match="must lie within"):
        mocap(file=str(clips / "02_01.bvh"), first=99.0)
    (tmp_path / "cut.bvh").write_text((clips / "02_01.bvh").read_text()[:20000])
    with pytest.raises(ValueError, match="bvh cannot be read"):
        mocap(file=str(tmp_path / "cut.bvh"))
