from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.export.export import write
from reperform.nodes.products.mocap import Mocap
from reperform.nodes.skeleton.mocap import mocap


def test_what_is_written_comes_back(tmp_path: Path, striders: Mapping[str, Mocap]) -> None:
    made = striders["turning"]
    write(made, tmp_path / "walk.amc")
    again = mocap(file=str(tmp_path / "walk.amc"), skeleton=str(tmp_path / "walk.asf"), recorded=25)
    names = again.skeleton.names.tolist()
    for k, name in enumerate(made.skeleton.names.tolist()):
        if name in ("l_ball", "r_ball", "neck_end"):
            continue
        np.testing.assert_allclose(
            again.skeleton.joints[:, names.index(name)], made.skeleton.joints[:, k], atol=2e-5
        )
    # the ends of the last bones come back as such
    np.testing.assert_allclose(
        again.skeleton.joints[:, names.index("neck_end")], made.skeleton.joints[:, 10], atol=2e-5
    )
    np.testing.assert_allclose(
        again.skeleton.joints[:, names.index("l_ball")], made.skeleton.joints[:, 4], atol=2e-5
    )


def test_real_motion_comes_back_too(tmp_path: Path, data_folder: Path) -> None:
    clips = data_folder / "mocap" / "cmu"
    for made in (
        mocap(file=str(clips / "02_02.amc"), skeleton=str(clips / "02.asf"), fps=20),
        mocap(file=str(clips / "131_02.bvh"), scale=0.0254 / 0.45, fps=10),
    ):
        write(made, tmp_path / "clip.amc")
        again = mocap(file=str(tmp_path / "clip.amc"), skeleton=str(tmp_path / "clip.asf"))
        gap = np.linalg.norm(made.skeleton.joints[:, :, None] - again.skeleton.joints[:, None], axis=3)
        assert gap.min(axis=2).max() < 1e-4
        assert gap.min(axis=1).max() < 1e-4


def test_a_forest_is_refused(tmp_path: Path, striders: Mapping[str, Mocap]) -> None:
    made = striders["slow"]
    parents = made.skeleton.parents.copy()
    parents[5] = -1
    with pytest.raises(ValueError, match="joint 0 as its only root"):
        write(made._replace(skeleton=made.skeleton._replace(parents=parents)), tmp_path / "a.amc")
