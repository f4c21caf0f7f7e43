"""The 4D parametric motion graph that an XML file describes."""

from __future__ import annotations

from pathlib import Path, PureWindowsPath
from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.motion_graph_xml import SequenceFiles, read_graph_xml
from reperform.nodes.motion_graph.parametric import parametric
from reperform.nodes.product import Dataset
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace

_WHO = "motion_graph.from_xml"


@node(over="dataset", memory=4.0)
def from_xml(
    spaces: Dataset[ParametricSpace],
    *,
    file: Annotated[str, File("graph: .xml with nodes and the sequences of each")],
    edges: Annotated[
        tuple[str, ...], Param(about="transitions that are allowed: SOURCE>TARGET; empty: within `suggest`")
    ] = (),
    suggest: Annotated[
        float,
        Param("1", 0.0, 1.0, "least dissimilarity, in units of the largest, up to which an edge is made"),
    ] = 1.0,
    subdivisions: Annotated[int, Param("1", 0, 4, "how often weights are bisected for the tables")] = 2,
    blend: Annotated[Literal["nonlinear", "linear"], Param(about="how references are blended")] = "nonlinear",
    latency_weight: Annotated[
        float,
        Param("1", 0.0, 1000.0, "lambda: thousandths of the largest dissimilarity that 1/25 s is worth"),
    ] = 0.38,
) -> ParametricGraph:
    """Join those spaces that a file names, in its order, by transitions that are found while the motion plays.

    spaces: more may be given than the file has nodes. A node of the file is the space that blends the same takes; a
    sequence is told by the name of its folder (`/media/walk/` is the take `walk`), since where meshes, offsets and
    rotations lie is known from the takes. The format has no transitions: without `edges` all of `suggest` are made, by
    default every pair. The tables are those of motion_graph.parametric.

    Raises ValueError where the file cannot be opened, is malformed (with the line), or a node of it blends other takes
    than any space, or the same as an earlier node.

    Source: 004 appendix B.1, fig B.1.
    """
    path = Path(file)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"{_WHO}: {path.name} must be a readable XML file in UTF-8, got: {error}") from error
    names: list[str] = []
    for number, sequences in enumerate(read_graph_xml(text, f"{_WHO}: {path.name}"), 1):
        name = _space_of(sequences, spaces, f"{_WHO}: {path.name}, node {number}")
        if name in names:
            raise ValueError(
                f"{_WHO}: {path.name}, node {number}: must differ from the others, got the takes of node "
                f"{names.index(name) + 1}: leave one out"
            )
        names.append(name)
    return parametric(
        {name: spaces[name] for name in names}, edges=edges, suggest=suggest, subdivisions=subdivisions,
        blend=blend, latency_weight=latency_weight,
    )  # fmt: skip


def _space_of(sequences: tuple[SequenceFiles, ...], spaces: Dataset[ParametricSpace], where: str) -> str:
    # folders of either system, with or without a slash at the end
    wanted = {PureWindowsPath(sequence.meshes).name for sequence in sequences}
    for name, space in spaces.items():
        if {str(take) for take in np.asarray(space.takes)} == wanted:
            return name
    known = "; ".join(
        f"{name}: {' '.join(map(str, np.asarray(space.takes)))}" for name, space in spaces.items()
    )
    raise ValueError(
        f"{where}: needs a space of the takes {' '.join(sorted(wanted))}, given are {known}: add a motion_graph.space"
    )
