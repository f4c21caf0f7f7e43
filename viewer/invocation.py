"""From the words of a call to pipelines, stores, runs and targets."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from reperform.graphs.api import Run
    from reperform.graphs.pipeline import Pipeline


def load(pipeline: str, sets: Sequence[str]) -> Pipeline:
    """Read a pipeline by path or shipped name."""
    from reperform.graphs.pipeline import read_pipeline

    return read_pipeline(pipeline, sets)


@contextmanager
def open_store(url: str | None) -> Iterator[Any]:
    """The store at a URL, or the one in use here."""
    from reperform.graphs.api import default_store
    from reperform.storage.store import Store

    opened = Store(url or default_store())
    try:
        yield opened
    finally:
        opened.close()


def run(
    pipeline: str, steps: Sequence[str], *, sets: Sequence[str], store: str | None, **options: Any
) -> Run:
    """Run some steps of a pipeline, with progress on the terminal."""
    from reperform.graphs.api import run as run_pipeline
    from reperform.viewer.progress import Progress

    loaded = load(pipeline, sets)
    given = [part for text in sets for part in ("--set", text)] + (["--store", store] if store else [])
    resume = shlex.join(["reperform", "run", pipeline, *given])
    with Progress() as progress:
        return run_pipeline(loaded, store=store, steps=steps, progress=progress, resume=resume, **options)


def target_of(pipeline: Pipeline, text: str) -> tuple[str, str | None, int | None]:
    """Step, unit and frame that STEP, STEP/ITEM or STEP/ITEM/FRAME names."""
    from reperform.graphs.errors import DefinitionError, nearest

    name, _, rest = text.partition("/")
    step = pipeline.match(name)[0]
    units = pipeline.steps[step].units
    if not rest:
        return step, (None if units != ("",) else ""), None
    if rest in units:
        return step, rest, None
    head, _, last = rest.rpartition("/")
    if last.isdigit() and head in units:
        return step, head, int(last)
    raise DefinitionError(f"step {step!r} has no item {rest!r}: {nearest(rest, [u for u in units if u])}")


def result_of(pipeline: str, target: str, options: dict[str, Any]) -> tuple[Run, str, str | None]:
    """The run that a target needs, with the step and the unit that it names."""
    loaded = load(pipeline, options["sets"])
    step, label, _ = target_of(loaded, target)
    return run(pipeline, [step], **options), step, label
