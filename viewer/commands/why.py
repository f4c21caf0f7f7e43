"""`reperform why`: say which part of the key of STEP changed."""

from __future__ import annotations

from collections.abc import Sequence

import click

from reperform.viewer.command_options import store_options
from reperform.viewer.invocation import load, open_store, target_of


@click.command
@click.argument("pipeline")
@click.argument("target", metavar="STEP[/ITEM]")
@store_options
def command(pipeline: str, target: str, sets: Sequence[str], store: str | None) -> None:
    """Say which part of the key of STEP changed: parameter, input, function or version."""
    from reperform.graphs.plan import why as explain

    loaded = load(pipeline, sets)
    step, label, _ = target_of(loaded, target)
    with open_store(store) as opened:
        for label_of_unit in [label] if label is not None else loaded.steps[step].units:
            if label is None and label_of_unit:
                click.echo(f"{step}/{label_of_unit}:")
            for line in explain(loaded, opened, step, label_of_unit):
                click.echo(line)
