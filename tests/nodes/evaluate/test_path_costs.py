import numpy as np
import pytest

from reperform.nodes.evaluate.path_costs import path_costs
from reperform.nodes.motion_graph.essential import essential
from reperform.nodes.motion_graph.local_minima import local_minima


def test_curves_rise_and_pair_poses(pose_pairs):
    ours, theirs = essential(pose_pairs), local_minima(pose_pairs)
    curves = path_costs({"x": ours}, {"y": theirs}, samples=200)
    base, same, best = curves.cost[0].T
    assert (np.diff(base) >= 0).all()
    assert (np.diff(best) >= 0).all()
    assert (same <= base * (1 + 1e-6)).all()
    kept = np.isfinite(theirs.distance) & ~np.eye(42, dtype=bool)
    assert curves.pairs[0] == kept.sum()
    assert (best[0], best[-1]) == pytest.approx((ours.distance[kept].min(), ours.distance[kept].max()))
    assert curves.panel.tolist() == ["x"]
    assert curves.alpha.tolist() == [0.05]


def test_graphs_that_do_not_go_together_are_refused(pose_pairs):
    graph, alone = essential(pose_pairs), essential({("a", "a"): pose_pairs["a", "a"]})
    with pytest.raises(ValueError, match="same takes in the same order"):
        path_costs({"x": graph}, {"y": alone})
