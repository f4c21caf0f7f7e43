"""`reperform store gc`: delete results that nothing kept needs, and what interrupted runs left behind."""

from __future__ import annotations

from collections.abc import Sequence

import click

from reperform.viewer.invocation import load, open_store
from reperform.viewer.output import size_text


@click.command
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
def command(
    store: str | None, older_than: str, keep: Sequence[str], max_size: str | None, dry_run: bool
) -> None:
    """Delete results that nothing kept needs, and what interrupted runs left behind."""
    from reperform.graphs.plan import needed
    from reperform.storage.upkeep import collect, parse_age, parse_size

    with open_store(store) as opened:
        spared = {key for name in keep for key in needed(load(name, ()), opened)}
        limit = parse_size(max_size) if max_size else None
        gone, size = collect(opened, parse_age(older_than), spared, limit, dry_run)
    click.echo(f"{'would delete' if dry_run else 'deleted'} {gone} segment(s), {size_text(size)}")
