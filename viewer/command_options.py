"""Options that several commands take."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

F = Callable[..., Any]


def json_option(function: F) -> F:
    """`--json [FILE]`."""
    return click.option(
        "--json",
        "json_file",
        is_flag=False,
        flag_value="-",
        metavar="[FILE]",
        help="Write JSON, to FILE or standard output.",
    )(function)


def store_options(function: F) -> F:
    """What says which pipeline and which store: `--set`, `--store`."""
    for option in (
        click.option(
            "--set",
            "sets",
            multiple=True,
            metavar="STEP.PARAM=VALUE",
            help="Override a parameter, or a variable (NAME=VALUE).",
        ),
        click.option(
            "--store", metavar="URL", help="Folder or URL of the store [REPERFORM_STORE, else .reperform]."
        ),
    ):
        function = option(function)
    return function


def run_options(function: F) -> F:
    """What commands that compute take besides."""
    for option in (
        click.option("--jobs", type=click.IntRange(1), help="Batches at a time [number of cores]."),
        click.option(
            "--scheduler",
            type=click.Choice(["threads", "processes"]),
            default="threads",
            help="dask's threads, or worker processes.",
        ),
        click.option("--cluster", metavar="ADDRESS", help="A dask scheduler, such as tcp://host:8786."),
        click.option("--keep-going", is_flag=True, help="Finish what a failure does not touch."),
    ):
        function = option(function)
    return store_options(function)
