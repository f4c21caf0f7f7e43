"""How fast characters are played."""

from __future__ import annotations

import time
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace
from reperform.nodes.products.space_corrections import SpaceCorrections
from reperform.nodes.synthesis.cell_corrections import Blending
from reperform.nodes.synthesis.character import Character
from reperform.nodes.synthesis.character_data import character_data
from reperform.nodes.synthesis.random_commands import RandomCommands


@node(over="dataset", memory=2.0, volatile=True)
def play_rate(
    graph: ParametricGraph,
    spaces: Dataset[ParametricSpace],
    corrections: Dataset[SpaceCorrections] | None = None,
    *,
    characters: Annotated[int, Param("1", 1, 1000, "that are played side by side from one database")] = 1,
    seconds: Annotated[float, Param("s", 0.5, 3600.0, "played")] = 60.0,
    fps: Annotated[float, Param("Hz", 5.0, 240.0, "frames per second of what is played")] = 50.0,
    every: Annotated[float, Param("s", 0.2, 60.0, "from one random command to the next")] = 2.0,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "seed of the commands")] = 0,
    repeats: Annotated[int, Param("1", 1, 20, "of the whole; per frame the least time counts")] = 3,
    blending: Annotated[
        Blending, Param(about="of meshes; hybrid: corrected where `corrections` are given, else linear")
    ] = "linear",
) -> Measures:
    """Time per frame under random commands: entries `frame` (ms) and `rate` (frames of all characters per second, Hz).

    A frame is one step of every character: state, transition search, blended mesh in the world. Every command is a
    space and values drawn evenly, its number differing from character to character. The first round warms up and does
    not count. One thread.

    Source: 004 section 4.5 (rates of the interactive application).
    """
    data = character_data(graph, spaces, corrections, blending)
    frames = max(2, round(seconds * fps))
    best = np.full(frames, np.inf)
    for round_ in range(repeats + 1):
        cast = [Character(data) for _ in range(characters)]
        plans = [RandomCommands(data, every, seed + k) for k in range(characters)]
        for f in range(frames if round_ else min(frames, 2000)):
            commands = [plan.at(f / fps) for plan in plans]
            start = time.perf_counter()
            for character, command in zip(cast, commands, strict=True):
                character.step(1 / fps, command)
            if round_:
                best[f] = min(best[f], time.perf_counter() - start)
    return Measures(
        np.stack([1e3 * best, 1 / best], axis=1), np.array(["frame", "rate"]), np.array(["ms", "Hz"])
    )
