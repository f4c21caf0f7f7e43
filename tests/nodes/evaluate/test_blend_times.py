import sys

import numpy as np

from reperform.nodes.evaluate.blend_times import blend_times


def test_every_method_and_the_peer_are_timed(turned_pairs, monkeypatch):
    measures = blend_times(turned_pairs, repeats=1)
    names = measures.name.tolist()
    assert names[-1] == "ARAP / non-linear" and measures.value.shape == (2, 6)
    assert (measures.value[:, :4] > 0).all()
    # linear blending is not slower than anything else that does it too and more
    assert (measures.value[:, 0] < measures.value[:, 3]).all()
    monkeypatch.setitem(sys.modules, "igl", None)
    without = blend_times(turned_pairs, repeats=1)
    assert np.isnan(without.value[:, 4:]).all() and np.isfinite(without.value[:, :4]).all()
