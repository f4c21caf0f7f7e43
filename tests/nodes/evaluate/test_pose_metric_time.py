import numpy as np

from reperform.nodes.evaluate.pose_metric_time import pose_metric_time
from reperform.nodes.studio.perform import perform


def test_clusters_are_faster_than_faces():
    meshes = {name: perform(motion="walk", seconds=0.2, phase=p).mesh for name, p in (("a", 0.1), ("b", 0.4))}
    found = pose_metric_time(meshes, clusters=50, repeats=3)
    value = dict(zip(found.name.tolist(), found.value[0].tolist(), strict=True))
    assert set(value) == {"exact", "clusters", "speedup", "prepare", "cluster"}
    assert np.isclose(value["speedup"], value["exact"] / value["clusters"])
    assert value["speedup"] > 3
    assert all(v > 0 for v in value.values())
