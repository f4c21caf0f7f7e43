"""Files that a pipeline asks for when a run ends; those that are as they should be are left alone."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from reperform.graphs.api import Run
from reperform.graphs.errors import DefinitionError
from reperform.storage.digest import digest_bytes
from reperform.storage.store import Store


def write_exports(run: Run) -> Iterator[tuple[str, bool]]:
    """Write the exports of a finished run: (path, whether it was written or was fresh already)."""
    store = Store(run.url)
    try:
        for target, wired in run.pipeline.exports.items():
            label = wired.item or ""
            units = run.pipeline.steps[wired.step].units
            if label not in units:
                raise DefinitionError(
                    f"exports: {target}: step {wired.step!r} has several items: choose one, as {wired.step}/{units[0]}"
                )
            path = Path(target).absolute()
            digest = digest_bytes(run.digest(wired.step, label).encode(), wired.part.encode())
            if path.exists() and store.index.export(str(path)) == (digest, _stamp(path)):
                yield target, False
                continue
            _write(run, wired.step, label, wired.part, path)
            store.index.remember_export(str(path), digest, _stamp(path))
            yield target, True
    finally:
        store.close()


def _write(run: Run, step: str, label: str, part: str, path: Path) -> None:
    from reperform.nodes.export.export import write
    from reperform.viewer.pictures.picture import overview

    product = run.product(step, label)
    for name in part.split(".") if part else ():
        product = getattr(product, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    write(product, path, step, overview)


def _stamp(path: Path) -> str:
    state = os.stat(path)
    return f"{state.st_size}/{state.st_mtime_ns}"
