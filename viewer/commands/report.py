"""`reperform report`: write one self-contained page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from reperform.viewer.command_options import run_options
from reperform.viewer.invocation import run


@click.command
@click.argument("pipeline")
@click.option("-o", "output", required=True, type=click.Path(dir_okay=False), help="The HTML file to write.")
@run_options
def command(pipeline: str, output: str, **options: Any) -> None:
    """Write one self-contained page: graph, timings, pictures, tables. Computes what is stale."""
    from reperform.viewer.pages import report_page

    done = run(pipeline, [], **options)
    Path(output).write_text(report_page(done), encoding="utf-8")
    click.echo(f"wrote {output}")
