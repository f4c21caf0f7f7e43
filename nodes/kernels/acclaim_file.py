"""Reading Acclaim motion capture: a skeleton (ASF) and its motion (AMC)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.articulation import Articulation, euler

_INCH = 0.0254
_DOF = ("rx", "ry", "rz")


class Bone(NamedTuple):
    """A bone of an ASF: where it points at rest (in the world), its length, its axes (C) and what may turn."""

    name: str
    direction: np.ndarray
    length: float
    axes: np.ndarray
    dof: tuple[str, ...]


class AcclaimSkeleton(NamedTuple):
    """An ASF: bones by name, the parent of each (root: none), the order of the root's values, metres per unit."""

    bones: dict[str, Bone]
    parent: dict[str, str]
    root_order: tuple[str, ...]
    root_axes: np.ndarray
    degrees: bool
    metres: float


def parse_asf(text: str) -> AcclaimSkeleton:
    """The skeleton of an ASF file; a length unit u means that values are u-ths of an inch.

    Axis orders are applied from the left: XYZ turns about x first, R = Rz Ry Rx.
    Raises ValueError where sections are missing or a bone hangs on nothing.
    Source: Lander 1998, Game Developer (Acclaim's format); units as the CMU database uses them.
    """
    sections = _sections(text)
    missing = [name for name in ("root", "bonedata", "hierarchy") if name not in sections]
    if missing:
        raise ValueError(f"an ASF file must have the section :{missing[0]}, it has :{' :'.join(sections)}")
    units = {words[0]: words[1] for words in sections.get("units", []) if len(words) > 1}
    degrees = units.get("angle", "deg").startswith("deg")
    root = {words[0]: words[1:] for words in sections["root"]}
    bones = {bone.name: bone for bone in _bones(sections["bonedata"], degrees)}
    parent = {
        child: words[0] for words in sections["hierarchy"] for child in words[1:] if words[0] != "begin"
    }
    for name in bones:
        if parent.get(name) not in (*bones, "root"):
            raise ValueError(f"bone {name!r} must hang on root or another bone, got {parent.get(name)!r}")
    return AcclaimSkeleton(
        bones, parent, tuple(word.lower() for word in root["order"]),
        _turn(root.get("orientation", ["0", "0", "0"]), root.get("axis", ["XYZ"])[0], degrees),
        degrees, _INCH / float(units.get("length", "1")),
    )  # fmt: skip


def parse_amc(text: str, skeleton: AcclaimSkeleton) -> Articulation:
    """The motion of an AMC file on its skeleton, in metres.

        turn = parent's turn . C E(values) C^T,  E(a) = Rz Ry Rx,   next joint = joint + turn (direction length)

    A joint stands where its bone begins and carries its name; the end of a last bone is `BONE_end`.
    Raises ValueError where a frame names a bone that is not there or has another number of values.
    """
    order = _ordered(skeleton)
    values = _frames(text, skeleton)
    scale = np.pi / 180.0 if skeleton.degrees else 1.0
    count = len(values["root"])
    names, parents, offset = ["root"], [-1], [np.zeros(3)]
    move = {axis: values["root"][:, k] for k, axis in enumerate(skeleton.root_order)}
    still = np.zeros(count)
    root = np.stack([move.get(f"t{axis}", still) for axis in "xyz"], axis=1)
    angles = np.stack([move.get(axis, still) for axis in reversed(_DOF)], axis=1)
    c = skeleton.root_axes
    turns = [c @ euler(angles * scale, "ZYX") @ c.T]
    for name in order:
        bone, above = skeleton.bones[name], skeleton.parent[name]
        parents.append(names.index(above))
        names.append(name)
        offset.append(np.zeros(3) if above == "root" else _along(skeleton.bones[above]))
        columns = [bone.dof.index(axis) if axis in bone.dof else -1 for axis in reversed(_DOF)]
        turned = values.get(name, np.zeros((count, len(bone.dof))))
        padded = np.concatenate([turned, np.zeros((count, 1))], axis=1)
        local = bone.axes @ euler(padded[:, columns] * scale, "ZYX") @ bone.axes.T
        turns.append(turns[parents[-1]] @ local)
    for name in order:
        if name not in skeleton.parent.values():
            parents.append(names.index(name))
            names.append(f"{name}_end")
            offset.append(_along(skeleton.bones[name]))
            turns.append(turns[parents[-1]])
    metres = skeleton.metres
    return Articulation(
        names, np.array(parents, np.int32), np.array(offset) * metres, root * metres, np.stack(turns, axis=1)
    )


def _along(bone: Bone) -> np.ndarray:
    return bone.direction / np.linalg.norm(bone.direction) * bone.length


def _sections(text: str) -> dict[str, list[list[str]]]:
    """The words of each line of each `:section`; what follows its name is its first line."""
    sections: dict[str, list[list[str]]] = {}
    here: list[list[str]] = []
    for line in text.splitlines():
        words = line.replace("(", " ").replace(")", " ").split()
        if not words or words[0].startswith("#"):
            continue
        if words[0].startswith(":"):
            here = sections.setdefault(words[0][1:].lower(), [])
            words = words[1:]
        if words:
            here.append(words)
    return sections


def _bones(lines: list[list[str]], degrees: bool) -> list[Bone]:
    found: list[Bone] = []
    entry: dict[str, list[str]] = {}
    for words in lines:
        if words[0] == "begin":
            entry = {}
        elif words[0] == "end":
            axes = _turn(entry["axis"][:3], entry["axis"][3] if len(entry["axis"]) > 3 else "XYZ", degrees)
            dof = tuple(word.lower() for word in entry.get("dof", []) if word.lower() in _DOF)
            found.append(
                Bone(
                    entry["name"][0],
                    np.array(entry["direction"][:3], np.float64),
                    float(entry["length"][0]),
                    axes,
                    dof,
                )
            )
        else:
            entry[words[0]] = words[1:]
    return found


def _turn(angles: list[str], order: str, degrees: bool) -> np.ndarray:
    values = np.array(angles[:3], np.float64) * (np.pi / 180.0 if degrees else 1.0)
    order = order.upper()[::-1]
    return euler(values[["XYZ".index(axis) for axis in order]], order)


def _ordered(skeleton: AcclaimSkeleton) -> list[str]:
    """Bones, parents before children."""
    order: list[str] = []
    waiting = list(skeleton.bones)
    while waiting:
        ready = [name for name in waiting if skeleton.parent[name] in ("root", *order)]
        if not ready:
            raise ValueError(f"bones {', '.join(waiting)} must hang on the root, they hang on each other")
        order += ready
        waiting = [name for name in waiting if name not in ready]
    return order


def _frames(text: str, skeleton: AcclaimSkeleton) -> dict[str, np.ndarray]:
    widths = {"root": len(skeleton.root_order), **{n: len(b.dof) for n, b in skeleton.bones.items()}}
    rows: dict[str, list[list[str]]] = {}
    frames = 0
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split()
        if not words or words[0][0] in "#:":
            continue
        if len(words) == 1 and words[0].isdigit():
            frames += 1
            continue
        if widths.get(words[0]) != len(words) - 1:
            raise ValueError(
                f"line {number}: {words[0]!r} must be a bone with {widths.get(words[0], 0)} values, got {len(words) - 1}: "
                f"is this the skeleton of the motion?"
            )
        rows.setdefault(words[0], []).append(words[1:])
    if not frames or any(len(values) != frames for values in rows.values()) or "root" not in rows:
        raise ValueError("every frame must give the root and the same bones: the file is empty or cut short")
    return {name: np.array(values, np.float64) for name, values in rows.items()}
