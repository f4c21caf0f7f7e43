import numpy as np
import pytest

from reperform.nodes.kernels.ground_plane import align, apply
from reperform.nodes.studio.twin_between import twin_between


def test_both_ends_are_the_stored_poses(data_folder):
    folder = str(data_folder / "twin")
    with np.load(data_folder / "twin" / "watertight.npz") as stored:
        walk, run = stored["walk"][30], stored["run"][9]
    start = twin_between(folder=folder, first="walk:30", second="run:9", weight=0.0).vertices[0]
    end = twin_between(folder=folder, first="walk:30", second="run:9", weight=1.0).vertices[0]
    np.testing.assert_allclose(start, walk, atol=3e-4)
    np.testing.assert_allclose(apply(run, align(end, run)[0]), end, atol=3e-4)


def test_limbs_keep_their_length_half_way(data_folder):
    folder = str(data_folder / "twin")
    with np.load(data_folder / "twin" / "watertight.npz") as stored:
        a, b, labels = stored["jump"][16], stored["jump"][29], stored["labels"]
        shin = labels == stored["label_names"].tolist().index("shin_l")
    middle = twin_between(folder=folder, first="jump:16", second="jump:29").vertices[0]
    reach = []
    for pose in (a, b, middle):
        points = pose[shin] - pose[shin].mean(0)
        along = np.linalg.svd(points, full_matrices=False)[2][0]
        reach.append(np.ptp(points @ along))
    assert min(reach[:2]) - 0.01 < reach[2] < max(reach[:2]) + 0.01


def test_poses_that_are_not_there_are_told(data_folder):
    folder = str(data_folder / "twin")
    with pytest.raises(ValueError, match="CLIP:FRAME of a clip"):
        twin_between(folder=folder, first="fly:0", second="run:0")
    with pytest.raises(ValueError, match=r"run has frames 0 \.\. 35"):
        twin_between(folder=folder, first="walk:0", second="run:99")
