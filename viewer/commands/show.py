"""`reperform show`: show fields, axes, shapes, units and ranges of a result."""

from __future__ import annotations

from typing import Any

import click

from reperform.viewer.command_options import json_option, run_options
from reperform.viewer.invocation import result_of
from reperform.viewer.output import write_json


@click.command
@click.argument("pipeline")
@click.argument("target", metavar="STEP[/ITEM]")
@run_options
@json_option
def command(pipeline: str, target: str, json_file: str | None, **options: Any) -> None:
    """Show fields, axes, shapes, units and ranges of a result; a Table prints as a table. Computes what is stale."""
    from reperform.viewer.show import show_json, show_text

    done, step, label = result_of(pipeline, target, options)
    described = {
        name: done.product(step, name)
        for name in ([label] if label is not None else done.pipeline.steps[step].units)
    }
    if json_file:
        write_json(json_file, show_json(described))
    else:
        click.echo(show_text(described))
