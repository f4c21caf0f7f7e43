"""Parametric motion graphs as XML."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from reperform.nodes.export.atomic import beside
from reperform.nodes.kernels.motion_graph_xml import SequenceFiles, write_graph_xml
from reperform.nodes.products.parametric import ParametricGraph


def write_parametric_graph(path: Path, graph: ParametricGraph) -> None:
    """Spaces as nodes with the takes that each blends; complete or absent. `motion_graph.from_xml` reads it.

    A take is written as the folder of its name. Transitions are no part of the format: they are found while playing.

    Source: 004 appendix B.1.
    """
    takes, owner = np.asarray(graph.takes), np.asarray(graph.take_space)
    nodes = [
        tuple(SequenceFiles(f"{take}/") for take in takes[owner == space])
        for space in range(len(graph.spaces))
    ]
    with beside(path) as draft:
        draft.write_text(write_graph_xml(tuple(nodes)), encoding="utf-8")
