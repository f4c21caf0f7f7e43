"""A graph of poses as a networkx graph, for pictures and other formats."""

from __future__ import annotations

import networkx
import numpy as np

from reperform.nodes.products.essential import PoseGraph


def pose_network(graph: PoseGraph) -> networkx.DiGraph:
    """Poses as nodes (`take`, `frame`); edges with `cost`, `deformation`, `duration` and windows in frames.

    Nodes are pose numbers; the graph has `alpha` and `fps`. All attributes are plain numbers and names, so that
    networkx can write it as JSON or GraphML.
    """
    out = networkx.DiGraph(alpha=float(graph.alpha), fps=float(graph.fps))
    pose = 0
    for take, frames in zip(np.asarray(graph.takes).tolist(), np.asarray(graph.frames).tolist(), strict=True):
        out.add_nodes_from((pose + k, {"take": take, "frame": k}) for k in range(frames))
        pose += frames
    names = ("cost", "deformation", "duration", "source_length", "target_length")
    columns = (np.asarray(getattr(graph, name)).tolist() for name in names)
    ends = (np.asarray(graph.source).tolist(), np.asarray(graph.target).tolist())
    for source, target, *values in zip(*ends, *columns, strict=True):
        out.add_edge(source, target, **dict(zip(names, values, strict=True)))
    return out
