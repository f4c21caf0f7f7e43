"""Motion graphs and graphs of poses as JSON and GraphML."""

from __future__ import annotations

import json
from pathlib import Path

import networkx

from reperform.nodes.export.atomic import beside
from reperform.nodes.motion_graph.network import network
from reperform.nodes.motion_graph.pose_network import pose_network
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.motion import MotionGraph


def write_motion_graph(path: Path, graph: MotionGraph | PoseGraph) -> None:
    """Takes (or poses) as nodes and transitions as edges with all their numbers; complete or absent.

    .json is networkx's node-link form, .graphml is read by yEd, Gephi and others.
    """
    drawn = pose_network(graph) if isinstance(graph, PoseGraph) else network(graph)
    with beside(path) as draft:
        if path.suffix.lower() == ".graphml":
            networkx.write_graphml(drawn, draft, named_key_ids=True)
        else:
            data = networkx.node_link_data(drawn, edges="edges")
            draft.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
