"""`reperform schema`: write the JSON Schema of pipeline files, for completion and validation in editors."""

from __future__ import annotations

import click

from reperform.viewer.output import write_json


@click.command
def command() -> None:
    """Write the JSON Schema of pipeline files, for completion and validation in editors."""
    from reperform.graphs.file_schema import file_schema
    from reperform.nodes.catalogue import read_catalogue

    write_json("-", file_schema(read_catalogue()))
