"""What a run did, step by step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

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


def step_reports(chosen: Sequence[str], units: Mapping[Name, Unit]) -> dict[str, StepReport]:
    """Sums over the units of every chosen step."""
    sums: dict[str, list[float]] = {name: [0, 0, 0, 0, 0.0] for name in chosen}
    for (name, _), unit in units.items():
        row = sums[name]
        row[0] += unit.computed
        row[1] += unit.cached
        row[2] += unit.failed
        row[3] += unit.status in ("skipped", "waiting", "open")
        row[4] += unit.seconds
    return {
        name: StepReport(int(c + k + f + s), int(c), int(k), int(f), int(s), seconds)
        for name, (c, k, f, s, seconds) in sums.items()
    }
