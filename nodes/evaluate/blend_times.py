"""Time per blended frame, and a peer's."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.evaluate.blend_errors import METHODS, hybrid_of_pair
from reperform.nodes.evaluate.space_times import play, play_linear
from reperform.nodes.kernels.hybrid_blend import new_scratch
from reperform.nodes.kernels.mesh_blend import MeshBlender, blend_linear
from reperform.nodes.products.blend_measures import PosePairs
from reperform.nodes.products.measures import Measures

# 100 weights of two poses
_WEIGHTS = np.stack([1.0 - np.linspace(0.0, 1.0, 100), np.linspace(0.0, 1.0, 100)], axis=1)


@node(over="dataset", volatile=True)
def blend_times(
    pairs: PosePairs,
    *,
    repeats: Annotated[int, Param("1", 1, 1000, "how often each is timed; the least counts")] = 7,
    handles: Annotated[int, Param("vertex", 4, 1000, "vertices that the peer holds")] = 8,
) -> Measures:
    """Seconds of CPU time per frame of each method on each pair, on one thread: one frame per pair.

    Entries `linear`, `hybrid R=1`, `hybrid R=3` (100 weights in one compiled call), `non-linear` (both meshes taken apart
    and one blend), `ARAP` (libigl: as rigid as possible, 10 iterations from the linear blend with a few vertices
    held; nan where libigl is not installed), and `ARAP / non-linear`. The operators are factored beforehand for
    both. Methods alternate, and the least time of each counts.

    Source: 004 table 3.1; Sorkine and Alexa 2007, SGP (as rigid as possible).
    """
    rows = []
    faces = np.asarray(pairs.faces)
    for first, second in zip(np.asarray(pairs.first), np.asarray(pairs.second), strict=True):
        calls = _calls(first, second, faces, handles)
        least = dict.fromkeys(calls, np.inf)
        for _ in range(repeats):
            for name, call in calls.items():
                start = time.thread_time()
                call()
                least[name] = min(least[name], (time.thread_time() - start) / _frames(name))
        row = [least[name] for name in METHODS] + [least.get("ARAP", np.nan)]
        rows.append([*row, row[4] / row[3]])
    names = np.array([*METHODS, "ARAP", "ARAP / non-linear"])
    return Measures(np.array(rows).reshape(-1, len(names)), names, np.array(["s"] * 5 + ["1"]))


def _frames(name: str) -> int:
    """Frames that one call makes."""
    return len(_WEIGHTS) if name in METHODS[:3] else 1


def _calls(
    first: np.ndarray, second: np.ndarray, faces: np.ndarray, handles: int
) -> dict[str, Callable[[], object]]:
    """What is timed, called once so that it is compiled: blends of both poses at _WEIGHTS."""
    blender = MeshBlender.build(first, faces)
    one, three = (hybrid_of_pair(blender, first, second, levels) for levels in (1, 2))
    out, scratch = np.empty(first.shape, np.float32), new_scratch(one)
    calls: dict[str, Callable[[], object]] = {
        "linear": lambda: play_linear(one, _WEIGHTS, out),
        "hybrid R=1": lambda: play(one, _WEIGHTS, out, scratch),
        "hybrid R=3": lambda: play(three, _WEIGHTS, out, scratch),
        "non-linear": lambda: blender.at(blender.pair(first, second), 0.4),
    }
    peer = _arap(first, blend_linear([first, second], np.array([0.6, 0.4])), faces, handles)
    if peer is not None:
        calls["ARAP"] = peer
    for call in calls.values():
        call()
    return calls


def _arap(
    rest: np.ndarray, guess: np.ndarray, faces: np.ndarray, handles: int
) -> Callable[[], object] | None:
    try:
        import igl
    except ImportError:
        return None
    points, target = rest.astype(np.float64), guess.astype(np.float64)
    held = np.linspace(0, len(rest) - 1, handles).astype(np.int32)
    data = igl.ARAPData()
    data.max_iter = 10
    igl.arap_precomputation(points, np.asarray(faces, np.int64), 3, held, data)
    return lambda: igl.arap_solve(target[held].copy(), data, target.copy())
