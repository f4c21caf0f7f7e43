import numpy as np

from reperform.nodes.kernels.rasterise import rasterise
from reperform.nodes.kernels.surface_hits import surface_hits

PIXELS = np.array([[10.2, 5.1], [60.7, 18.4], [22.3, 47.9]])
FACES = np.array([[0, 1, 2]], np.int32)
DEPTH = np.array([1.0, 1.5, 2.0])


def test_coverage_sums_to_the_area():
    hits = surface_hits(PIXELS, DEPTH, FACES, 60, 80, 5)
    a, b, c = PIXELS
    area = 0.5 * abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
    assert abs(hits.coverage.sum() - area) < 0.01 * area


def test_shows_the_centre_where_that_is_covered():
    ids, barycentric, _ = rasterise(PIXELS, DEPTH, FACES, 60, 80)
    hits = surface_hits(PIXELS, DEPTH, FACES, 60, 80, 3)
    dense = np.full((60, 80), -2)
    dense[hits.y, hits.x] = hits.ids
    assert (dense[ids >= 0] == ids[ids >= 0]).all()
    inside = ids[hits.y, hits.x] >= 0
    np.testing.assert_allclose(
        hits.barycentric[inside], barycentric[hits.y[inside], hits.x[inside]], atol=1e-4
    )
    # an uncovered centre shows the covered point nearest it: a sample offset away at most
    assert (hits.barycentric[~inside] >= 0).all()
    assert (hits.coverage[~inside] < 1).all()


def test_one_sample_is_the_rasteriser():
    ids, _, _ = rasterise(PIXELS, DEPTH, FACES, 60, 80)
    hits = surface_hits(PIXELS, DEPTH, FACES, 60, 80, 1)
    assert np.array_equal(np.stack([hits.y, hits.x]), np.nonzero(ids >= 0))
    assert (hits.coverage == 1).all()


def test_out_of_the_picture_there_is_nothing():
    for pixels, depth in ((PIXELS + 500, DEPTH), (PIXELS, -DEPTH), (PIXELS * np.nan, DEPTH)):
        assert len(surface_hits(pixels, depth, FACES, 60, 80).ids) == 0
