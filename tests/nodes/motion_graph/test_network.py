from io import BytesIO

import networkx
import numpy as np

from reperform.nodes.motion_graph.network import network
from reperform.nodes.products.motion import MotionGraph


def test_takes_and_transitions_survive_graphml() -> None:
    index = np.array([0, 1, 0], np.int32)
    graph = MotionGraph(
        takes=np.array(["walk", "jog"]), frames=np.array([30, 20], np.int32),
        source=index, target=1 - index, source_frame=np.array([20, 9, 12], np.int32),
        target_frame=np.array([6, 7, 8], np.int32), length=np.array([5, 4, 3], np.int32),
        cost=np.array([0.1, 0.2, 0.3], np.float32), yaw=np.zeros(3), offset=np.zeros((3, 2)),
        core=np.array([True, True, False]), fps=np.asarray(25.0, np.float32),
    )  # fmt: skip
    stream = BytesIO()
    networkx.write_graphml(network(graph), stream)
    stream.seek(0)
    back = networkx.read_graphml(stream, force_multigraph=True)
    assert dict(back.nodes(data="frames")) == {"walk": 30, "jog": 20}
    assert sorted(back.edges(data="m")) == [("jog", "walk", 9), ("walk", "jog", 12), ("walk", "jog", 20)]
    assert [core for *_, core in back.edges(data="core")].count(True) == 2
