"""What an impatient user would ask for."""

from __future__ import annotations

import numpy as np

from reperform.nodes.synthesis.character import Command
from reperform.nodes.synthesis.character_data import CharacterData


class RandomCommands:
    """A new command every `every` s: a space and values of its parameters, drawn evenly; `at(time)`, times in order."""

    def __init__(self, data: CharacterData, every: float, seed: int) -> None:
        self._data, self._every, self._random = data, every, np.random.default_rng(seed)
        self._command, self._number = Command(0, np.zeros(0)), -1

    def at(self, time: float) -> Command:
        """The command of this moment (s)."""
        while self._number < int(time / self._every + 1e-9):
            self._number += 1
            space = int(self._random.integers(len(self._data.spaces)))
            table = self._data.maps[space]
            share = self._random.random(len(table.lower))
            self._command = Command(space, table.lower + share * (table.upper - table.lower), self._number)
        return self._command
