"""Commands that keep a character on a curve."""

from __future__ import annotations

import math

import numpy as np

from reperform.nodes.kernels.bezier import GroundCurve
from reperform.nodes.kernels.path_follow import Follower
from reperform.nodes.synthesis.character import Character, Command

# Greatest acceleration across the path, m/s^2.
_ACROSS = 1.5


class PathPilot:
    """Turns where a character is into commands for one space; `command` is None once the path ends.

    values: what was asked last, overwritten by the next command.

    Raises ValueError where the space has not the parameters speed and turning.
    """

    def __init__(self, character: Character, curve: GroundCurve, space: int, number: int = 0) -> None:
        data = character.data
        names = data.parameters[space]
        if not {"speed", "turning"} <= set(names):
            raise ValueError(
                f"to follow a path a space needs the parameters speed and turning; {data.names[space]!r} has "
                f"{', '.join(names)}"
            )
        self.character, self.space, self.number, self.left = character, space, number, curve.length
        self._speed, self._turn = names.index("speed"), names.index("turning")
        table = data.maps[space]
        turn = min(-table.lower[self._turn], table.upper[self._turn])
        self.slowest = float(table.lower[self._speed])
        limits = np.array([self.slowest, table.upper[self._speed], max(turn, 0.05), _ACROSS])
        self._follower = Follower(curve, limits)
        self.values = data.values(space, {})
        self._going = 0.5 * (limits[0] + limits[1])
        self._last = 0.0

    def command(self, time: float) -> Command | None:
        """What to do now (s)."""
        dt = max(time - self._last, 0.0)
        self._last = time
        character = self.character
        speed, turn, self.left = self._follower.command(
            character.root[0], character.root[1], character.heading, self._going
        )
        if self.left < 0.05:
            return None
        self._going += (speed - self._going) * (1.0 - math.exp(-dt / 0.3))
        self.values[self._speed], self.values[self._turn] = speed, turn
        return Command(self.space, self.values, self.number)
