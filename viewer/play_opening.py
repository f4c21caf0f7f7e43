"""From a run to a play session, and from a session to a file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from reperform.nodes.synthesis.character_data import character_data
from reperform.viewer.play_session import PlaySession

if TYPE_CHECKING:
    from reperform.graphs.api import Run
    from reperform.graphs.pipeline import Pipeline


def correcting(pipeline: Pipeline, step: str) -> list[str]:
    """The steps that correct the spaces of a parametric motion graph.

    Raises ValueError where the step is something else, or its spaces have no corrections.
    """
    wired = _spaces(pipeline, step)
    found = [
        name
        for name, placed in pipeline.steps.items()
        if placed.node.name == "blend.correct_space" and set(placed.inputs["space"].steps) <= set(wired)
    ]
    if not found:
        raise ValueError(
            f"no step corrects the spaces of {step!r}, {', '.join(wired)}: add steps of node blend.correct_space, or play "
            "without --hybrid"
        )
    return found


def open_session(done: Run, step: str, corrections: Sequence[str] = ()) -> PlaySession:
    """The session of a step that is a parametric motion graph, with the spaces that it was made of.

    corrections: steps that correct them. Raises ValueError where the step is something else.
    """
    spaces = {name: done.product(name) for name in _spaces(done.pipeline, step)}
    given = {name: done.product(name) for name in corrections}
    data = character_data(done.product(step), spaces, given, "hybrid" if given else "linear")
    units = tuple(tuple(str(unit) for unit in np.asarray(spaces[name].units)) for name in data.names)
    return PlaySession(data, units)


def _spaces(pipeline: Pipeline, step: str) -> tuple[str, ...]:
    """The steps of the spaces that a graph joins."""
    placed = pipeline.steps[step]
    kind = placed.node.output.rpartition(".")[2]
    if kind != "ParametricGraph":
        raise ValueError(
            f"step {step!r} is a {kind}: what can be played is a ParametricGraph, a step of node "
            "motion_graph.parametric"
        )
    return tuple(placed.inputs["spaces"].steps)


def write_recording(session: PlaySession, path: Path) -> None:
    """Write what was recorded: the whole product as .npz, the mesh as anything else.

    Raises ValueError where nothing was recorded.
    """
    from reperform.nodes.export.export import write

    played = session.recorded()
    if played is None:
        raise ValueError("nothing was recorded: press C while playing, or let it play for longer")
    write(played if path.suffix == ".npz" else played.mesh, path)
