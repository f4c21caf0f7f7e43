"""Whether an aligned surface took one limb for the other."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree


def limb_pairs(names: np.ndarray) -> list[tuple[str, int, int]]:
    """(limb, left joint, right joint) of joints named left_X and right_X, or X_l and X_r, LeftX and RightX."""
    index = {str(name): k for k, name in enumerate(names)}
    pairs = []
    for name, k in index.items():
        for left, right in (("left", "right"), ("Left", "Right")):
            mirrored = name.replace(left, right)
            if mirrored != name and mirrored in index:
                pairs.append((name.replace(left, "").strip("_"), k, index[mirrored]))
        if name.endswith("_l") and f"{name[:-2]}_r" in index:
            pairs.append((name[:-2], k, index[f"{name[:-2]}_r"]))
    return pairs


def nearest_bone(points: np.ndarray, joints: np.ndarray, parents: np.ndarray) -> np.ndarray:
    """For every point (N, 3) the joint (N,) at whose bone it lies: the segments from a joint to its children.

    A joint without children owns what lies beyond it. joints (J, 3), parents (J,), -1 at the root; else ties go to
    the lower joint.
    """
    best, owner = np.full(len(points), np.inf), np.zeros(len(points), int)
    for k in range(len(joints)):
        below = np.flatnonzero(parents == k)
        for end in joints[below] if len(below) else joints[k : k + 1]:
            distance = _to_segment(points, joints[k], end)
            closer = distance < best if len(below) else distance <= best + 1e-9
            best[closer], owner[closer] = distance[closer], k
    return owner


def _to_segment(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    along = end - start
    share = np.clip((points - start) @ along / max(float(along @ along), 1e-12), 0, 1)
    return np.asarray(np.linalg.norm(points - start - share[:, None] * along, axis=1))


def swapped_limbs(
    aligned: np.ndarray, limb: np.ndarray, truth: np.ndarray, truth_limb: np.ndarray, pairs: np.ndarray
) -> np.ndarray:
    """Which limbs of one frame lie at the other side's limb: bool (2 P,), the left ones first.

    aligned (V, 3) with the limb (V,) that each vertex stands for; truth (W, 3) with its limbs (W,); pairs (P, 2):
    left and right. A limb is swapped where the mean distance of its vertices to the nearest true vertices of the
    other side is less than to those of its own. A limb without vertices is not swapped.
    """
    trees = {int(k): cKDTree(truth[truth_limb == k]) for k in pairs.ravel() if (truth_limb == k).any()}
    swapped = np.zeros(2 * len(pairs), bool)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    for row, (own, other) in enumerate(both):
        points = aligned[limb == own]
        if len(points) and own in trees and other in trees:
            swapped[row] = _mean_distance(trees[other], points) < _mean_distance(trees[own], points)
    return swapped


def _mean_distance(tree: cKDTree, points: np.ndarray) -> float:
    return float(np.mean(tree.query(points)[0]))
