"""Picture errors as measurements."""

import numpy as np

from reperform.nodes.evaluate.picture import picture
from reperform.nodes.products.picture_error import PictureError


def test_entries_and_units():
    error = PictureError(np.float32(24.5), np.float32(0.75), np.float32(0.5), np.float32(25))
    found = picture(error)
    assert dict(zip(found.name.tolist(), found.value.tolist(), strict=True)) == {
        "psnr": 24.5, "ssim": 0.75, "overlap": 0.5,
    }  # fmt: skip
    assert found.unit.tolist() == ["dB", "1", "1"]
