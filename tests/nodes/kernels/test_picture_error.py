import numpy as np
import pytest

from reperform.nodes.kernels.picture_error import psnr, ssim


def picture(seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).integers(20, 230, (40, 50, 3), dtype=np.uint8)


def test_psnr_of_an_offset():
    one = picture()
    assert psnr(one, one) == np.inf
    assert psnr(one + np.uint8(10), one) == pytest.approx(20 * np.log10(25.5))
    mask = np.zeros((40, 50), bool)
    assert np.isnan(psnr(one, one, mask))
    mask[3, 4] = True
    other = one.copy()
    other[3, 4, 0] += 3
    other[9, 9] = 0
    assert psnr(other, one, mask) == pytest.approx(10 * np.log10(255**2 / 3))


def test_ssim_by_hand():
    one = picture()
    assert ssim(one, one) == pytest.approx(1)
    a, b = np.full((30, 30, 3), 100.0), np.full((30, 30, 3), 130.0)
    c1 = 2.55**2
    assert ssim(a, b) == pytest.approx((2 * 100 * 130 + c1) / (100**2 + 130**2 + c1))
    assert ssim(one, picture(1)) < 0.2


def test_sizes_must_agree():
    with pytest.raises(ValueError, match="need one size"):
        psnr(picture(), picture()[1:])
