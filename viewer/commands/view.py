"""`reperform view`: look at results in a window."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from reperform.viewer.command_options import run_options
from reperform.viewer.invocation import load, run, target_of


@click.command
@click.argument("pipeline")
@click.argument("step", required=False, metavar="[STEP[/ITEM]]")
@click.option(
    "--screenshot",
    type=click.Path(dir_okay=False),
    help="Write a picture instead of opening a window; needs no display.",
)
@click.option("--frame", type=click.IntRange(0), default=0, help="Frame to begin with.")
@run_options
def command(pipeline: str, step: str | None, screenshot: str | None, frame: int, **options: Any) -> None:
    """Look at results in a window: choose step and item, scrub time, orbit."""
    from reperform.graphs.errors import DefinitionError
    from reperform.viewer.browser import Results
    from reperform.viewer.window import check_display, start_session
    from reperform.viewer.window import view as open_view

    loaded = load(pipeline, options["sets"])
    name, label, at = target_of(loaded, step) if step else (None, None, None)
    if not screenshot:
        check_display()
    done = run(pipeline, [name] if name else [], **options)
    browser = Results(done, list(done), title=loaded.name)
    first = frame if at is None else at
    try:
        if not screenshot:
            open_view(browser, name, label, first)
            return
        from reperform.nodes.export.png import write_png
        from reperform.viewer.screenshot import screenshot as take_screenshot

        write_png(Path(screenshot), take_screenshot(start_session(browser, name, label, first, None)))
    except ValueError as error:
        raise DefinitionError(str(error)) from error
    click.echo(f"wrote {screenshot}")
