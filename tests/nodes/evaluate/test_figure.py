"""Figures from measurements of several takes."""

import numpy as np
import pytest

from reperform.nodes.evaluate.figure import figure
from reperform.nodes.products.measures import Measures


def measures(value, names=("error", "share"), units=("m", "1")) -> Measures:
    return Measures(np.array(value, float), np.array(names), np.array(units))


TAKES = {
    "walk": measures([[0.01, 0.0], [np.nan, 1.0], [0.03, 0.0]]),
    "jog": measures([[0.08, 1.0]]),
}


@pytest.mark.parametrize(
    ("statistic", "expected"),
    [
        ("mean", 0.04),
        ("median", 0.03),
        ("min", 0.01),
        ("max", 0.08),
        ("sum", 0.12),
        ("count", 3),
        ("p99", 0.079),
    ],
)
def test_statistics_are_over_all_measured_frames_of_all_takes(statistic, expected):
    row = figure(TAKES, figure="e", statistic=statistic, entry="error")
    assert row.value[0] == pytest.approx(expected)
    assert row.unit[0] == ("frame" if statistic == "count" else "m")


def test_a_row_states_value_target_and_whether_it_holds():
    row = figure(TAKES, figure="error_mm", entry="error", unit="mm", side="<=", target=39.0, source="by hand")
    assert [column[0] for column in row] == [
        "error_mm", pytest.approx(40.0), "mm", "<=", 39.0, 0, "", pytest.approx(np.nan, nan_ok=True), "by hand",
    ]  # fmt: skip
    assert figure(TAKES, figure="x", entry="error", unit="mm", side="<=", target=40.1).holds[0] == 1


def test_a_figure_without_target_is_stated_only():
    row = figure(TAKES, figure="share", entry="share", unit="%")
    assert (row.value[0], row.side[0], row.holds[0]) == (50.0, "", -1)
    assert np.isnan(row.target[0])


def test_what_was_not_measured_does_not_hold():
    nothing = {"walk": measures([[np.nan, np.nan]])}
    row = figure(nothing, figure="e", entry="error", side="<=", target=1.0)
    assert np.isnan(row.value[0])
    assert row.holds[0] == -1
    assert figure(nothing, figure="e", entry="error", statistic="count").value[0] == 0


def test_all_entries_count_where_none_is_chosen():
    cameras = {"walk": measures([[0.9, 0.8], [0.7, 1.0]], ("cam0", "cam1"), ("1", "1"))}
    assert figure(cameras, figure="iou", statistic="min").value[0] == 0.7
    assert figure(cameras, figure="iou").value[0] == pytest.approx(0.85)


def test_a_peer_stands_beside_it():
    peer = {"walk": measures([[0.1, 0.0]])}
    row = figure(TAKES, peer, figure="e", entry="error", unit="mm", peer_name="other")
    assert (row.peer[0], row.peer_value[0]) == ("other", pytest.approx(100.0))


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"entry": "errors"}, "no entry 'errors'; measured were error, share"),
        ({}, "1, m cannot make one figure"),
        ({"entry": "error", "unit": "s"}, "'m' cannot be stated in 's'"),
        ({"entry": "error", "side": "<="}, "both side and target"),
        ({"entry": "error", "target": 3.0}, "both side and target"),
    ],
)
def test_wrong_figures_are_refused(options, told):
    with pytest.raises(ValueError, match=told):
        figure(TAKES, figure="e", **options)
