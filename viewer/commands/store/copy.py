"""`reperform store copy`: copy all results to another store (a folder, or any fsspec URL), skipping what is there."""

from __future__ import annotations

import click

from reperform.viewer.invocation import open_store
from reperform.viewer.output import size_text


@click.command
@click.argument("target", metavar="URL")
@click.option("--store", metavar="URL")
def command(target: str, store: str | None) -> None:
    """Copy all results to another store (a folder, or any fsspec URL), skipping what is there."""
    from reperform.storage.store import Store
    from reperform.storage.upkeep import copy

    with open_store(store) as opened:
        other = Store(target)
        try:
            count, size = copy(opened, other)
        finally:
            other.close()
    click.echo(f"copied {count} segment(s), {size_text(size)} to {target}")
