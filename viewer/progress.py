"""Progress of long work: bars on a terminal, sparse plain lines when piped."""

from __future__ import annotations

import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from types import TracebackType
from typing import Any, TextIO

# Rates are taken over this many seconds, so that they follow a change of pace.
RATE_WINDOW = 30.0


class _Step:
    """Counts of one step and the pace of what is really computed."""

    def __init__(self, total: int, now: float) -> None:
        self.total, self.started = total, now
        self.computed = self.cached = self.failed = 0
        self.samples: deque[tuple[float, int]] = deque([(now, 0)])
        self.printed = now
        self.task: Any = None

    @property
    def done(self) -> int:
        return self.computed + self.cached + self.failed

    def sample(self, now: float) -> None:
        worked = self.computed + self.failed
        if now - self.samples[-1][0] >= 0.2 or len(self.samples) == 1:
            self.samples.append((now, worked))
        while len(self.samples) > 2 and now - self.samples[1][0] > RATE_WINDOW:
            self.samples.popleft()

    def rate(self, now: float) -> float:
        """Items computed per second; 0 where nothing is known yet."""
        then, worked = self.samples[0]
        return (self.computed + self.failed - worked) / (now - then) if now > then else 0.0


class Progress:
    """Shows how far each step is: done of total, rate, time left. Use it as a context manager.

    stream: where to write, standard error by default.  interval: seconds between two plain lines of one step.
    On a terminal the bars appear with the first item that is computed, so a run with nothing to do stays
    silent and never loads rich. May be called from any thread.
    """

    def __init__(
        self,
        stream: TextIO | None = None,
        *,
        interval: float = 3.0,
        terminal: bool | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._stream = stream if stream is not None else sys.stderr
        self._terminal = self._stream.isatty() if terminal is None else terminal
        self._interval, self._clock = interval, clock
        self._steps: dict[str, _Step] = {}
        self._lock = threading.RLock()
        self._bars: Any = None

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def start(self, step: str, total: int) -> None:
        """A step has so many items (more), those in the cache included; the takes of a step arrive one by one."""
        with self._lock:
            if step in self._steps:
                self._steps[step].total += total
                return
            self._steps[step] = _Step(total, self._clock())
            if self._bars is not None:
                self._add_bar(step)

    def advance(self, step: str, computed: int = 1, cached: int = 0, failed: int = 0) -> None:
        """So many items more of a step were computed, found in the cache, or failed."""
        with self._lock:
            state, now = self._steps[step], self._clock()
            state.computed += computed
            state.cached += cached
            state.failed += failed
            state.sample(now)
            if self._terminal:
                self._show_bar(step, state, now)
            elif (computed or failed) and now - state.printed >= self._interval:
                state.printed = now
                self._write(_line(step, state, now))

    def finish(self, step: str) -> None:
        """A step is over: says what was computed, cached and failed, and how long it took."""
        with self._lock:
            state, now = self._steps.pop(step), self._clock()
            if self._bars is not None and state.task is not None:
                self._bars.remove_task(state.task)
            if state.computed or state.failed or not self._terminal:
                self._write(_summary(step, state, now))

    def note(self, text: str) -> None:
        """A remark above the bars, such as a damaged chunk that will be recomputed."""
        with self._lock:
            self._write(text)

    def close(self) -> None:
        """Take the bars away; what was written stays."""
        with self._lock:
            if self._bars is not None:
                self._bars.stop()
                self._bars = None

    def _write(self, text: str) -> None:
        if self._bars is not None:
            self._bars.console.print(text, markup=False, highlight=False, soft_wrap=True)
        else:
            print(text, file=self._stream, flush=True)

    def _show_bar(self, step: str, state: _Step, now: float) -> None:
        if self._bars is None:
            if not (state.computed or state.failed):
                return
            self._bars = _open_bars(self._stream)
            for name in self._steps:
                self._add_bar(name)
        if state.task is not None:
            self._bars.update(state.task, completed=state.done, total=state.total, pace=_pace(state, now))

    def _add_bar(self, step: str) -> None:
        state = self._steps[step]
        state.task = self._bars.add_task(step, total=state.total, completed=state.done, pace="")


def _open_bars(stream: TextIO) -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import Progress as Bars

    bars = Bars(
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=32),
        MofNCompleteColumn(),
        TextColumn("{task.fields[pace]}", markup=False),
        console=Console(file=stream, force_terminal=True),
        transient=True,
        refresh_per_second=5,
    )
    bars.start()
    return bars


def duration(seconds: float) -> str:
    """Seconds as people read them: `0.4 s`, `12 s`, `3:05`, `1:02:09`."""
    if seconds < 10:
        return f"{seconds:.1f} s"
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def _pace(state: _Step, now: float) -> str:
    rate = state.rate(now)
    parts = []
    if rate > 0:
        parts.append(f"{rate:.3g} items/s" if rate >= 0.1 else f"{1 / rate:.3g} s/item")
        if state.done < state.total:
            parts.append(f"{duration((state.total - state.done) / rate)} left")
    if state.failed:
        parts.append(f"{state.failed} failed")
    return ", ".join(parts)


def _line(step: str, state: _Step, now: float) -> str:
    share = 100 * state.done // max(state.total, 1)
    pace = _pace(state, now)
    return f"{step}: {state.done}/{state.total} ({share} %)" + (f", {pace}" if pace else "")


def _summary(step: str, state: _Step, now: float) -> str:
    counts = [
        f"{count} {word}"
        for count, word in ((state.computed, "computed"), (state.cached, "cached"), (state.failed, "failed"))
        if count
    ]
    short = f", {state.total - state.done} not done" if state.done < state.total else ""
    return f"{step}: {', '.join(counts) or 'nothing to do'}{short} in {duration(now - state.started)}"
