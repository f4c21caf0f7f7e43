"""What a run did, step by step."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from reperform.graphs.errors import RunError
from reperform.graphs.messages import Item, ItemOutcome
from reperform.graphs.unit import Name, Unit


@dataclass(frozen=True)
class StepReport:
    """Counts of items, and the seconds that computing them took (summed over workers)."""

    items: int
    computed: int
    cached: int
    failed: int
    skipped: int
    seconds: float


@dataclass(frozen=True)
class RunReport:
    """Counts by step, and the wall-clock seconds of the engine."""

    pipeline: str
    seconds: float
    steps: Mapping[str, StepReport]

    def to_json(self) -> dict[str, Any]:
        """As `run --json` writes it."""
        steps = {
            name: {**asdict(step), "seconds": round(step.seconds, 4)} for name, step in self.steps.items()
        }
        return {"pipeline": self.pipeline, "seconds": round(self.seconds, 4), "steps": steps}


def _skipped(unit: Unit) -> int:
    """Items of a unit that were never tried; one, where it is not known how many there are."""
    if unit.work is not None and unit.status in ("open", "failed"):
        return len(unit.work.items) - unit.computed - unit.cached - unit.failed
    return int(unit.status in ("skipped", "waiting"))


def step_reports(chosen: Sequence[str], units: Mapping[Name, Unit]) -> dict[str, StepReport]:
    """Sums over the units of every chosen step."""
    sums: dict[str, list[float]] = {name: [0, 0, 0, 0, 0.0] for name in chosen}
    for (name, _), unit in units.items():
        row = sums[name]
        row[0] += unit.computed
        row[1] += unit.cached
        row[2] += unit.failed
        row[3] += _skipped(unit)
        row[4] += unit.seconds
    return {
        name: StepReport(int(c + k + f + s), int(c), int(k), int(f), int(s), seconds)
        for name, (c, k, f, s, seconds) in sums.items()
    }


def failure(unit: Unit, item: Item, outcome: ItemOutcome, resume: str) -> str:
    """What a user is told of an item that failed: where, why, and the command that reruns only what is missing."""
    frame = "" if item.frame is None else f", frame {item.frame}"
    camera = "" if item.camera is None else f", camera {item.camera}"
    where = f"step {unit.item_text!r}{frame}{camera} (node {unit.step.node.name})"
    trace = f"\n{outcome.trace}" if os.environ.get("REPERFORM_TRACEBACK") and outcome.trace else ""
    return (
        f"{where} failed: {outcome.error}\n"
        f"  finished items are kept; rerun only what is missing with: {resume} {unit.step.name}{trace}"
    )


def refuse_failures(units: Iterable[Unit], report: RunReport) -> None:
    """Raise RunError with the first twenty failures, where there are any."""
    failures = [error for unit in units for error in unit.errors]
    if failures:
        more = [f"... and {len(failures) - 20} more failures"] if len(failures) > 20 else []
        raise RunError("\n".join(failures[:20] + more), report)
