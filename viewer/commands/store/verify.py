"""`reperform store verify`: read everything and check every digest."""

from __future__ import annotations

import sys

import click

from reperform.viewer.invocation import open_store


@click.command
@click.option("--store", metavar="URL")
def command(store: str | None) -> None:
    """Read everything and check every digest; damaged results are forgotten, so that they are computed again."""
    from reperform.storage.upkeep import verify

    with open_store(store) as opened:
        notes = verify(opened)
    for note in notes:
        click.echo(note)
    click.echo("all results are as they were written" if not notes else f"{len(notes)} damaged segment(s)")
    if notes:
        sys.exit(1)
