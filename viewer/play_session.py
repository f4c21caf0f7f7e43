"""A character under the hands: keys, a drawn path, what is asked, what is recorded. Knows nothing of windows."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from reperform.nodes.kernels.bezier import curve_of, through
from reperform.nodes.products.played import Played
from reperform.nodes.synthesis.character import Character, Command
from reperform.nodes.synthesis.character_data import CharacterData
from reperform.nodes.synthesis.path_pilot import PathPilot
from reperform.nodes.synthesis.recording import Recording
from reperform.viewer.pictures.play_diagram import node_diagram, parameter_diagram

# Held keys carry a parameter over its whole range in so many seconds.
_SWEEP = 2.0
# Longest step that is played at once, s: a window that hangs must not fling the character away.
_LONGEST = 0.1
# Seconds that can be recorded, and frames per second of a recording.
_ROOM, RATE = 120.0, 50.0
# Keys and the parameter whose space they call.
CALLS = {"j": "height", "l": "length", "r": "reach", "g": "reach_width"}
# Keys that are held while what they call shall rest where it reaches.
HOLDS = {"r", "g"}
HELP = (
    "arrows: speed, direction   J jump   L leap   R reach, G grab: as long as held   1-9 motions   "
    "ctrl+drag: path   X drop path   H blending   C record   Esc close"
)


class PlaySession:
    """The state of the play window.

    `press` and `release` keys (up, down, left, right, j, l, r, g, h, x, c, 1 .. 9), `draw` a path, `tick` the time; the mesh is
    `character.vertices`.  units: of the parameters of every space.
    """

    def __init__(self, data: CharacterData, units: tuple[tuple[str, ...], ...]) -> None:
        self.data, self.units = data, units
        self.character = Character(data)
        self.values = [data.values(s, {}) for s in range(len(data.spaces))]
        self.before = [values.copy() for values in self.values]
        self.space, self.number = self.character.space, 0
        self.recording: Recording | None = None
        self.pilot: PathPilot | None = None
        self.path: list[tuple[float, float]] = []
        self._held: set[str] = set()
        self._rest, self._spent = 0.0, deque[float](maxlen=60)
        self._rates = deque[float](maxlen=60)

    def press(self, key: str) -> None:
        """A key goes down."""
        key = key.lower()
        if key in ("up", "down", "left", "right"):
            self._held.add(key)
        elif key in CALLS:
            self.call_parameter(CALLS[key])
            self._held |= HOLDS & {key}
        elif key == "h":
            self.character.corrected = not self.character.corrected
        elif key.isdigit() and 0 < int(key) <= len(self.data.names):
            self.call(int(key) - 1)
        elif key == "x":
            self.drop_path()
        elif key == "c":
            self.toggle_recording()

    def release(self, key: str) -> None:
        """A key goes up."""
        self._held.discard(key.lower())

    def call(self, space: int) -> None:
        """Ask for a space."""
        self.space, self.number, self.pilot = space, self.number + 1, None

    def call_parameter(self, parameter: str) -> None:
        """Ask for the first space whose parameters begin so; nothing where there is none."""
        fitting = [
            s for s, names in enumerate(self.data.parameters) if any(n.startswith(parameter) for n in names)
        ]
        if fitting:
            self.call(fitting[0])

    def draw(self, x: float, z: float) -> None:
        """Add a place on the ground (m) to the path that is being drawn; nearer than 0.3 m to the last does nothing."""
        if not self.path:
            self.path = [(float(self.character.root[0]), float(self.character.root[1]))]
        if math.dist(self.path[-1], (x, z)) > 0.3:
            self.path.append((x, z))

    def follow(self) -> None:
        """Go along the path that was drawn, in the first space with speed and turning; nothing where there is none."""
        walks = [s for s, names in enumerate(self.data.parameters) if {"speed", "turning"} <= set(names)]
        if len(self.path) > 1 and walks:
            # the character went on while the path was drawn
            self.path[0] = (float(self.character.root[0]), float(self.character.root[1]))
            self.call(walks[0])
            self.pilot = PathPilot(
                self.character, curve_of(through(np.array(self.path))), walks[0], self.number
            )

    def drop_path(self) -> None:
        """Forget the path."""
        self.path, self.pilot = [], None

    def toggle_recording(self) -> None:
        """Begin to record, or end it; what was recorded stays until the next begin."""
        if self.recording is None or self._ended:
            self.recording, self._ended = Recording(self.character, round(_ROOM * RATE), RATE), False
        else:
            self._ended = True

    _ended = False

    @property
    def is_recording(self) -> bool:
        """Whether what is played is being written down."""
        return self.recording is not None and not self._ended and not self.recording.full

    def recorded(self) -> Played | None:
        """What was recorded; None where nothing was."""
        if self.recording is None or self.recording.count < 2:
            return None
        return self.recording.product(np.array(self.path) if len(self.path) > 1 else None)

    def command(self) -> Command:
        """What is asked now."""
        if self.pilot is not None:
            told = self.pilot.command(self.character.time)
            if told is not None:
                return told
            self.pilot, self.path = None, []
        return Command(
            self.space, self.values[self.space], self.number, math.inf if self._held & HOLDS else 0.0
        )

    def tick(self, seconds: float, spent: float | None = None) -> bool:
        """So much time has passed: play it in steps of 1 / RATE; whether anything moved. spent: s since last drawn."""
        if spent:
            self._rates.append(spent)
        self._steer(min(seconds, _LONGEST))
        self._rest += min(seconds, _LONGEST)
        moved = False
        while self._rest >= 1 / RATE:
            self._rest -= 1 / RATE
            command = self.command()
            self.character.step(1 / RATE, command)
            if self.is_recording and self.recording is not None:
                self.recording.add(command)
            moved = True
        if self.space != self.character.space and self.character.served == self.number and not self.pilot:
            # a motion that was performed gives way to the last cyclic one, and so do the arrows
            self.space = self.character.space if self.data.spaces[self.character.space].cyclic else self.space
        return moved

    def _steer(self, seconds: float) -> None:
        names, table, values = (
            self.data.parameters[self.space],
            self.data.maps[self.space],
            self.values[self.space],
        )
        for key, sign in (("up", 1), ("down", -1), ("left", 1), ("right", -1)):
            if key not in self._held:
                continue
            wanted = (
                ("turning", "reach_x")
                if key in ("left", "right")
                else ("speed", "height", "length", "reach_y", "reach_width")
            )
            for k, name in enumerate(names):
                if name in wanted:
                    self.before[self.space][k] = values[k]
                    step = sign * (table.upper[k] - table.lower[k]) * seconds / _SWEEP
                    values[k] = min(max(values[k] + step, table.lower[k]), table.upper[k])

    def status(self) -> str:
        """One line: motion, latency of the last transition, rate, recording."""
        character = self.character
        rate = len(self._rates) / sum(self._rates) if self._rates and sum(self._rates) > 0 else math.nan
        parts = [self.data.names[character.space]]
        parts.append("latency -" if math.isnan(character.latency) else f"latency {character.latency:.2f} s")
        parts.append("-- frames/s" if math.isnan(rate) else f"{rate:.0f} frames/s")
        if any(self.data.corrections):
            parts.append("hybrid blending" if character.corrected else "linear blending")
        if self.is_recording and self.recording is not None:
            parts.append(f"recording {self.recording.count / RATE:.1f} s")
        elif self.recording is not None:
            parts.append(f"recorded {self.recording.count / RATE:.1f} s")
        return "   ".join(parts)

    def nodes_picture(self, size: tuple[int, int]) -> np.ndarray:
        """Which motion plays (004 fig B.3a)."""
        data, character = self.data, self.character
        edges = list(zip(data.source.tolist(), data.target.tolist(), strict=True))
        share = character.pose / max(data.spaces[character.space].poses - 1, 1)
        return node_diagram(data.names, edges, character.space, self.space, share, size)

    def parameters_picture(self, size: tuple[int, int]) -> np.ndarray:
        """Under which parameters (004 fig B.3b)."""
        s, table = self.space, self.data.maps[self.space]
        # along a path the pilot asks
        asked, before = self.values[s], self.before[s]
        if self.pilot is not None:
            asked = before = self.pilot.values
        return parameter_diagram(
            self.data.parameters[s], self.units[s], table.lower, table.upper, asked, before, size
        )
