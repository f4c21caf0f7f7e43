from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from reperform.viewer.browser import Results
from reperform.viewer.screenshot import screenshot
from reperform.viewer.session import ALL_PAIRS, Session
from reperform.viewer.window import NoDisplayError, start_session, view


@pytest.fixture
def results(products: dict[str, Any], walk: Callable[..., Any]) -> Results:
    takes = ("stand", "stand_to_walk", "walk")
    steps = {
        "actor": {take: walk(6 + k, phase=k) for k, take in enumerate(takes)},
        "truth": products["performance"],
        "similarity": {(a, b): products["matrix"] for a in takes[:2] for b in takes[:2]},
        "graph": products["graph"],
        "table": products["table"],
    }
    return Results(steps, [*steps, "render"], {"graph": "stale"}, "quickstart")


def test_items_and_states_are_told(results: Results) -> None:
    session = Session(results, "similarity")
    assert results.items("actor") == ["stand", "stand_to_walk", "walk"]
    assert results.items("graph") == [""]
    assert results.items("render") == []
    assert (results.status("graph"), results.status("render"), results.status("table")) == (
        "stale",
        "missing",
        "fresh",
    )
    assert session.items()[:2] == [ALL_PAIRS, "stand/stand"]


def test_the_last_computed_step_comes_first(results: Results) -> None:
    assert Session(results).step == "table"


def test_an_item_stays_chosen_between_steps(results: Results) -> None:
    session = Session(results, "actor", "walk", 99)
    assert session.frame == 7
    session.select("table")
    session.select("actor")
    assert session.item == "stand"


def test_time_runs_at_the_frame_rate_and_starts_anew(results: Results) -> None:
    session = Session(results, "actor", "stand")
    assert not session.tick(1.0)
    session.play()
    assert not session.tick(0.03)
    assert session.tick(0.03)
    assert session.frame == 1
    session.tick(5 / 25)
    assert session.frame == 0
    session.speed = 0.5
    assert not session.tick(0.03)
    session.pause()
    assert not session.tick(9.0)


def test_wrong_choices_name_the_right_ones(results: Results) -> None:
    with pytest.raises(ValueError, match="no step 'actors'; the steps are actor, truth"):
        Session(results, "actors")
    with pytest.raises(ValueError, match="no item 'run'; it has stand"):
        Session(results, "actor", "run")


def test_finishes_depend_on_what_is_known(results: Results) -> None:
    assert Session(results, "truth").finishes() == ["shaded", "textured", "checker"]
    assert start_session(results, "truth", None, 0, None).surface == "textured"
    with pytest.raises(ValueError, match="got 'velvet'"):
        start_session(results, "truth", None, 0, "velvet")


def test_a_screenshot_needs_no_display(results: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    session = Session(results, "actor", "walk", 3)
    first = screenshot(session, (640, 400))
    assert (first.shape, first.dtype) == ((400, 640, 3), np.uint8)
    session.orbit(1.0, 0.2)
    assert np.any(first[:340, 232:] != screenshot(session, (640, 400))[:340, 232:])


def test_a_step_without_result_says_so(results: Results) -> None:
    session = Session(results, "render")
    assert "has not been computed" in session.problem
    assert screenshot(session, (640, 400)).shape == (400, 640, 3)


def test_no_display_is_an_error_with_a_cure(results: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.raises(NoDisplayError, match="--screenshot"):
        view(results)
