"""A character that follows a timeline of commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.command_script import read_script
from reperform.nodes.product import Dataset
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace
from reperform.nodes.products.played import Played
from reperform.nodes.products.space_corrections import SpaceCorrections
from reperform.nodes.synthesis.cell_corrections import Blending
from reperform.nodes.synthesis.character import Character, Command
from reperform.nodes.synthesis.character_data import CharacterData, character_data
from reperform.nodes.synthesis.recording import record
from reperform.nodes.synthesis.scripted_command import scripted_command

_WHO = "synthesis.play_script"


@node(over="dataset", memory=2.0)
def play_script(
    graph: ParametricGraph,
    spaces: Dataset[ParametricSpace],
    corrections: Dataset[SpaceCorrections] | None = None,
    *,
    script: Annotated[
        tuple[str, ...], Param(about="SECONDS SPACE [PARAMETER=VALUE ..] [hold=SECONDS], in order of time")
    ],
    seconds: Annotated[float, Param("s", 0.1, 3600.0, "length of the motion")] = 20.0,
    fps: Annotated[float, Param("Hz", 5.0, 240.0, "frames per second")] = 25.0,
    blend: Annotated[float, Param("s", 0.05, 2.0, "length of a transition")] = 0.3,
    ease: Annotated[float, Param("s", 0.02, 2.0, "in which a foot that was held is let go")] = 0.2,
    blending: Annotated[
        Blending, Param(about="of meshes; hybrid: corrected where `corrections` are given, else linear")
    ] = "linear",
) -> Played:
    """Play a timeline of commands through a parametric motion graph, as a user would with the keyboard.

    graph: how the spaces are joined; spaces: those that the graph names; corrections: of blend.correct_space. Every
    step of 1 / fps s the character gets the command of that time; transitions are searched on line. Same script, same
    motion. `hold=SECONDS` lets a motion that reaches rest where it does; `grab width=0.45 hold=2` closes two hands on
    a box of that width (m), by the weights f^-1(width), in the space named `grab` or the one with the parameter
    reach_width.

    Raises ValueError where the script cannot be read, names a space or parameter that there is not, or asks for a
    value that a space refuses.

    Source: Casas, Tejera, Guillemaut and Hilton 2012, I3D; 004 chapter 4, appendix B (keyboard control).
    """
    data = character_data(graph, spaces, corrections, blending)
    direct = _director(data, script)
    start = direct(0.0)
    character = Character(data, start.space, blend=blend, ease=ease)
    return record(character, direct, seconds, fps).product()


def _director(data: CharacterData, script: tuple[str, ...]) -> Callable[[float], Command]:
    commands = []
    for number, cue in enumerate(read_script(script, _WHO)):
        try:
            commands.append((cue.time, scripted_command(data, cue, number)))
        except ValueError as error:
            raise ValueError(f"{_WHO}, line {number + 1}: {error}") from error

    def direct(time: float) -> Command:
        return next(
            (command for start, command in reversed(commands) if start <= time + 1e-9), commands[0][1]
        )

    return direct
