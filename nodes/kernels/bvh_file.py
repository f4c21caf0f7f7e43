"""Reading BVH: a hierarchy of joints with the channels that move them."""

from __future__ import annotations

import numpy as np

from reperform.nodes.kernels.articulation import Articulation, euler, world_turns


class _Joint:
    """What the hierarchy says of one joint."""

    def __init__(self, name: str, parent: int, end: bool = False) -> None:
        self.name, self.parent, self.end = name, parent, end
        self.offset = np.zeros(3)
        self.channels: list[str] = []


def parse_bvh(text: str) -> tuple[Articulation, float]:
    """The motion, lengths in the file's unit, and its frame rate (Hz).

    Rotations are multiplied in the order in which their channels are listed. The end of a bone becomes a joint
    `PARENT_end`, unless its offset is zero. A joint is placed by its channels only if it is the root.

    Raises ValueError where the text is not a whole BVH file; the message says what is wrong and in which line.
    Source: Biovision's format as described by Meredith and Maddock 2001.
    """
    lines = text.splitlines()
    joints, at = _hierarchy(lines)
    for number in range(at, len(lines)):
        words = lines[number].split()
        if words[:1] == ["Frames:"]:
            count = int(words[1])
        elif words[:2] == ["Frame", "Time:"]:
            step, at = float(words[2]), number + 1
            break
    else:
        raise ValueError("the MOTION block must give `Frames:` and `Frame Time:`, it does not")
    width = sum(len(joint.channels) for joint in joints)
    numbers = np.array(" ".join(lines[at:]).split(), np.float64)
    if len(numbers) != count * width or step <= 0:
        raise ValueError(
            f"the MOTION block must hold {count} frames of {width} channels and a positive frame time, got "
            f"{len(numbers)} numbers, {step} s: the file is cut short or damaged"
        )
    return _motion(joints, numbers.reshape(count, width)), 1.0 / step


def _hierarchy(lines: list[str]) -> tuple[list[_Joint], int]:
    joints: list[_Joint] = []
    stack: list[int] = []
    for number, line in enumerate(lines):
        words = line.split()
        if not words or words[0] in ("HIERARCHY", "{"):
            continue
        if words[0] in ("ROOT", "JOINT", "End"):
            parent = stack[-1] if stack else -1
            if (words[0] == "ROOT") != (parent < 0):
                raise ValueError(f"line {number + 1}: one ROOT must hold all joints, got {line.strip()!r}")
            name = f"{joints[parent].name}_end" if words[0] == "End" else "_".join(words[1:])
            joints.append(_Joint(name, parent, words[0] == "End"))
            stack.append(len(joints) - 1)
        elif words[0] == "OFFSET" and stack:
            joints[stack[-1]].offset = np.array(words[1:4], np.float64)
        elif words[0] == "CHANNELS" and stack:
            joints[stack[-1]].channels = words[2 : 2 + int(words[1])]
        elif words[0] == "}" and stack:
            stack.pop()
        elif words[0] == "MOTION" and joints and not stack:
            return joints, number + 1
        else:
            raise ValueError(f"line {number + 1}: not understood in the HIERARCHY: {line.strip()[:60]!r}")
    raise ValueError("a HIERARCHY of joints and a MOTION block must follow each other, they do not")


def _motion(joints: list[_Joint], rows: np.ndarray) -> Articulation:
    local = np.tile(np.eye(3), (len(rows), len(joints), 1, 1))
    root = np.tile(joints[0].offset, (len(rows), 1))
    column = 0
    for k, joint in enumerate(joints):
        turns, axes = [], ""
        for channel in joint.channels:
            axis, kind = channel[0].upper(), channel[1:].lower()
            if kind == "position" and k == 0:
                root[:, "XYZ".index(axis)] += rows[:, column]
            elif kind == "position" and np.ptp(rows[:, column]) > 1e-6:
                raise ValueError(
                    f"joint {joint.name} must keep its distance to its parent, channel {channel} moves it"
                )
            elif kind == "rotation":
                turns.append(column)
                axes += axis
            column += 1
        if axes:
            local[:, k] = euler(np.radians(rows[:, turns]), axes)
    kept = [k for k, joint in enumerate(joints) if not joint.end or np.abs(joint.offset).max() > 1e-9]
    number = {k: new for new, k in enumerate(kept)}
    parents = np.array([-1 if joints[k].parent < 0 else number[joints[k].parent] for k in kept], np.int32)
    offset = np.array([joints[k].offset for k in kept])
    offset[0] = 0.0
    return Articulation(
        [joints[k].name for k in kept], parents, offset, root, world_turns(parents, local[:, kept])
    )
