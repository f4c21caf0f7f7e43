"""Pipelines from Python: `load(path).run(store=...)["align"]["walk"].vertices`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from reperform.graphs.engine import Engine
from reperform.graphs.listener import Progress
from reperform.graphs.pipeline import Pipeline, read_pipeline
from reperform.graphs.report import RunReport
from reperform.storage.store import Store

if TYPE_CHECKING:
    from reperform.graphs.executor import Executor, Scheduler


def load(path: str | os.PathLike[str], sets: Sequence[str] = ()) -> Pipeline:
    """Read and check a pipeline by path or shipped name; `sets` are overrides like `STEP.PARAM=VALUE`."""
    return read_pipeline(path, sets)


def default_store() -> str:
    """Where results go: `REPERFORM_STORE`, else the folder `.reperform` here."""
    return os.environ.get("REPERFORM_STORE") or ".reperform"


def run(
    pipeline: Pipeline,
    *,
    store: str | os.PathLike[str] | None = None,
    steps: Sequence[str] = (),
    jobs: int | None = None,
    scheduler: Scheduler = "threads",
    cluster: str | None = None,
    keep_going: bool = False,
    progress: Progress | None = None,
    resume: str = "reperform run",
) -> Run:
    """Compute what is stale of some steps (none named: all) and all that they stand on.

    store: folder or URL; jobs: parallel batches; scheduler: dask's threads or worker processes of this machine;
    cluster: address of a dask scheduler; keep_going: finish what a failure does not touch.
    Raises RunError where steps failed, naming items and cures; all finished results are kept.
    """

    def executor() -> Executor:
        # what computes is imported once there is something to compute
        from reperform.graphs.executor import open_executor

        return open_executor(jobs, scheduler, cluster)

    opened = Store(store or default_store())
    try:
        engine = Engine(
            pipeline,
            opened,
            steps,
            open_executor=executor,
            progress=progress,
            keep_going=keep_going,
            resume=resume,
        )
        report = engine.run()
    finally:
        opened.close()
    return Run(pipeline, opened.url, engine, report)


class Run(Mapping[str, Any]):
    """The results of a run: `run[step]` is a product, or a mapping from take (or `(a, b)`) to product.

    Fields read from the store as they are indexed.
    """

    def __init__(self, pipeline: Pipeline, url: str, engine: Engine, report: RunReport) -> None:
        self.pipeline, self.report, self.url, self._engine = pipeline, report, url, engine
        self.notes = tuple(engine.notes)

    def __getitem__(self, step: str) -> Any:
        placed = self.pipeline.steps[step]
        if step not in self._engine.chosen:
            raise KeyError(f"step {step!r} was not part of this run")
        if placed.domain == "single":
            return self.product(step)
        return {
            (tuple(label.split("/", 1)) if placed.domain == "pair" else label): self.product(step, label)
            for label in placed.units
        }

    def __iter__(self) -> Iterator[str]:
        return iter(self._engine.chosen)

    def __len__(self) -> int:
        return len(self._engine.chosen)

    def product(self, step: str, label: str = "") -> Any:
        """The product of one unit, its fields read on demand."""
        from reperform.graphs.lazy import lazy_product

        spec = self.pipeline.catalogue.products[self.pipeline.steps[step].node.output]
        return lazy_product(self.url, self._engine.manifest(step, label).name, "", spec.load(), spec.fields)

    def digest(self, step: str, label: str = "") -> str:
        """Digests of all fields of a unit's product, in one text."""
        fields = self._engine.manifest(step, label).summary["fields"]
        return ",".join(f"{name}={value}" for name, value in sorted(fields.items()))

    def lengths(self, step: str, label: str = "") -> Mapping[str, int]:
        """Lengths along `frame` and `camera` of a unit's product."""
        from reperform.storage.manifest import open_unit

        return open_unit(self.url, self._engine.manifest(step, label).name).contents.lengths
