"""`reperform run`: compute what is stale of PIPELINE (of the STEPs named, and what they stand on)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from reperform.viewer.command_options import json_option, run_options
from reperform.viewer.invocation import run
from reperform.viewer.output import write_json


@click.command
@click.argument("pipeline")
@click.argument("steps", nargs=-1)
@run_options
@json_option
def command(pipeline: str, steps: Sequence[str], json_file: str | None, **options: Any) -> None:
    """Compute what is stale of PIPELINE (of the STEPs named, and what they stand on)."""
    from reperform.graphs.errors import RunError

    try:
        done = run(pipeline, steps, **options)
    except RunError as error:
        write_json(json_file, error.report.to_json())
        raise
    write_json(json_file, done.report.to_json())
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
