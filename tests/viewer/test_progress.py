import io

import pytest

from reperform.viewer.progress import Progress, duration


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_lines_are_sparse_and_tell_rate_and_time_left() -> None:
    stream, clock = io.StringIO(), Clock()
    with Progress(stream, interval=3.0, clock=clock) as progress:
        progress.start("mattes", 41)
        progress.advance("mattes", 0, cached=1)
        for _ in range(20):
            clock.now += 0.5
            progress.advance("mattes")
    lines = stream.getvalue().splitlines()
    assert len(lines) == 3
    assert lines[-1] == "mattes: 19/41 (46 %), 2 items/s, 11 s left"


def test_finish_sums_up() -> None:
    stream, clock = io.StringIO(), Clock()
    progress = Progress(stream, clock=clock)
    progress.start("hull", 5)
    progress.advance("hull", 2, cached=1, failed=1)
    clock.now += 75
    progress.finish("hull")
    assert stream.getvalue() == "hull: 2 computed, 1 cached, 1 failed, 1 not done in 1:15\n"


def test_a_terminal_stays_silent_where_all_is_cached() -> None:
    stream = io.StringIO()
    with Progress(stream, terminal=True) as progress:
        progress.start("hull", 5)
        progress.advance("hull", 0, cached=5)
        progress.finish("hull")
    assert stream.getvalue() == ""


def test_a_terminal_gets_bars_and_notes() -> None:
    stream = io.StringIO()
    with Progress(stream, terminal=True) as progress:
        progress.start("hull", 2)
        progress.advance("hull")
        progress.note("damaged chunk: recomputed")
        progress.finish("hull")
    assert "hull" in stream.getvalue()
    assert "damaged chunk: recomputed" in stream.getvalue()


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.44, "0.4 s"), (12.3, "12 s"), (185, "3:05"), (3729, "1:02:09")]
)
def test_duration(seconds: float, text: str) -> None:
    assert duration(seconds) == text
