"""`reperform graph`: draw the pipeline, with what is fresh and what is stale."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from reperform.viewer.command_options import store_options
from reperform.viewer.invocation import load, open_store


@click.command
@click.argument("pipeline")
@click.option("-o", "output", required=True, type=click.Path(dir_okay=False), help="The SVG file to write.")
@store_options
def command(pipeline: str, output: str, sets: Sequence[str], store: str | None) -> None:
    """Draw the pipeline, with what is fresh and what is stale."""
    from reperform.viewer.pages import graph_page

    loaded = load(pipeline, sets)
    with open_store(store) as opened:
        Path(output).write_text(graph_page(loaded, opened), encoding="utf-8")
    click.echo(f"wrote {output}")
