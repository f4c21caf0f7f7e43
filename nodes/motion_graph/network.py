"""A motion graph as a networkx graph, for pictures and other formats."""

from __future__ import annotations

import networkx
import numpy as np

from reperform.nodes.products.motion import MotionGraph


def network(graph: MotionGraph) -> networkx.MultiDiGraph:
    """Takes as nodes (`frames`), transitions as edges (`m`, `n`, `length` in frames, `cost`, `core`).

    All attributes are plain numbers, so that networkx can write it as JSON or GraphML.
    """
    out = networkx.MultiDiGraph(fps=float(graph.fps))
    takes = [str(take) for take in np.asarray(graph.takes)]
    for take, frames in zip(takes, np.asarray(graph.frames).tolist(), strict=True):
        out.add_node(take, frames=frames)
    names = ("source", "target", "source_frame", "target_frame", "length", "cost", "core")
    columns = (np.asarray(getattr(graph, name)).tolist() for name in names)
    for source, target, m, n, length, cost, core in zip(*columns, strict=True):
        out.add_edge(takes[source], takes[target], m=m, n=n, length=length, cost=cost, core=core)
    return out
