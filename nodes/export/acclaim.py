"""Skeletal motion as Acclaim files: the skeleton (.asf) and its motion (.amc) beside each other."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from reperform.nodes.export.atomic import beside
from reperform.nodes.kernels.articulation import local_turns
from reperform.nodes.products.mocap import Mocap

# The unit that the CMU database uses: values are 0.45ths of an inch.
_LENGTH = 0.45
_PER_METRE = _LENGTH / 0.0254
# Shorter bones have no direction, m.
_NONE = 1e-9


class _Bone(NamedTuple):
    """A bone, the one it hangs on, where it ends against its start, and the joint that turns it (-1: none)."""

    name: str
    parent: str
    along: np.ndarray
    joint: int


def write_acclaim(path: Path, motion: Mocap) -> None:
    """Write `path` (.amc) and the skeleton of the same name (.asf); degrees, lengths in 1/0.45 inch; each complete.

    Every joint but the root becomes a bone of its name with axes along the world and three degrees of freedom. Where
    what hangs on a joint starts at several places, fixed bones JOINT_to_CHILD lead there.

    Raises ValueError unless joint 0 is the only root, with parents before children.
    """
    skeleton = motion.skeleton
    parents, names = (
        np.asarray(skeleton.parents),
        [str(n).replace(" ", "_") for n in np.asarray(skeleton.names)],
    )
    if parents[0] >= 0 or (parents[1:] < 0).any() or (parents >= np.arange(len(parents))).any():
        raise ValueError(
            f"{path}: a skeleton needs joint 0 as its only root (-1) and parents before children, got {parents.tolist()}"
        )
    bones = _bones(names, parents, np.asarray(motion.offset, np.float64))
    with beside(path.with_suffix(".asf")) as draft:
        draft.write_text(
            "\r\n".join(_skeleton_lines(path.stem, bones)) + "\r\n", encoding="ascii", errors="replace"
        )
    local = local_turns(parents, np.asarray(motion.rotation, np.float64))
    # E = Rz Ry Rx, written x y z
    angles = Rotation.from_matrix(local.reshape(-1, 3, 3)).as_euler("ZYX", degrees=True)[:, ::-1]
    angles = angles.reshape(*local.shape[:2], 3)
    roots = np.asarray(skeleton.joints, np.float64)[:, 0] * _PER_METRE
    lines = ["#!OML:ASF", ":FULLY-SPECIFIED", ":DEGREES"]
    for frame in range(len(roots)):
        lines += [str(frame + 1), _values("root", [*roots[frame], *angles[frame, 0]])]
        lines += [_values(bone.name, angles[frame, bone.joint]) for bone in bones if bone.joint >= 0]
    with beside(path) as draft:
        draft.write_text("\r\n".join(lines) + "\r\n", encoding="ascii", errors="replace")


def _bones(names: list[str], parents: np.ndarray, offset: np.ndarray) -> list[_Bone]:
    children: list[list[int]] = [[] for _ in names]
    for joint, parent in enumerate(parents[1:], 1):
        children[parent].append(joint)
    found: list[_Bone] = []
    starts = {0: "root"}
    for joint in range(len(names)):
        last = joint > 0 and not children[joint] and names[joint].endswith("_end")
        if last and joint not in starts:
            continue
        name = starts.pop(joint) if joint == 0 else names[joint]
        below = children[joint]
        same = (
            joint > 0
            and bool(below)
            and all(np.allclose(offset[c], offset[below[0]], atol=_NONE) for c in below)
        )
        if joint > 0 and not last:
            along = offset[below[0]] if same else np.zeros(3)
            found.append(_Bone(name, starts.pop(joint), along, joint))
        for child in below:
            if same or np.abs(offset[child]).max() <= _NONE:
                if not (same and names[child].endswith("_end") and not children[child]):
                    starts[child] = name
            else:
                fixed = f"{name}_to_{names[child]}"
                found.append(_Bone(fixed, name, offset[child], -1))
                if children[child] or not names[child].endswith("_end"):
                    starts[child] = fixed
    return found


def _skeleton_lines(title: str, bones: list[_Bone]) -> list[str]:
    lines = [":version 1.10", f":name {title.replace(' ', '_')}", ":units", "  mass 1.0"]
    lines += [f"  length {_LENGTH}", "  angle deg", ":root", "  order TX TY TZ RX RY RZ", "  axis XYZ"]
    lines += ["  position 0 0 0", "  orientation 0 0 0", ":bonedata"]
    for number, bone in enumerate(bones, 1):
        length = float(np.linalg.norm(bone.along))
        direction = bone.along / length if length > _NONE else np.array([0.0, 1.0, 0.0])
        lines += ["  begin", f"    id {number}", f"    name {bone.name}", _values("    direction", direction)]
        lines += [f"    length {length * _PER_METRE:.9g}", "    axis 0 0 0 XYZ"]
        lines += ["    dof rx ry rz"] * (bone.joint >= 0) + ["  end"]
    lines += [":hierarchy", "  begin"]
    for parent in ("root", *(bone.name for bone in bones)):
        below = [bone.name for bone in bones if bone.parent == parent]
        lines += [f"    {' '.join([parent, *below])}"] if below else []
    return [*lines, "  end"]


def _values(name: str, numbers: object) -> str:
    return " ".join([name, *(f"{value:.9g}" for value in np.asarray(numbers, np.float64))])
