"""From a run to a play session, and from a session to a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from reperform.nodes.synthesis.character_data import character_data
from reperform.viewer.play_session import PlaySession


def open_session(done: Any, step: str) -> PlaySession:
    """The session of a step that is a parametric motion graph, with the spaces that it was made of.

    Raises ValueError where the step is something else.
    """
    kind = done.pipeline.steps[step].node.output.rpartition(".")[2]
    if kind != "ParametricGraph":
        raise ValueError(
            f"step {step!r} is a {kind}: what can be played is a ParametricGraph, a step of node "
            "motion_graph.parametric"
        )
    wired = done.pipeline.steps[step].inputs["spaces"].steps
    spaces = {name: done.product(name) for name in wired}
    data = character_data(done.product(step), spaces)
    units = tuple(tuple(str(unit) for unit in np.asarray(spaces[name].units)) for name in data.names)
    return PlaySession(data, units)


def write_recording(session: PlaySession, path: Path) -> None:
    """Write what was recorded: the whole product as .npz, the mesh as anything else.

    Raises ValueError where nothing was recorded.
    """
    from reperform.nodes.export.export import write

    played = session.recorded()
    if played is None:
        raise ValueError("nothing was recorded: press C while playing, or let it play for longer")
    write(played if path.suffix == ".npz" else played.mesh, path)
