"""`reperform export`: write a result to FILE, in the format that its ending says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from reperform.viewer.command_options import run_options
from reperform.viewer.invocation import result_of


@click.command
@click.argument("pipeline")
@click.argument("target", metavar="STEP[/ITEM]")
@click.option(
    "--to",
    "file",
    required=True,
    type=click.Path(dir_okay=False),
    help=".glb .obj .ply .usd .bvh .mp4 .png .csv .xml .npz",
)
@run_options
def command(pipeline: str, target: str, file: str, **options: Any) -> None:
    """Write a result to FILE, in the format that its ending says. Computes what is stale."""
    from reperform.graphs.errors import DefinitionError
    from reperform.nodes.export.export import write
    from reperform.viewer.pictures.picture import overview

    done, step, label = result_of(pipeline, target, options)
    units = done.pipeline.steps[step].units
    if label is None and len(units) > 1:
        raise DefinitionError(f"step {step!r} has {len(units)} items: choose one, as {step}/{units[0]}")
    try:
        write(done.product(step, units[0] if label is None else label), Path(file), step, overview)
    except ValueError as error:
        raise DefinitionError(f"cannot export {step} to {file}: {error}") from error
    click.echo(f"wrote {file}")
