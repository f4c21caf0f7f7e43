"""Whether a character ever gets stuck, and how long it lets one wait."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace
from reperform.nodes.synthesis.character import Character
from reperform.nodes.synthesis.character_data import character_data
from reperform.nodes.synthesis.random_commands import RandomCommands


@node(over="dataset", memory=2.0)
def play_life(
    graph: ParametricGraph,
    spaces: Dataset[ParametricSpace],
    *,
    seconds: Annotated[float, Param("s", 1.0, 1e6, "of simulated time")] = 3600.0,
    fps: Annotated[float, Param("Hz", 5.0, 240.0, "frames per second")] = 25.0,
    every: Annotated[float, Param("s", 0.5, 60.0, "from one random command to the next")] = 3.0,
    patience: Annotated[
        float, Param("s", 0.0, 60.0, "at rest at the end of a motion before it counts as dead")
    ] = 1.2,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "seed of the commands")] = 0,
) -> Measures:
    """One row per request of a long random life: `latency`, s, and `dead`, 1 where it got stuck.

    latency: from the request to the beginning of its motion (0 where the space plays already); nan where it never
    began. dead: the request never began before the next, or the character stood at the end of a motion for longer
    than `patience`, or what it shows is not finite.

    Source: 004 section 4.5.1 (latency under 1.2 s); Kovar, Gleicher and Pighin 2002, SIGGRAPH (dead ends).
    """
    data = character_data(graph, spaces)
    character, plan = Character(data), RandomCommands(data, every, seed)
    rows: list[tuple[float, float]] = []
    stuck, command = False, plan.at(0.0)
    for f in range(round(seconds * fps)):
        following = plan.at(f / fps)
        if following.number != command.number:
            rows.append(_row(character, command.number, stuck))
            stuck, command = False, following
        character.step(1 / fps, command)
        stuck = stuck or character.stuck > patience
    rows.append(_row(character, command.number, stuck))
    return Measures(np.array(rows), np.array(["latency", "dead"]), np.array(["s", "1"]))


def _row(character: Character, number: int, stuck: bool) -> tuple[float, float]:
    begun = character.served == number
    finite = bool(np.isfinite(character.vertices).all())
    return (character.latency if begun else np.nan, float(stuck or not begun or not finite))
