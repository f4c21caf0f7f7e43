"""The command line. Its commands and their JSON are a contract; what they do lives elsewhere."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from reperform.graphs.api import Run
    from reperform.graphs.pipeline import Pipeline

F = Callable[..., Any]

# Items run side by side; a BLAS that splits one product over all cores as well would only get in their way.
# Nothing that links a BLAS is imported above.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")


class _Commands(click.Group):
    """Turns errors meant for users into messages: 1 a step failed, 2 the definition or the call is wrong."""

    def invoke(self, context: click.Context) -> Any:
        try:
            return super().invoke(context)
        except (click.exceptions.Exit, click.Abort, click.ClickException, BrokenPipeError):
            raise
        except Exception as error:  # the last place that can turn an error into a message
            if context.params.get("traceback") or os.environ.get("REPERFORM_TRACEBACK"):
                raise
            click.echo(f"error: {_told(error)}", err=True)
            context.exit(_status(error))


def _told(error: Exception) -> str:
    from reperform.graphs.errors import DefinitionError, RunError
    from reperform.storage.errors import DamagedResult, StoreError

    if isinstance(error, StoreError):
        return str(error.strerror or error)
    if isinstance(error, DefinitionError | RunError | DamagedResult | ValueError | OSError | ImportError):
        return str(error)
    return f"{type(error).__name__}: {error} (--traceback shows where)"


def _status(error: Exception) -> int:
    from reperform.graphs.errors import DefinitionError

    return 2 if isinstance(error, DefinitionError) else 1


def _json_option(function: F) -> F:
    return click.option(
        "--json",
        "json_file",
        is_flag=False,
        flag_value="-",
        metavar="[FILE]",
        help="Write JSON, to FILE or standard output.",
    )(function)


def _store_options(function: F) -> F:
    for option in (
        click.option(
            "--set",
            "sets",
            multiple=True,
            metavar="STEP.PARAM=VALUE",
            help="Override a parameter, or a variable (NAME=VALUE).",
        ),
        click.option(
            "--store", metavar="URL", help="Folder or URL of the store [REPERFORM_STORE, else .reperform]."
        ),
    ):
        function = option(function)
    return function


def _run_options(function: F) -> F:
    for option in (
        click.option("--jobs", type=click.IntRange(1), help="Batches at a time [number of cores]."),
        click.option(
            "--scheduler",
            type=click.Choice(["threads", "processes"]),
            default="threads",
            help="dask's threads, or worker processes.",
        ),
        click.option("--cluster", metavar="ADDRESS", help="A dask scheduler, such as tcp://host:8786."),
        click.option("--keep-going", is_flag=True, help="Finish what a failure does not touch."),
    ):
        function = option(function)
    return _store_options(function)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--traceback", is_flag=True, help="Show where errors come from.")
@click.version_option(package_name="reperform")
def main(traceback: bool) -> None:
    """From multi-camera footage of an actor to a character that can be directed."""
    if traceback:
        os.environ["REPERFORM_TRACEBACK"] = "1"


@main.command()
@click.argument("pipeline")
@click.argument("steps", nargs=-1)
@_run_options
@_json_option
def run(pipeline: str, steps: Sequence[str], json_file: str | None, **options: Any) -> None:
    """Compute what is stale of PIPELINE (of the STEPs named, and what they stand on)."""
    from reperform.graphs.errors import RunError

    try:
        done = _run(pipeline, steps, **options)
    except RunError as error:
        _write_json(json_file, error.report.to_json())
        raise
    _write_json(json_file, done.report.to_json())
    if not json_file:
        steps_done = done.report.steps.values()
        computed, cached = sum(s.computed for s in steps_done), sum(s.cached for s in steps_done)
        click.echo(
            f"{done.pipeline.name}: {computed} computed, {cached} cached in {done.report.seconds:.1f} s"
        )
    if not steps:
        from reperform.viewer.exports import write_exports

        for path, written in write_exports(done):
            click.echo(f"{'wrote' if written else 'fresh'} {path}", err=bool(json_file))


@main.command()
@click.argument("pipeline")
@click.argument("steps", nargs=-1)
@_store_options
@_json_option
def plan(
    pipeline: str, steps: Sequence[str], sets: Sequence[str], store: str | None, json_file: str | None
) -> None:
    """Say what would run and why; compute nothing."""
    import time

    from reperform.graphs.plan import plan as make_plan

    start = time.perf_counter()
    loaded = _load(pipeline, sets)
    with _open_store(store) as opened:
        plans = make_plan(loaded, opened, steps)
    if json_file:
        body = {name: step.to_json() for name, step in plans.items()}
        _write_json(
            json_file,
            {"pipeline": loaded.name, "seconds": round(time.perf_counter() - start, 4), "steps": body},
        )
        return
    for name, step in plans.items():
        size = "" if not step.stale else "  size unknown" if step.bytes is None else f"  {_size(step.bytes)}"
        click.echo(f"{name:24} {step.stale:7} stale {step.cached:7} cached{size}")
        for reason in step.reasons:
            click.echo(f"    {reason}")


@main.command()
@click.argument("pipeline")
@click.argument("target", metavar="STEP[/ITEM]")
@_store_options
def why(pipeline: str, target: str, sets: Sequence[str], store: str | None) -> None:
    """Say which part of the key of STEP changed: parameter, input, function or version."""
    from reperform.graphs.plan import why as explain

    loaded = _load(pipeline, sets)
    step, label, _ = _target(loaded, target)
    with _open_store(store) as opened:
        for label_of_unit in [label] if label is not None else loaded.steps[step].units:
            if label is None and label_of_unit:
                click.echo(f"{step}/{label_of_unit}:")
            for line in explain(loaded, opened, step, label_of_unit):
                click.echo(line)


@main.command()
@click.argument("pipeline")
@click.argument("target", metavar="STEP[/ITEM]")
@_run_options
@_json_option
def show(pipeline: str, target: str, json_file: str | None, **options: Any) -> None:
    """Show fields, axes, shapes, units and ranges of a result; a Table prints as a table. Computes what is stale."""
    from reperform.viewer.show import show_json, show_text

    done, step, label = _result(pipeline, target, options)
    described = {
        name: done.product(step, name)
        for name in ([label] if label is not None else done.pipeline.steps[step].units)
    }
    if json_file:
        _write_json(json_file, show_json(described))
    else:
        click.echo(show_text(described))


@main.command()
@click.argument("pipeline")
@click.argument("target", metavar="STEP[/ITEM]")
@click.option(
    "--to",
    "file",
    required=True,
    type=click.Path(dir_okay=False),
    help=".glb .obj .ply .usd .bvh .mp4 .png .csv .npz",
)
@_run_options
def export(pipeline: str, target: str, file: str, **options: Any) -> None:
    """Write a result to FILE, in the format that its ending says. Computes what is stale."""
    from reperform.graphs.errors import DefinitionError
    from reperform.nodes.export.export import write
    from reperform.viewer.pictures.picture import overview

    done, step, label = _result(pipeline, target, options)
    units = done.pipeline.steps[step].units
    if label is None and len(units) > 1:
        raise DefinitionError(f"step {step!r} has {len(units)} items: choose one, as {step}/{units[0]}")
    try:
        write(done.product(step, units[0] if label is None else label), Path(file), step, overview)
    except ValueError as error:
        raise DefinitionError(f"cannot export {step} to {file}: {error}") from error
    click.echo(f"wrote {file}")


@main.command()
@click.argument("pipeline")
@click.argument("step", required=False, metavar="[STEP[/ITEM]]")
@click.option(
    "--screenshot",
    type=click.Path(dir_okay=False),
    help="Write a picture instead of opening a window; needs no display.",
)
@click.option("--frame", type=click.IntRange(0), default=0, help="Frame to begin with.")
@_run_options
def view(pipeline: str, step: str | None, screenshot: str | None, frame: int, **options: Any) -> None:
    """Look at results in a window: choose step and item, scrub time, orbit."""
    from reperform.graphs.errors import DefinitionError
    from reperform.viewer.browser import Results
    from reperform.viewer.window import check_display, start_session
    from reperform.viewer.window import view as open_view

    loaded = _load(pipeline, options["sets"])
    name, label, at = _target(loaded, step) if step else (None, None, None)
    if not screenshot:
        check_display()
    done = _run(pipeline, [name] if name else [], **options)
    browser = Results(done, list(done), title=loaded.name)
    first = frame if at is None else at
    try:
        if not screenshot:
            open_view(browser, name, label, first)
            return
        from reperform.nodes.export.png import write_png
        from reperform.viewer.screenshot import screenshot as take_screenshot

        write_png(Path(screenshot), take_screenshot(start_session(browser, name, label, first, None)))
    except ValueError as error:
        raise DefinitionError(str(error)) from error
    click.echo(f"wrote {screenshot}")


@main.command()
@click.argument("pipeline")
@click.option("-o", "output", required=True, type=click.Path(dir_okay=False), help="The HTML file to write.")
@_run_options
def report(pipeline: str, output: str, **options: Any) -> None:
    """Write one self-contained page: graph, timings, pictures, tables. Computes what is stale."""
    from reperform.viewer.pages import report_page

    done = _run(pipeline, [], **options)
    Path(output).write_text(report_page(done), encoding="utf-8")
    click.echo(f"wrote {output}")


@main.command()
@click.argument("pipeline")
@click.option("-o", "output", required=True, type=click.Path(dir_okay=False), help="The SVG file to write.")
@_store_options
def graph(pipeline: str, output: str, sets: Sequence[str], store: str | None) -> None:
    """Draw the pipeline, with what is fresh and what is stale."""
    from reperform.viewer.pages import graph_page

    loaded = _load(pipeline, sets)
    with _open_store(store) as opened:
        Path(output).write_text(graph_page(loaded, opened), encoding="utf-8")
    click.echo(f"wrote {output}")


@main.command()
@click.argument("name", required=False)
@_json_option
def nodes(name: str | None, json_file: str | None) -> None:
    """List the nodes, or tell all about one: inputs, parameters with units and bounds, output, source."""
    from reperform.graphs.errors import DefinitionError, nearest
    from reperform.nodes.catalogue import read_catalogue
    from reperform.viewer.node_help import node_json, node_line, node_text

    catalogue = read_catalogue()
    if name is not None and name not in catalogue.nodes:
        raise DefinitionError(f"no node {name!r}: {nearest(name, catalogue.nodes)}")
    chosen = [catalogue.nodes[name]] if name else list(catalogue.nodes.values())
    if json_file:
        found = [node_json(node, catalogue) for node in chosen]
        _write_json(json_file, found[0] if name else found)
    elif name:
        click.echo(node_text(chosen[0], catalogue))
    else:
        for node in chosen:
            click.echo(node_line(node))


@main.command()
def schema() -> None:
    """Write the JSON Schema of pipeline files, for completion and validation in editors."""
    from reperform.graphs.file_schema import file_schema
    from reperform.nodes.catalogue import read_catalogue

    _write_json("-", file_schema(read_catalogue()))


@main.group()
def store() -> None:
    """Look after a store."""


@store.command("list")
@click.option("--store", metavar="URL")
@_json_option
def store_list(store: str | None, json_file: str | None) -> None:
    """Say what is kept, node by node."""
    from reperform.storage.upkeep import contents

    with _open_store(store) as opened:
        rows = contents(opened)
    if json_file:
        _write_json(json_file, rows)
        return
    for row in rows:
        click.echo(
            f"{row['node']:36} {row['items']:8} items {row['segments']:6} segments {_size(row['bytes']):>10}"
        )


@store.command("verify")
@click.option("--store", metavar="URL")
def store_verify(store: str | None) -> None:
    """Read everything and check every digest; damaged results are forgotten, so that they are computed again."""
    from reperform.storage.upkeep import verify

    with _open_store(store) as opened:
        notes = verify(opened)
    for note in notes:
        click.echo(note)
    click.echo("all results are as they were written" if not notes else f"{len(notes)} damaged segment(s)")
    if notes:
        sys.exit(1)


@store.command("gc")
@click.option("--store", metavar="URL")
@click.option(
    "--older-than", default="0 d", help="Spare what was used in this time, such as '7 d' or '12 h'."
)
@click.option(
    "--keep", multiple=True, metavar="PIPELINE", help="Spare what this pipeline, as it is now, needs."
)
@click.option(
    "--max-size",
    metavar="SIZE",
    help="Collect, oldest first, only until the store is no larger, such as '50 GB'.",
)
@click.option("--dry-run", is_flag=True, help="Only say what would go.")
def store_gc(
    store: str | None, older_than: str, keep: Sequence[str], max_size: str | None, dry_run: bool
) -> None:
    """Delete results that nothing kept needs, and what interrupted runs left behind."""
    from reperform.graphs.plan import needed
    from reperform.storage.upkeep import collect, parse_age, parse_size

    with _open_store(store) as opened:
        spared = {key for name in keep for key in needed(_load(name, ()), opened)}
        limit = parse_size(max_size) if max_size else None
        gone, size = collect(opened, parse_age(older_than), spared, limit, dry_run)
    click.echo(f"{'would delete' if dry_run else 'deleted'} {gone} segment(s), {_size(size)}")


@store.command("copy")
@click.argument("target", metavar="URL")
@click.option("--store", metavar="URL")
def store_copy(target: str, store: str | None) -> None:
    """Copy all results to another store (a folder, or any fsspec URL), skipping what is there."""
    from reperform.storage.store import Store
    from reperform.storage.upkeep import copy

    with _open_store(store) as opened:
        other = Store(target)
        try:
            count, size = copy(opened, other)
        finally:
            other.close()
    click.echo(f"copied {count} segment(s), {_size(size)} to {target}")


# -- what the commands share ------------------------------------------------------------------------------------


def _load(pipeline: str, sets: Sequence[str]) -> Pipeline:
    from reperform.graphs.pipeline import read_pipeline

    return read_pipeline(pipeline, sets)


@contextmanager
def _open_store(url: str | None) -> Iterator[Any]:
    from reperform.graphs.api import default_store
    from reperform.storage.store import Store

    opened = Store(url or default_store())
    try:
        yield opened
    finally:
        opened.close()


def _run(
    pipeline: str, steps: Sequence[str], *, sets: Sequence[str], store: str | None, **options: Any
) -> Run:
    from reperform.graphs.api import run as run_pipeline
    from reperform.viewer.progress import Progress

    loaded = _load(pipeline, sets)
    given = [part for text in sets for part in ("--set", text)] + (["--store", store] if store else [])
    resume = shlex.join(["reperform", "run", pipeline, *given])
    with Progress() as progress:
        return run_pipeline(loaded, store=store, steps=steps, progress=progress, resume=resume, **options)


def _target(pipeline: Pipeline, text: str) -> tuple[str, str | None, int | None]:
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


def _result(pipeline: str, target: str, options: dict[str, Any]) -> tuple[Run, str, str | None]:
    loaded = _load(pipeline, options["sets"])
    step, label, _ = _target(loaded, target)
    return _run(pipeline, [step], **options), step, label


def _write_json(target: str | None, value: Any) -> None:
    if target == "-":
        click.echo(json.dumps(value, indent=2))
    elif target:
        Path(target).write_text(json.dumps(value, indent=2) + "\n", encoding="utf-8")


def _size(count: float) -> str:
    for unit in ("B", "kB", "MB", "GB"):
        if abs(count) < 1000 or unit == "GB":
            return f"{count:.0f} {unit}" if unit == "B" else f"{count:.1f} {unit}"
        count /= 1000
    return ""


if __name__ == "__main__":
    main()
