"""`reperform store list`: say what is kept, node by node."""

from __future__ import annotations

import click

from reperform.viewer.command_options import json_option
from reperform.viewer.invocation import open_store
from reperform.viewer.output import size_text, write_json


@click.command
@click.option("--store", metavar="URL")
@json_option
def command(store: str | None, json_file: str | None) -> None:
    """Say what is kept, node by node."""
    from reperform.storage.upkeep import contents

    with open_store(store) as opened:
        rows = contents(opened)
    if json_file:
        write_json(json_file, rows)
        return
    for row in rows:
        click.echo(
            f"{row['node']:36} {row['items']:8} items {row['segments']:6} segments {size_text(row['bytes']):>10}"
        )
