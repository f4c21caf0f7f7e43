"""What a character does, written down frame by frame."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reperform.nodes.kernels.parameter_values import values_at
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.played import Played
from reperform.nodes.synthesis.character import SOURCES, Character, Command


class Recording:
    """Rows of a character's frames, room for `frames` of them; `product` is what was recorded so far."""

    def __init__(self, character: Character, frames: int, fps: float) -> None:
        feet = len(character.planted)
        self.character, self.fps, self.count = character, fps, 0
        self.vertices = np.zeros((frames, *character.vertices.shape), np.float32)
        self.root = np.zeros((frames, 3))
        self.take, self.moment = np.zeros((frames, SOURCES), np.int32), np.zeros((frames, SOURCES))
        self.weight = np.zeros((frames, SOURCES))
        self.space, self.pose, self.mix = np.zeros(frames, np.int32), np.zeros(frames), np.zeros(frames)
        self.planted, self.soles = np.zeros((frames, feet), bool), np.zeros((frames, feet, 3))
        d = max(map(len, character.data.parameters))
        self.asked, self.control = np.full((frames, d), np.nan), np.zeros((frames, d))
        self.asked_space = np.zeros(frames, np.int32)
        self.requests: list[tuple[float, int, float]] = []
        self._number: int | None = None

    @property
    def full(self) -> bool:
        """Whether there is no room for another frame."""
        return self.count == len(self.root)

    def add(self, command: Command) -> None:
        """Write down the frame that the character shows now, under this command."""
        character, f = self.character, self.count
        self.vertices[f], self.root[f] = character.vertices, character.root
        character.sources(self.take[f], self.moment[f], self.weight[f])
        self.space[f], self.pose[f] = character.space, character.pose
        self.mix[f] = character.mix if character.blending else 1.0
        self.planted[f], self.soles[f] = character.resting, character.soles
        self.asked[f, : len(command.values)] = command.values
        self.asked_space[f] = command.space
        self.control[f, : len(character.control)] = character.control
        if command.number != self._number:
            self._number = command.number
            self.requests.append((character.asked, command.space, np.nan))
        if character.served == command.number and np.isnan(self.requests[-1][2]):
            time, space, _ = self.requests[-1]
            self.requests[-1] = (time, space, character.latency)
        self.count += 1

    def product(self, way: np.ndarray | None = None) -> Played:
        """What was recorded; way: the path that was to be followed (N, 2)."""
        data, part = self.character.data, slice(0, self.count)
        time, space, latency = (np.array(column) for column in zip(*self.requests, strict=True))
        names, units, asked, done = self._parameters()
        return Played(
            MeshSequence(self.vertices[part], data.faces, np.array(self.fps, np.float32)),
            self.root[part], np.array(data.takes), self.take[part], self.moment[part], self.weight[part],
            np.array(data.names), self.space[part], self.pose[part], self.mix[part], self.planted[part],
            self.soles[part], time.astype(np.float64), space.astype(np.int32), latency.astype(np.float64),
            names, units, asked, done, np.zeros((0, 2)) if way is None else way,
        )  # fmt: skip

    def _parameters(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Names and units of all parameters; what was asked and what was done (frames, parameters)."""
        data, frames = self.character.data, range(self.count)
        units: dict[str, str] = {}
        for owned, own_units in zip(data.parameters, data.units, strict=True):
            units.update(zip(owned, own_units, strict=True))
        column = {name: k for k, name in enumerate(units)}
        asked, done = np.full((2, len(frames), len(units)), np.nan)
        for s, owned in enumerate(data.parameters):
            own = np.array([column[name] for name in owned])
            wanted = np.flatnonzero(self.asked_space[: self.count] == s)
            asked[np.ix_(wanted, own)] = self.asked[wanted, : len(own)]
            played = np.flatnonzero(self.space[: self.count] == s)
            done[np.ix_(played, own)] = values_at(self.control[played, : len(own)], *data.samples[s])
        return np.array(list(units)), np.array(list(units.values())), asked, done


def record(
    character: Character, direct: Callable[[float], Command | None], seconds: float, fps: float
) -> Recording:
    """Play for so long under direct(time), which may end it earlier with None."""
    frames = max(2, round(seconds * fps))
    recording = Recording(character, frames, fps)
    while not recording.full:
        command = direct(recording.count / fps)
        if command is None and recording.count >= 2:
            break
        if command is None:
            raise ValueError("there is nothing to play: the way ends where it begins")
        character.step(1.0 / fps, command)
        recording.add(command)
    return recording
