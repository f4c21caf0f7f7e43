import itertools

import numpy as np

from reperform.nodes.kernels.signatures import cells_of, common_planes, merged, signatures, single


def _take(seed, frames=3, count=50):
    rng = np.random.default_rng(seed)
    return signatures(
        [rng.random(count) + 0.01 for _ in range(frames)],
        [rng.normal(size=(count, 6)) for _ in range(frames)],
    )


def test_merging_keeps_mass_and_mean():
    take = _take(0)
    planes = common_planes([take, _take(1)], 8)
    few = merged(take, planes)
    assert (np.diff(few.first) <= 8).all()
    for t in range(3):
        old, new = (slice(s.first[t], s.first[t + 1]) for s in (take, few))
        np.testing.assert_allclose(few.mass[new].sum(), 1)
        np.testing.assert_allclose(
            few.mass[new] @ few.point[new], take.mass[old] @ take.point[old], atol=1e-12
        )


def test_more_cells_stray_less():
    take = _take(2)
    strays = []
    for count in (1, 4, 16, 64):
        cell = cells_of(take.point, common_planes([take], count))
        assert len(np.unique(cell)) == count
        means = np.stack(
            [np.average(take.point[cell == c], axis=0, weights=take.mass[cell == c]) for c in cell]
        )
        strays.append(take.mass @ ((take.point - means) ** 2).sum(axis=1))
    assert all(a > 1.2 * b for a, b in itertools.pairwise(strays))


def test_more_cells_than_points_leave_every_point_alone():
    take = _take(3, frames=1, count=9)
    few = merged(take, common_planes([take], 40))
    np.testing.assert_allclose(np.sort(few.mass), np.sort(take.mass))


def test_a_single_frame_is_that_frame():
    take = _take(4)
    one = single(take, 1)
    assert one.first.tolist() == [0, 50]
    np.testing.assert_array_equal(one.point, take.point[50:100])
