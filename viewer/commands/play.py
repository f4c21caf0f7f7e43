"""`reperform play`: a character under the keyboard."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from reperform.viewer.command_options import run_options
from reperform.viewer.invocation import load, run, target_of


@click.command
@click.argument("pipeline")
@click.argument("step")
@click.option(
    "--input", "acts", type=click.Path(exists=True, dir_okay=False), help="Keys pressed at given times."
)
@click.option("--seconds", type=float, default=0.0, help="Close by itself after so long [never].")
@click.option(
    "--record", type=click.Path(dir_okay=False), help="Write what was played: .npz, or a mesh format."
)
@click.option(
    "--screenshot",
    type=click.Path(dir_okay=False),
    help="Play --input for --seconds without a display and write a picture of the window.",
)
@click.option(
    "--hybrid", is_flag=True, help="Correct blends by the steps of blend.correct_space; H switches."
)
@run_options
def command(
    pipeline: str, step: str, acts: str | None, seconds: float, record: str | None, screenshot: str | None,
    hybrid: bool,
    **options: Any,
) -> None:  # fmt: skip
    """Direct the character of STEP (a parametric motion graph) with the keyboard.

    Arrows: speed and direction; J jump, L leap, R reach and G grab, as long as they are held; 1-9 the motions; with control
    held, the mouse draws a path that is then followed; X drops it; H switches hybrid blending; C records; Esc closes.
    """
    from reperform.viewer.play_opening import correcting, open_session, write_recording
    from reperform.viewer.play_script_input import ScriptedInput, read_acts

    loaded = load(pipeline, options["sets"])
    name, _, _ = target_of(loaded, step)
    if not screenshot:
        from reperform.viewer.window import check_display

        check_display()
    corrections = correcting(loaded, name) if hybrid else []
    done = run(pipeline, [name, *corrections], **options)
    session = open_session(done, name, corrections)
    lines = Path(acts).read_text("utf-8").splitlines() if acts else []
    scripted = ScriptedInput(read_acts(lines, acts or "input"))
    if record:
        session.toggle_recording()
    if screenshot:
        from reperform.viewer.pictures.canvas import png
        from reperform.viewer.play_headless import play_picture, play_scripted

        play_scripted(session, scripted, seconds or 5.0)
        Path(screenshot).write_bytes(png(play_picture(session)))
        click.echo(f"wrote {screenshot}")
    else:
        from reperform.viewer.play_window import play_window

        play_window(session, f"{loaded.name}: {name}", scripted, seconds)
    if record:
        write_recording(session, Path(record))
        click.echo(f"wrote {record}")
