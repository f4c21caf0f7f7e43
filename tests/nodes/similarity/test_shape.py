import numpy as np
import pytest

from reperform.nodes.products.mesh import MeshSequence, Surfaces
from reperform.nodes.products.shape_histograms import ShapeHistograms
from reperform.nodes.similarity.shape import shape
from reperform.nodes.similarity.shape_histogram import shape_histogram
from reperform.nodes.similarity.vertex_velocity import vertex_velocity


def _take(seed, frames, bins=(3, 4, 12)):
    share = np.random.default_rng(seed).random((frames, *bins))
    share /= share.sum((1, 2, 3), keepdims=True)
    return ShapeHistograms(share.astype(np.float32), np.zeros((frames, 3), np.float32), np.float32(1))


def test_equals_exhaustive_search_over_turns():
    a, b = _take(0, 3), _take(1, 5)
    weight = np.sqrt((np.arange(3) + 0.5) / 3)[None, :, None, None]

    def scaled(take):
        h = take.share.astype(np.float64) * weight
        return h / np.sqrt((h**2).sum((1, 2, 3), keepdims=True))

    x, y = scaled(a), scaled(b)
    truth = np.min(
        [[[np.linalg.norm(p - np.roll(q, k, 2)) for k in range(12)] for q in y] for p in x], axis=2
    )
    np.testing.assert_allclose(shape((a, b)).distance, truth, rtol=1e-6)


def test_zero_for_a_turned_copy_and_symmetric():
    a = _take(2, 4)
    turned = a._replace(share=np.roll(a.share, 5, axis=3))
    distance = shape((a, turned)).distance
    assert np.abs(np.diag(distance)).max() < 1e-6
    np.testing.assert_allclose(distance, shape((turned, a)).distance.T, atol=1e-7)
    assert distance[0, 1] > 0.01


def test_temporal_filter_is_the_mean_along_diagonals():
    a, b = _take(3, 6), _take(4, 5)
    plain, filtered = (shape((a, b), filter_frames=n).distance for n in (0, 2))
    np.testing.assert_allclose(filtered[2, 2], np.mean([plain[k, k] for k in range(5)]), rtol=1e-6)
    np.testing.assert_allclose(filtered[0, 3], np.mean([plain[0, 3], plain[1, 4]]), rtol=1e-6)
    np.testing.assert_allclose(filtered[5, 0], plain[5, 0], rtol=1e-6)


def test_refuses_different_bins():
    with pytest.raises(ValueError, match="one set of bins"):
        shape((_take(0, 2), _take(0, 2, (3, 4, 10))))


def _histograms(clip, faces):
    frames = [shape_histogram(Surfaces(v, faces, np.float32(25))) for v in clip]
    return ShapeHistograms(
        np.stack([frame.share for frame in frames]),
        np.stack([frame.centre for frame in frames]),
        frames[0].reach,
    )


def test_finds_the_same_phase_of_another_walk(data_folder):
    with np.load(data_folder / "twin" / "watertight.npz") as twin:
        faces, walk, fast = twin["faces"], twin["walk"][10:40], twin["walk_fast"][:40]
    distance = shape((_histograms(walk, faces), _histograms(fast, faces))).distance
    meshes = (MeshSequence(walk, faces, np.float32(25)), MeshSequence(fast, faces, np.float32(25)))
    truth = vertex_velocity(meshes, velocity_weight=0.0).distance
    chosen = truth[np.arange(30), distance.argmin(1)]
    assert chosen.mean() < 1.25 * truth.min(1).mean()
