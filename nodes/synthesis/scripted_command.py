"""A line of a script as a command to a character."""

from __future__ import annotations

from reperform.nodes.kernels.command_script import Cue
from reperform.nodes.synthesis.character import Command
from reperform.nodes.synthesis.character_data import CharacterData

_GRAB, _WIDTH = "grab", "reach_width"


def scripted_command(data: CharacterData, cue: Cue, number: int) -> Command:
    """What a cue asks of a character of this data.

    `hold` is how long the motion rests where it reaches. `grab` is the space of that name, else the first that controls
    reach_width; there `width` is short for it: the box that both hands close on, m.

    Raises ValueError for a space or parameter that there is not, a value that the space refuses, or a hold where
    nothing reaches.
    """
    values = dict(cue.values)
    hold = values.pop("hold", 0.0)
    space = _grabbing(data) if cue.motion == _GRAB else data.space(cue.motion)
    if "width" in values and _WIDTH in data.parameters[space]:
        values[_WIDTH] = values.pop("width")
    if hold < 0.0 or (hold > 0.0 and (data.reach[space] < 0 or data.spaces[space].cyclic)):
        raise ValueError(
            f"space {data.names[space]!r}: hold must be at least 0 s, in a space that reaches once, got {hold:g} s: "
            "leave it out, or control a reach in that space"
        )
    return Command(space, data.values(space, values), number, hold)


def _grabbing(data: CharacterData) -> int:
    """The space that grabs."""
    if _GRAB in data.names:
        return data.space(_GRAB)
    able = [s for s, names in enumerate(data.parameters) if _WIDTH in names]
    if not able:
        raise ValueError(
            f"grab needs a space with the parameter {_WIDTH}, there are {', '.join(data.names)}: add one whose takes "
            "grab boxes of different widths"
        )
    return able[0]
