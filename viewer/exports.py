"""Files that a pipeline asks for when a run ends; those that are as they should be are left alone."""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

from reperform.graphs.api import Run
from reperform.graphs.errors import DefinitionError
from reperform.graphs.wiring import Input
from reperform.storage.digest import digest_bytes
from reperform.storage.store import Store


def write_exports(run: Run) -> Iterator[tuple[str, bool]]:
    """Write the exports of a finished run: (path, whether it was written or was fresh already).

    Films are encoded beside the drawing of pictures.
    """
    store = Store(run.url)
    pool = ThreadPoolExecutor(1, thread_name_prefix="film")
    try:
        stale: dict[str, bytes] = {}
        films: dict[str, Future[None]] = {}
        for target, wired in run.pipeline.exports.items():
            label, path = _unit(run, target, wired), Path(target).absolute()
            digest = digest_bytes(run.digest(wired.step, label).encode(), wired.part.encode())
            if path.exists() and store.index.export(str(path)) == (digest, _stamp(path)):
                continue
            if not stale:
                # in this thread, before another needs it too
                importlib.import_module("reperform.viewer.pictures.picture")
            stale[target] = digest
            if path.suffix == ".mp4":
                films[target] = pool.submit(_write, run, wired, path)
        for target in sorted(run.pipeline.exports, key=films.__contains__):
            path = Path(target).absolute()
            if target in films:
                films[target].result()
            elif target in stale:
                _write(run, run.pipeline.exports[target], path)
            if target in stale:
                store.index.remember_export(str(path), stale[target], _stamp(path))
            yield target, target in stale
    finally:
        pool.shutdown()
        store.close()


def _unit(run: Run, target: str, wired: Input) -> str:
    """The unit that an export names. Raises DefinitionError where it must say which."""
    label, units = wired.item or "", run.pipeline.steps[wired.step].units
    if label not in units:
        raise DefinitionError(
            f"exports: {target}: step {wired.step!r} has several items: choose one, as {wired.step}/{units[0]}"
        )
    return label


def _write(run: Run, wired: Input, path: Path) -> None:
    from reperform.nodes.export.export import write
    from reperform.viewer.pictures.picture import overview

    product = run.product(wired.step, wired.item or "")
    for name in wired.part.split(".") if wired.part else ():
        product = getattr(product, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    write(product, path, wired.step, overview)


def _stamp(path: Path) -> str:
    state = os.stat(path)
    return f"{state.st_size}/{state.st_mtime_ns}"
