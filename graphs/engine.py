"""The engine: runs what is stale, and nothing else.

One loop in one thread: units whose inputs are complete are resolved against the index; what is missing goes to the
executor in batches; every outcome is committed before the next is looked at.
"""

from __future__ import annotations

import errno
import os
import time
from collections import deque
from collections.abc import Sequence
from typing import Any

from reperform.graphs.keys import output_key
from reperform.graphs.listener import Progress, Silent
from reperform.graphs.mending import Mending
from reperform.graphs.pace import Pace, Room
from reperform.graphs.pipeline import Pipeline
from reperform.graphs.report import RunReport, failure, refuse_failures, step_reports
from reperform.graphs.resolve import Resolver
from reperform.graphs.unit import Name, Unit, Work, batch_of
from reperform.storage.errors import DamagedResult, StoreError
from reperform.storage.index import Manifest, Records, Result, Segment
from reperform.storage.store import Store


class Engine:
    """One run of some steps of a pipeline on a store."""

    def __init__(
        self,
        pipeline: Pipeline,
        store: Store,
        steps: Sequence[str] = (),
        *,
        open_executor: Any = None,
        progress: Progress | None = None,
        keep_going: bool = False,
        resume: str = "reperform run",
    ) -> None:
        self.pipeline, self.store = pipeline, store
        self.chosen = pipeline.chosen(steps)
        self.progress: Progress = progress or Silent()
        self._open_executor, self._keep_going, self._resume = open_executor, keep_going, resume
        self._executor: Any = None
        self._stopping = False
        run = os.urandom(16)
        self.resolver = Resolver(pipeline, store.url, store.index, self.manifest, run)
        self.units: dict[Name, Unit] = {}
        self._ready: deque[Unit] = deque()
        self._open: deque[Unit] = deque()
        self._in_flight: dict[int, tuple[Unit, Work, list[int]]] = {}
        self._room = Room()
        self._waiting: dict[Name, Unit] = {}
        self._tag = 0
        self._pace = Pace(store.index)
        self._mending = Mending(store, self.units)
        self._store_error: str | None = None
        self._left: dict[str, set[Name]] = {name: set() for name in self.chosen}
        self.notes: list[str] = []
        self._make_units()

    # -- what stands on what ------------------------------------------------------------------------------------

    def _make_units(self) -> None:
        for name in self.chosen:
            step = self.pipeline.steps[name]
            labels = ("*",) if step.node.output_many == "dataset" else step.units
            for label in labels:
                unit = self.units[name, label] = Unit(step, label)
                self._left[name].add(unit.name)
                unit.missing = {self._unit_name(*need) for need in self.resolver.needs(step, label)}
                for need in unit.missing:
                    self.units[need].consumers.append(unit.name)
                if not unit.missing:
                    self._ready.append(unit)

    def _unit_name(self, step: str, label: str) -> Name:
        return (step, "*") if self.pipeline.steps[step].node.output_many == "dataset" else (step, label)

    def manifest(self, step: str, label: str) -> Manifest:
        """The manifest of a finished output."""
        return self.units[self._unit_name(step, label)].manifests[label]

    # -- the loop -----------------------------------------------------------------------------------------------

    def run(self) -> RunReport:
        """Run to the end. Raises RunError with all failures once nothing more can be done."""
        start = time.perf_counter()
        try:
            while True:
                while self._ready:
                    self._resolve(self._ready.popleft())
                self._dispatch()
                if not self._in_flight and not self._waits_elsewhere():
                    if self._ready:
                        continue
                    break
                self._take_outcome()
        finally:
            if self._executor is not None:
                self._executor.close()
        report = RunReport(
            self.pipeline.name, time.perf_counter() - start, step_reports(self.chosen, self.units)
        )
        self._remember()
        if self._store_error:
            raise StoreError(errno.EIO, self._store_error)
        refuse_failures(self.units.values(), report)
        return report

    def _resolve(self, unit: Unit) -> None:
        """Answer a unit from the index, or open it for work."""
        try:
            self.resolver.key(unit)
            if self._answer(unit):
                return
            unit.work = work = self.resolver.expand(unit)
        except DamagedResult as damage:
            self._mend(unit, damage.segment, damage.rows, damage.reason)
            return
        except ValueError as error:
            self._fail(unit, f"{unit.item_text} ({unit.step.node.name}): {error}")
            return
        found = self.store.index.results(work.keys)
        notes = self.store.mend(sorted({result.segment for result in found.values()}))
        if notes:
            self._note(notes)
            found = self.store.index.results(work.keys)
        work.results = found
        unit.cached = 0 if unit.mended else unit.cached
        if work.outputs is not None:
            work.queue.extend([] if len(found) == len(work.keys) else [0])
            unit.cached += not work.queue
        else:
            # items with equal inputs have one key, and are computed once
            first: set[bytes] = set()
            for position, key in enumerate(work.keys):
                if key not in found and key not in first:
                    first.add(key)
                    work.queue.append(position)
            unit.cached += len(work.keys) - len(work.queue)
        self.progress.start(unit.step.name, 0 if unit.mended else len(work.items))
        self.progress.advance(unit.step.name, 0, 0 if unit.mended else len(work.items) - len(work.queue))
        unit.status = "open"
        self._open.append(unit)
        self._settle(unit)

    def peek(self, unit: Unit) -> tuple[int, int]:
        """(missing, all) items of a unit whose inputs are all complete; computes nothing."""
        self.resolver.key(unit)
        if self._answer(unit):
            return 0, unit.cached
        work = self.resolver.expand(unit)
        if unit.step.node.volatile or work.outputs is not None:
            return len(work.items), len(work.items)
        found = self.store.index.results(work.keys)
        return sum(key not in found for key in work.keys), len(work.keys)

    def _answer(self, unit: Unit) -> bool:
        """Whether the index has the whole unit; then it is done."""
        step = unit.step
        if step.node.volatile:
            return False
        if step.node.output_many == "dataset":
            keys = {take: output_key(unit.key, take) for take in step.takes}
        else:
            keys = {unit.label: unit.key}
        manifests = {label: self.store.index.manifest(key) for label, key in keys.items()}
        found = {label: manifest for label, manifest in manifests.items() if manifest is not None}
        if len(found) < len(keys):
            return False
        notes = [note for manifest in found.values() for note in self.store.check(manifest)]
        if notes:
            self._note(notes)
            return False
        items = 1 if step.node.output_many == "dataset" else int(next(iter(found.values())).summary["items"])
        if not unit.mended:
            unit.cached = items
            self.progress.start(step.name, items)
            self.progress.advance(step.name, 0, items)
        self._finish(unit, found)
        return True

    def _finish(self, unit: Unit, manifests: dict[str, Manifest]) -> None:
        unit.manifests, unit.status, unit.work = manifests, "done", None
        for name in unit.consumers:
            consumer = self.units[name]
            consumer.missing.discard(unit.name)
            if not consumer.missing and consumer.status == "waiting":
                self._ready.append(consumer)
        self._close(unit)

    def _fail(self, unit: Unit, *errors: str) -> None:
        unit.errors += errors
        unit.status = "failed"
        unit.failed = max(unit.failed, 1)
        if not self._keep_going:
            self._stopping = True
        self._skip_consumers(unit)
        self._close(unit)

    def _skip_consumers(self, unit: Unit) -> None:
        for name in unit.consumers:
            consumer = self.units[name]
            if consumer.status in ("waiting", "done"):
                consumer.status = "skipped"
                self._close(consumer)
                self._skip_consumers(consumer)

    # -- sending work out ---------------------------------------------------------------------------------------

    def _dispatch(self) -> None:
        """Send batches while there is room for them."""
        for _ in range(len(self._open)):
            unit = self._open[0]
            work = unit.work
            while work and work.queue and not self._stopping and self._has_room(unit):
                self._send(unit, work)
            if unit.status == "open" and work and not work.is_over and not self._stopping:
                if self._room.is_full:
                    return
                self._open.rotate(-1)
            else:
                self._open.popleft()

    def _has_room(self, unit: Unit) -> bool:
        if self._executor is None:
            self.store.start_heartbeat()
            self._executor = self._open_executor()
            self._room.slots = self._executor.slots
        return self._room.fits(unit.step.node)

    def _send(self, unit: Unit, work: Work) -> None:
        size = self._pace.batch_size(unit.step.node.name, len(work.queue), self._executor.slots)
        positions = [work.queue.popleft() for _ in range(min(size, len(work.queue)))]
        keys = work.keys if work.outputs is not None else [work.keys[k] for k in positions]
        mine, done = self.store.claim(keys)
        work.results |= done
        if work.outputs is not None:
            positions = positions if mine else []
            unit.cached += len(done) == len(keys)
            if len(done) < len(keys) and not mine:
                work.elsewhere.append(0)
        else:
            work.elsewhere.extend(
                k for k in positions if work.keys[k] not in mine and work.keys[k] not in done
            )
            found = sum(work.keys[k] in done for k in positions)
            unit.cached += found
            self.progress.advance(unit.step.name, 0, found)
            positions = [k for k in positions if work.keys[k] in mine]
        if work.elsewhere:
            self._waiting[unit.name] = unit
        if not positions:
            self._settle(unit)
            return
        product = self.pipeline.catalogue.products[unit.step.node.output]
        batch = batch_of(self.store.url, unit, work, positions, product)
        node = unit.step.node
        self._tag += 1
        self._in_flight[self._tag] = (unit, work, positions)
        self._room.take(node)
        work.running += 1
        self._executor.submit(self._tag, batch)

    def _waits_elsewhere(self) -> bool:
        return not self._stopping and bool(self._waiting)

    # -- taking outcomes in -------------------------------------------------------------------------------------

    def _take_outcome(self) -> None:
        waiting = self._waits_elsewhere()
        if not self._in_flight:
            time.sleep(0.1)
        else:
            got = self._executor.wait(0.2 if waiting else None)
            if got is not None:
                self._take(*got)
        if waiting:
            # ask again: the other run has finished them, still has them, or is gone
            for unit in self._waiting.values():
                if unit.work:
                    unit.work.queue.extend(unit.work.elsewhere)
                    unit.work.elsewhere.clear()
            self._waiting.clear()

    def _take(self, tag: int, outcome: Any) -> None:
        unit, work, positions = self._in_flight.pop(tag)
        node = unit.step.node
        self._room.give(node)
        work.running -= 1
        if outcome.store_error:
            # what else is in flight may still come to a good end
            self._stopping, self._store_error = True, outcome.store_error
            return
        if unit.work is not work:
            # sent back meanwhile to wait for a damaged input
            return
        if outcome.damaged:
            self._mend(unit, *outcome.damaged)
            return
        self._commit(unit, work, positions, outcome)
        self._settle(unit)

    def _commit(self, unit: Unit, work: Work, positions: list[int], outcome: Any) -> None:
        records = Records()
        keys = work.keys if work.outputs is not None else [work.keys[k] for k in positions]
        seconds = sum(item.seconds for item in outcome.items)
        good = [item for item in outcome.items if item.error is None]
        for k, (name, size, stamp) in enumerate(outcome.segments):
            rows = sum(item.segment == k for item in good)
            share = seconds if len(outcome.segments) == 1 else seconds / len(outcome.segments)
            records.segments.append(Segment(name, unit.step.node.name, rows, size, share, stamp))
            self._pace.measured(unit.step.node.name, rows, share, size)
        for key, item in zip(keys, outcome.items, strict=True):
            if item.error is None:
                records.results[key] = Result(outcome.segments[item.segment][0], item.row, item.tables)
        self.store.index.commit(records)
        work.results |= records.results
        unit.seconds += seconds
        errors = [
            (k, item) for k, item in zip(positions, outcome.items, strict=False) if item.error is not None
        ]
        for position, item in errors:
            work.failed[position] = item.error
            unit.errors.append(failure(unit, work.items[position], item, self._resume))
        computed = 1 if work.outputs is not None else len(positions)
        unit.computed += computed - len(errors)
        unit.failed += len(errors)
        self.progress.advance(unit.step.name, computed=computed - len(errors), failed=len(errors))
        if errors and not self._keep_going:
            self._stopping = True

    def _settle(self, unit: Unit) -> None:
        """Close a unit that has nothing left to do."""
        work = unit.work
        if work is None or unit.status != "open" or not work.is_over:
            return
        if work.failed:
            unit.status = "failed"
            self._skip_consumers(unit)
            self._close(unit)
            return
        from reperform.graphs.complete import complete

        try:
            manifests = complete(
                unit, work, self.pipeline.catalogue.products[unit.step.node.output].fields, self.store
            )
        except ValueError as error:
            self._fail(unit, f"step {unit.item_text!r} (node {unit.step.node.name}): {error}")
            return
        self._finish(unit, manifests)

    def _mend(self, unit: Unit, segment: str, rows: Any, reason: str) -> None:
        """An input turned out damaged: forget it, make it again, then come back to this unit."""
        known, notes = self._mending.forget(segment, rows, reason)
        self._note(notes)
        unit.mended += 1
        if unit.mended > 5 or not known:
            self._fail(
                unit,
                f"step {unit.item_text!r}: an input is damaged again and again ({reason}): check the disk",
            )
            return
        unit.status, unit.work = "waiting", None
        for name in known:
            unit.missing.add(name)
            source = self.units[name]
            if source.status == "done":
                source.status, source.mended = "waiting", source.mended + 1
                self._ready.append(source)

    def _close(self, unit: Unit) -> None:
        """A unit is done, failed or skipped; with its last one the step is over."""
        step = unit.step.name
        left = self._left[step]
        if unit.name in left:
            left.discard(unit.name)
            if not left:
                self.progress.start(step, 0)
                self.progress.finish(step)

    def _note(self, notes: Sequence[str]) -> None:
        for note in notes:
            self.notes.append(note)
            self.progress.note(note)

    def _remember(self) -> None:
        """Keep the parts of the keys for `why` where they changed, and that these results are in use."""
        from reperform.graphs.history import changed_parts

        self.store.index.touch([m.key for unit in self.units.values() for m in unit.manifests.values()])
        rows = changed_parts(self.pipeline.name, self.units.values(), self.store.index)
        if rows:
            self.store.index.remember(self.pipeline.name, rows)
