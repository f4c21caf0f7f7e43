"""Whether a character does what it is told."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.ground_plane import rotate_ground
from reperform.nodes.product import Dataset
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace
from reperform.nodes.synthesis.character import Character, Command
from reperform.nodes.synthesis.character_data import CharacterData, character_data

_SETTLE = 2.0


@node(over="dataset", memory=2.0)
def play_parameters(
    graph: ParametricGraph,
    spaces: Dataset[ParametricSpace],
    *,
    count: Annotated[int, Param("1", 1, 1000, "random values asked of every space")] = 20,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "seed of the values")] = 0,
) -> Measures:
    """Error of what was played against what was asked, in shares of the parameter's range, one row per request.

    Values are drawn evenly from what the takes of a space span (a blend of them). Measured on what the character does,
    feet held and all: speed and turning over a whole cycle after two seconds; height, length and reach over one
    performance. Entries: speed, turning, height, length, reach; nan where a space has not the parameter.

    Source: 001 section 4.1, 004 section 3.4 (accuracy of the inverse map).
    """
    data, random = character_data(graph, spaces), np.random.default_rng(seed)
    entries = ("speed", "turning", "height", "length", "reach")
    rows = []
    for s, name in enumerate(data.names):
        space, names = spaces[name], data.parameters[s]
        reached = np.asarray(space.value)
        table = data.maps[s]
        for _ in range(count):
            cell = np.asarray(space.cells)[random.integers(len(space.cells))]
            asked = random.dirichlet(np.ones(len(cell))) @ reached[cell]
            done = _played(data, s, asked, np.asarray(space.reach), np.asarray(space.hands))
            row = dict.fromkeys(entries, np.nan)
            for parameter, wanted, width in zip(names, asked, table.upper - table.lower, strict=True):
                entry = parameter.partition("_")[0]
                row[entry] = float(np.nanmax([row[entry], abs(done(parameter) - wanted) / width]))
            rows.append([row[entry] for entry in entries])
    return Measures(np.array(rows), np.array(entries), np.array(["1"] * len(entries)))


def _played(
    data: CharacterData, s: int, asked: np.ndarray, reach: np.ndarray, hands: np.ndarray
) -> Callable[[str], float]:
    """What the character does when told so, parameter by parameter."""
    character = Character(data, s, values=asked)
    if data.spaces[s].cyclic:
        return _cycle(character, Command(s, asked, character.served))
    return _once(character, Command(s, asked, character.served), reach, hands)


def _cycle(character: Character, command: Command) -> Callable[[str], float]:
    for _ in range(round(_SETTLE * 50)):
        character.step(0.02, command)
    seconds = float(character.now.weights @ character.data.spaces[command.space].seconds.sum(axis=1))
    place, heading = character.root[:2].copy(), character.heading
    steps = int(np.ceil(seconds * 50))
    for _ in range(steps):
        character.step(seconds / steps, command)
    chord, turned = float(np.linalg.norm(character.root[:2] - place)), character.heading - heading
    return {"speed": chord / np.sinc(turned / (2 * np.pi)) / seconds, "turning": turned / seconds}.__getitem__


def _once(
    character: Character, command: Command, reach: np.ndarray, hands: np.ndarray
) -> Callable[[str], float]:
    space = character.data.spaces[command.space]
    start, pace = character.root.copy(), character.now.weights @ space.seconds
    rise = [float(character.vertices[:, 1].mean())]
    hand, width = character.vertices[max(reach[0], 0)].astype(float), np.nan
    for k in range(space.poses - 1):
        character.perform(float(pace[k]))
        rise.append(float(character.vertices[:, 1].mean()))
        if k + 1 == reach[1]:
            hand = character.vertices[reach[0]].astype(float)
            width = float(np.linalg.norm(np.subtract(*character.vertices[hands].astype(float))))
    ground = rotate_ground(hand[[0, 2]] - start[:2], -start[2])
    chord, turned = float(np.linalg.norm(character.root[:2] - start[:2])), float(character.root[2] - start[2])
    seconds = float(pace[:-1].sum())
    return {
        "speed": chord / float(np.sinc(turned / (2 * np.pi))) / seconds,
        "turning": turned / seconds,
        "height": max(rise) - rise[0],
        "length": chord,
        "reach_x": float(ground[0]), "reach_y": float(hand[1]), "reach_z": float(ground[1]),
        "reach_width": width,
    }.__getitem__  # fmt: skip
