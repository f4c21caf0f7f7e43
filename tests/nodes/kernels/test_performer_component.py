import numpy as np

from reperform.nodes.kernels.performer_component import fill_small_holes, performer_component


def test_the_performer_is_the_largest_region_off_the_edge() -> None:
    mask = np.zeros((60, 90), bool)
    mask[0:9, 5:85] = True  # a rig at the top
    mask[20:50, 40:52] = True
    mask[52:58, 41:50] = True  # a shoe two pixels under the trouser leg
    mask[30:33, 70:73] = True
    found = performer_component(mask, gap=5, smallest=20)
    assert found[20:50, 40:52].all()
    assert found[52:58, 41:50].all()
    assert found.sum() == 30 * 12 + 6 * 9


def test_only_specks_are_nobody() -> None:
    mask = np.zeros((30, 40), bool)
    mask[10:12, 10:13] = True
    assert not performer_component(mask, gap=3, smallest=20).any()


def test_small_holes_are_filled_and_large_ones_and_bays_are_not() -> None:
    mask = np.ones((30, 40), bool)
    mask[5:7, 5:8] = False
    mask[15:22, 10:20] = False
    mask[0:3, 30:32] = False
    filled = fill_small_holes(mask, 10)
    assert filled[5:7, 5:8].all()
    assert not filled[15:22, 10:20].any()
    assert not filled[0:3, 30:32].any()
