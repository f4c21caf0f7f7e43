"""Joint positions as BVH."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from reperform.nodes.export.atomic import beside
from reperform.nodes.kernels.articulation import local_turns
from reperform.nodes.products.mocap import Mocap
from reperform.nodes.products.performance import SkeletonSequence


def write_bvh(path: Path, motion: SkeletonSequence | Mocap) -> None:
    """Write a hierarchy with rotations: channels Z X Y in degrees, metres; complete or absent.

    Where only positions are known: the rest pose has the directions of the first frame with every bone's median
    length. Per frame and joint, parents first: the turn that best takes the rest directions of its children to
    the seen ones (Kabsch); a joint with one child takes its parent's turn and the smallest swing that points the
    bone; a joint without children its parent's turn. Root and bone directions are exact; lengths are constant, as
    the format wants them. Known rotations are written as they are. A joint `PARENT_end` becomes an end site.

    Raises ValueError unless there is one root, with parents before children.

    Source: Kabsch 1976, Acta Crystallographica A32.
    """
    skeleton = motion.skeleton if isinstance(motion, Mocap) else motion
    joints = np.asarray(skeleton.joints, np.float64)
    parents, names = np.asarray(skeleton.parents), [str(name) for name in np.asarray(skeleton.names)]
    if (
        not len(joints)
        or (parents[1:] < 0).any()
        or (parents >= np.arange(len(parents))).any()
        or parents[0] >= 0
    ):
        raise ValueError(
            f"{path}: a skeleton needs frames, joint 0 as its only root (-1) and parents before children, got "
            f"{len(joints)} frames and parents {parents.tolist()}"
        )
    children: list[list[int]] = [[] for _ in parents]
    for joint, parent in enumerate(parents[1:], 1):
        children[parent].append(joint)
    if isinstance(motion, Mocap):
        offsets = np.asarray(motion.offset, np.float64)
        local = local_turns(parents, np.asarray(motion.rotation, np.float64))
    else:
        offsets = _rest_offsets(joints, parents)
        local = local_turns(parents, _turns(joints, offsets, parents, children))
    order = [joint for joint in _depth_first(0, children) if not _ends(joint, names, children)]
    channels = np.zeros((len(joints), 3 + 3 * len(order)))
    channels[:, :3] = joints[:, 0]
    for column, joint in enumerate(order):
        # BVH multiplies in the listed order: Z, X, Y, intrinsic.
        angles = Rotation.from_matrix(local[:, joint]).as_euler("ZXY", degrees=True)
        channels[:, 3 + 3 * column : 6 + 3 * column] = angles
    lines = ["HIERARCHY", *_hierarchy(0, 0, names, offsets, children)]
    lines += ["MOTION", f"Frames: {len(joints)}", f"Frame Time: {1 / float(skeleton.fps):.8f}"]
    lines += [" ".join(f"{value:.6f}" for value in row) for row in channels]
    with beside(path) as draft:
        draft.write_text("\n".join(lines) + "\n", encoding="ascii", errors="replace")


def _rest_offsets(joints: np.ndarray, parents: np.ndarray) -> np.ndarray:
    offsets = np.zeros((len(parents), 3))
    for joint, parent in enumerate(parents[1:], 1):
        bones = joints[:, joint] - joints[:, parent]
        first = bones[0] / max(float(np.linalg.norm(bones[0])), 1e-12)
        offsets[joint] = first * np.median(np.linalg.norm(bones, axis=1))
    return offsets


def _turns(
    joints: np.ndarray, offsets: np.ndarray, parents: np.ndarray, children: list[list[int]]
) -> np.ndarray:
    """Rotations in the world (T, J, 3, 3) that the positions tell."""
    out = np.empty((*joints.shape[:2], 3, 3))
    for frame, positions in enumerate(joints):
        turns: list[Rotation] = [Rotation.identity()] * len(parents)
        for joint in range(len(parents)):
            above = turns[parents[joint]] if joint else Rotation.identity()
            turns[joint] = _turn(
                above, offsets[children[joint]], positions[children[joint]] - positions[joint]
            )
            out[frame, joint] = turns[joint].as_matrix()
    return out


def _ends(joint: int, names: list[str], children: list[list[int]]) -> bool:
    """Whether a joint only ends a bone."""
    return joint > 0 and not children[joint] and names[joint].endswith("_end")


def _turn(above: Rotation, rest: np.ndarray, seen: np.ndarray) -> Rotation:
    lengths = np.linalg.norm(rest, axis=1) * np.linalg.norm(seen, axis=1)
    rest, seen = rest[lengths > 1e-12], seen[lengths > 1e-12]
    if not len(rest):
        return above
    if len(rest) == 1 or np.linalg.matrix_rank(rest, tol=1e-6) < 2:
        return _swing(above.apply(rest.sum(axis=0)), seen.sum(axis=0)) * above
    u, _, vt = np.linalg.svd(seen.T @ rest)
    return Rotation.from_matrix(u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt)


def _swing(start: np.ndarray, end: np.ndarray) -> Rotation:
    """The smallest turn from one direction to another."""
    a, b = start / np.linalg.norm(start), end / np.linalg.norm(end)
    cosine = float(np.clip(a @ b, -1, 1))
    axis = np.cross(a, b)
    if np.linalg.norm(axis) < 1e-9:
        if cosine > 0:
            return Rotation.identity()
        axis = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
    return Rotation.from_rotvec(np.arccos(cosine) * axis / np.linalg.norm(axis))


def _depth_first(joint: int, children: list[list[int]]) -> list[int]:
    return [joint] + [below for child in children[joint] for below in _depth_first(child, children)]


def _hierarchy(
    joint: int, depth: int, names: list[str], offsets: np.ndarray, children: list[list[int]]
) -> list[str]:
    pad, offset = "\t" * depth, " ".join(f"{v:.6f}" for v in offsets[joint])
    position = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    lines = [
        f"{pad}{'JOINT' if depth else 'ROOT'} {names[joint].replace(' ', '_')}",
        pad + "{",
        f"{pad}\tOFFSET {offset}",
        f"{pad}\tCHANNELS {'3 Zrotation Xrotation Yrotation' if depth else position}",
    ]
    for child in children[joint]:
        if _ends(child, names, children):
            lines += _end_site(pad, offsets[child])
        else:
            lines += _hierarchy(child, depth + 1, names, offsets, children)
    if not children[joint]:
        lines += _end_site(pad, np.zeros(3))
    return [*lines, pad + "}"]


def _end_site(pad: str, offset: np.ndarray) -> list[str]:
    place = " ".join(f"{v:.6f}" for v in offset)
    return [f"{pad}\tEnd Site", pad + "\t{", f"{pad}\t\tOFFSET {place}", pad + "\t}"]
