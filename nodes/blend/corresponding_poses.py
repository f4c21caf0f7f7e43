"""Any number of takes cut into corresponding poses, for blending them along their whole length."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.blend.pair_frames import Pace, lay_on, pose_at
from reperform.nodes.product import Dataset
from reperform.nodes.products.mesh import MeshSequence


def chosen_takes(meshes: Dataset[MeshSequence], takes: Sequence[str], who: str) -> dict[str, MeshSequence]:
    """The takes named, in that order; all where none is named. Raises ValueError where one is not there."""
    missing = [take for take in takes if take not in meshes]
    if missing:
        raise ValueError(f"{who}: no take {missing[0]!r}; there are {', '.join(meshes)}")
    return {take: meshes[take] for take in takes or meshes}


def corresponding_poses(meshes: Dataset[MeshSequence], pace: Pace, place: bool, who: str) -> np.ndarray:
    """Corresponding poses of N takes, (N, T, V, 3) float32, m.

    stretched: every take is run through from end to end in as many poses as they have on average; frame by
    frame: up to the shortest one's end. place: lay every other take on the first by one ground-plane motion.
    Raises ValueError where there are fewer than two takes, or their topologies or frame rates differ.
    """
    if len(meshes) < 2:
        raise ValueError(f"{who}: two or more takes needed to blend, got {len(meshes)}")
    (name, first), *others = meshes.items()
    for other, sequence in others:
        if (
            not np.array_equal(np.asarray(first.faces), np.asarray(sequence.faces))
            or first.vertices.shape[1] != sequence.vertices.shape[1]
        ):
            raise ValueError(
                f"{who}: takes must share one topology; {other} differs from {name}: align them first"
            )
        if not np.isclose(np.asarray(first.fps), np.asarray(sequence.fps)):
            raise ValueError(
                f"{who}: takes must share one frame rate; {name} has {first.fps} Hz, {other} {sequence.fps} Hz"
            )
    lengths = [len(sequence.vertices) for sequence in meshes.values()]
    count = max(1, round(float(np.mean(lengths)))) if pace == "stretched" else min(lengths)
    taken = [
        np.stack([pose_at(np.asarray(sequence.vertices), t) for t in np.linspace(0.0, last, count)])
        for sequence, last in zip(
            meshes.values(),
            [length - 1.0 if pace == "stretched" else count - 1.0 for length in lengths],
            strict=True,
        )
    ]
    if place:
        taken[1:] = [lay_on(taken[0], vertices) for vertices in taken[1:]]
    return np.stack(taken).astype(np.float32)
