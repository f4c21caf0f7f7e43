"""`reperform nodes`: list the nodes, or tell all about one."""

from __future__ import annotations

import click

from reperform.viewer.command_options import json_option
from reperform.viewer.output import write_json


@click.command
@click.argument("name", required=False)
@json_option
def command(name: str | None, json_file: str | None) -> None:
    """List the nodes, or tell all about one: inputs, parameters with units and bounds, output, source."""
    from reperform.graphs.errors import DefinitionError, nearest
    from reperform.nodes.catalogue import read_catalogue
    from reperform.viewer.node_help import node_json, node_line, node_text

    catalogue = read_catalogue()
    if name is not None and name not in catalogue.nodes:
        raise DefinitionError(f"no node {name!r}: {nearest(name, catalogue.nodes)}")
    chosen = [catalogue.nodes[name]] if name else list(catalogue.nodes.values())
    if json_file:
        found = [node_json(node, catalogue) for node in chosen]
        write_json(json_file, found[0] if name else found)
    elif name:
        click.echo(node_text(chosen[0], catalogue))
    else:
        for node in chosen:
            click.echo(node_line(node))
