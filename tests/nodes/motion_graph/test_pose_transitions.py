import numpy as np
import pytest

from reperform.nodes.kernels.warped_transitions import best_transitions
from reperform.nodes.motion_graph.pose_transitions import pose_transitions
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity


def take(frames: int, fps: float = 12.0) -> MeshSequence:
    return MeshSequence(
        np.zeros((frames, 3, 3), np.float32), np.array([[0, 1, 2]], np.int32), np.float32(fps)
    )


def matrix(rows: int, columns: int) -> Dissimilarity:
    return Dissimilarity(np.random.default_rng(rows).uniform(size=(rows, columns)).astype(np.float32))


def test_bounds_in_seconds_are_frames_of_the_takes():
    distance = matrix(30, 26)
    found = pose_transitions(distance, (take(30), take(26)), alpha=0.2, shortest=0.5, longest=1.0)
    expected = best_transitions(distance.distance, 0.2, 6, 12)
    for name, field in expected._asdict().items():
        np.testing.assert_array_equal(getattr(found, name), field)
    assert (float(found.alpha), float(found.fps)) == (0.2, 12.0)
    longest = found.source_length[:18].max()
    assert 6 <= found.source_length.min() <= longest <= 12


def test_every_frame_has_a_transition_to_every_other_even_in_takes_shorter_than_the_window():
    found = pose_transitions(matrix(3, 2), (take(3), take(2)), shortest=0.5)
    assert found.duration.shape == (3, 2)
    assert found.duration.min() >= 5
    assert np.isfinite(found.deformation).all()


def test_dearer_time_makes_transitions_no_longer():
    distance = matrix(24, 24)
    costs = []
    for alpha in (0.01, 0.1, 1.0):
        found = pose_transitions(distance, (take(24), take(24)), alpha=alpha)
        costs.append((float(found.duration.mean()), float(found.deformation.mean())))
    assert costs == sorted(costs, key=lambda pair: (-pair[0], pair[1]))


def test_what_does_not_fit_is_refused():
    a, b = take(8), take(9)
    with pytest.raises(ValueError, match="one frame rate, got 12 and 25 Hz"):
        pose_transitions(matrix(8, 9), (a, take(9, 25.0)))
    with pytest.raises(ValueError, match=r"must be \(8, 9\)"):
        pose_transitions(matrix(9, 8), (a, b))
    with pytest.raises(ValueError, match="not be below shortest"):
        pose_transitions(matrix(8, 9), (a, b), shortest=1.0, longest=0.5)
    with pytest.raises(ValueError, match="finite"):
        pose_transitions(Dissimilarity(np.full((8, 9), np.nan, np.float32)), (a, b))
