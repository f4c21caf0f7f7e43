"""What would run, and why; nothing is computed and no array is opened."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from reperform.graphs.engine import Engine
from reperform.graphs.history import differences
from reperform.graphs.pipeline import Pipeline
from reperform.graphs.unit import Unit
from reperform.storage.errors import DamagedResult
from reperform.storage.store import Store


@dataclass
class StepPlan:
    """Items of a step: stale ones, cached ones, and the bytes that the stale ones will take (None: not known yet)."""

    items: int = 0
    stale: int = 0
    cached: int = 0
    bytes: int | None = 0
    reasons: list[str] = field(default_factory=list)

    def to_json(self) -> dict[str, Any]:
        """As `plan --json` writes it."""
        return {
            "items": self.items, "stale": self.stale, "cached": self.cached, "failed": 0, "skipped": 0, "seconds": 0.0,
            "bytes": self.bytes, "reasons": self.reasons,
        }  # fmt: skip


def plan(pipeline: Pipeline, store: Store, steps: Sequence[str] = ()) -> dict[str, StepPlan]:
    """Plan a run. What stands on stale items is counted as stale: it may still turn out the same."""
    engine = Engine(pipeline, store, steps)
    plans = {name: StepPlan() for name in engine.chosen}
    for unit, missing, total, reasons in _walk(engine, store):
        _count(plans[unit.step.name], store, unit, missing, total - missing, reasons)
    return plans


def why(pipeline: Pipeline, store: Store, step: str, label: str) -> list[str]:
    """Why a unit is stale or fresh: what changed in its key since it last completed, and in what it stands on."""
    engine = Engine(pipeline, store, [step])
    above: list[str] = []
    for unit, missing, total, reasons in _walk(engine, store):
        if unit.step.name == step and unit.label in (label, "*"):
            state = (
                f"{missing} of {total} item(s) stale"
                if missing
                else f"fresh: all {total} item(s) are in the store"
            )
            before = store.index.history(pipeline.name, *unit.name)
            versions = ", ".join(f"{k} {v}" for k, v in before["versions"].items()) if before else ""
            return [state, *reasons, *above, *([f"last computed with {versions}"] if versions else [])]
        if missing and not (reasons and reasons[0].startswith("stands on")):
            above += [f"{unit.item_text}: {reason}" for reason in reasons]
    return []


def _walk(engine: Engine, store: Store) -> Iterator[tuple[Unit, int, int, list[str]]]:
    """Every unit in order: missing items, all items, and why they are missing."""
    blocked: dict[tuple[str, str], list[str]] = {}
    for unit in engine.units.values():
        above = blocked.get(unit.name)
        before = store.index.history(engine.pipeline.name, *unit.name)
        if above:
            count = int(before["items"]) if before else 1
            missing, total, reasons = count, count, [f"stands on {', '.join(dict.fromkeys(above))}"]
        else:
            try:
                missing, total = engine.peek(unit)
                reasons = (
                    (differences(before, unit.parts) or ["its stored result is gone"]) if missing else []
                )
            except (ValueError, DamagedResult) as error:
                missing, total, reasons = 1, 1, [str(error)]
            if missing and unit.step.node.volatile:
                reasons = ["it measures, so it always runs"]
        if missing:
            for consumer in unit.consumers:
                blocked.setdefault(consumer, []).append(unit.step.name)
        yield unit, missing, total, reasons


def _count(entry: StepPlan, store: Store, unit: Unit, stale: int, cached: int, reasons: list[str]) -> None:
    entry.items += stale + cached
    entry.stale += stale
    entry.cached += cached
    if stale:
        size = store.index.bytes_per_item(unit.step.node.name)
        entry.bytes = None if size is None or entry.bytes is None else entry.bytes + int(size * stale)
    entry.reasons += [reason for reason in reasons if reason not in entry.reasons]


def needed(pipeline: Pipeline, store: Store) -> set[bytes]:
    """Keys of all manifests that a pipeline, as it is now, would be answered with."""
    engine = Engine(pipeline, store)
    for _ in _walk(engine, store):
        pass
    return {manifest.key for unit in engine.units.values() for manifest in unit.manifests.values()}
