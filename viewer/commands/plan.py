"""`reperform plan`: say what would run and why."""

from __future__ import annotations

from collections.abc import Sequence

import click

from reperform.viewer.command_options import json_option, store_options
from reperform.viewer.invocation import load, open_store
from reperform.viewer.output import size_text, write_json


@click.command
@click.argument("pipeline")
@click.argument("steps", nargs=-1)
@store_options
@json_option
def command(
    pipeline: str, steps: Sequence[str], sets: Sequence[str], store: str | None, json_file: str | None
) -> None:
    """Say what would run and why; compute nothing."""
    import time

    from reperform.graphs.plan import plan as make_plan

    start = time.perf_counter()
    loaded = load(pipeline, sets)
    with open_store(store) as opened:
        plans = make_plan(loaded, opened, steps)
    if json_file:
        body = {name: step.to_json() for name, step in plans.items()}
        write_json(
            json_file,
            {"pipeline": loaded.name, "seconds": round(time.perf_counter() - start, 4), "steps": body},
        )
        return
    for name, step in plans.items():
        size = (
            "" if not step.stale else "  size unknown" if step.bytes is None else f"  {size_text(step.bytes)}"
        )
        click.echo(f"{name:24} {step.stale:7} stale {step.cached:7} cached{size}")
        for reason in step.reasons:
            click.echo(f"    {reason}")
