"""Whether aligned vertices stay on the points of the performer that they stand for."""

from __future__ import annotations

import numpy as np

from reperform.nodes.declaration import node
from reperform.nodes.kernels.correspondence_error import SurfacePoints, attach
from reperform.nodes.kernels.limb_swap import limb_pairs, nearest_bone, swapped_limbs
from reperform.nodes.product import Dataset
from reperform.nodes.products.aligned import AlignedSequence
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.performance import SkeletonSequence

_WHO = "evaluate.correspondence"


@node(over="dataset", memory=1.0)
def correspondence(
    aligned: Dataset[AlignedSequence],
    truth: Dataset[MeshSequence],
    skeleton: Dataset[SkeletonSequence],
) -> Dataset[Measures]:
    """Distance of every aligned vertex from the true place of the point it stands for, m, and swapped limbs.

    At the root frame, whose topology all frames have, every aligned vertex v is bound to the nearest point y_v of
    the true surface (triangle and barycentrics). Entries, per frame: `error`, the mean over v of |x_v - y_v|, y_v
    moved with the true mesh, nan at the root frame itself; `worst`, the 99th percentile; `swapped`, 1 where a limb
    is nearer to the other side's true limb than to its own, else 0. What the rebuilt surface adds to the body (a
    visual hull is fatter) is part of the error. Limbs are the bones named left and right; a true vertex belongs to
    the bone nearest to it at the root frame.

    aligned and truth: (frame, vertex, 3) m, each of one topology over all takes, frames as filmed.
    Raises ValueError where takes, frames or topologies do not agree, or the skeleton has no left and right.
    Source: 004 section 2.4 (alignment against truth).
    Departure: a surface distance hides swapped limbs, so that they are counted on their own.
    """
    meshes = {name: sequence.mesh for name, sequence in aligned.items()}
    for name in meshes:
        _check(name, meshes, truth)
    first = next(iter(aligned.values()))
    take, frame = str(np.asarray(first.root_take)), int(np.asarray(first.root_frame))
    faces = np.asarray(truth[take].faces)
    at_root = np.asarray(truth[take].vertices[frame], np.float64)
    points = attach(np.asarray(meshes[take].vertices[frame]), at_root, faces)
    bones = skeleton[take]
    pairs = limb_pairs(np.asarray(bones.names))
    if not pairs:
        raise ValueError(
            f"{_WHO}: joints must come as left_X and right_X, got {', '.join(map(str, np.asarray(bones.names)))}"
        )
    bone = nearest_bone(at_root, np.asarray(bones.joints[frame], np.float64), np.asarray(bones.parents))
    sides = np.array([(left, right) for _, left, right in pairs])
    found = {}
    for name, sequence in meshes.items():
        rows = [
            _measure(np.asarray(built), np.asarray(true), points, faces, bone, sides)
            for built, true in zip(sequence.vertices, truth[name].vertices, strict=True)
        ]
        if name == take:
            rows[frame] = [np.nan, np.nan, rows[frame][2]]
        found[name] = Measures(
            np.array(rows), np.array(["error", "worst", "swapped"]), np.array(["m", "m", "1"])
        )
    return found


def _check(name: str, aligned: Dataset[MeshSequence], truth: Dataset[MeshSequence]) -> None:
    if name not in truth:
        raise ValueError(f"{_WHO}: no truth for take {name!r}; there is truth for {', '.join(truth)}")
    ours, theirs = len(aligned[name].vertices), len(truth[name].vertices)
    if ours != theirs:
        raise ValueError(f"{_WHO}: take {name!r} must have the frames of its truth, {theirs}, got {ours}")
    for what, meshes in (("aligned", aligned), ("true", truth)):
        first = next(iter(meshes))
        if not np.array_equal(np.asarray(meshes[name].faces), np.asarray(meshes[first].faces)):
            raise ValueError(
                f"{_WHO}: the {what} meshes must share one topology; take {name!r} differs from {first!r}"
            )


def _measure(
    built: np.ndarray,
    true: np.ndarray,
    points: SurfacePoints,
    faces: np.ndarray,
    bone: np.ndarray,
    sides: np.ndarray,
) -> list[float]:
    error = np.linalg.norm(points.on(true, faces) - built, axis=1)
    nearest_corner = faces[points.face, points.barycentric.argmax(axis=1)]
    swapped = swapped_limbs(built, bone[nearest_corner], true, bone, sides)
    return [float(error.mean()), float(np.percentile(error, 99)), float(swapped.any())]
