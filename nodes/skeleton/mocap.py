"""Skeletal motion from a file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.acclaim_file import parse_amc, parse_asf
from reperform.nodes.kernels.articulation import Articulation, joint_positions, resampled
from reperform.nodes.kernels.bvh_file import parse_bvh
from reperform.nodes.products.mocap import Mocap
from reperform.nodes.products.performance import SkeletonSequence

_WHO = "skeleton.mocap"


@node(over="take")
def mocap(
    *,
    file: Annotated[str, File("motion: .bvh, or .amc beside the skeleton it belongs to")],
    skeleton: Annotated[str, File("the skeleton of an .amc: .asf")] = "",
    fps: Annotated[float, Param("Hz", 0.0, 1000.0, "frame rate of the take; 0: the recording's")] = 0.0,
    recorded: Annotated[
        float, Param("Hz", 1.0, 1000.0, "frame rate of an .amc, which does not tell")
    ] = 120.0,
    scale: Annotated[
        float,
        Param("m", 0.0, 1000.0, "metres per unit of the file; 0: metres in .bvh, what .asf says in .amc"),
    ] = 0.0,
    first: Annotated[float, Param("s", 0.0, 86400.0, "where the take begins")] = 0.0,
    seconds: Annotated[float, Param("s", 0.0, 86400.0, "length of the take; 0: to the end")] = 0.0,
) -> Mocap:
    """A take of motion capture: joints (T, J, 3), m, with the rotations and bones that carry them.

    Joints stand where bones begin, in the file's order; ends of last bones are joints `BONE_end`. Resampled roots
    are linear between frames, rotations against the parent take the shortest way, so that bones keep their lengths.

    Raises ValueError where a file cannot be read, an .amc has no .asf, or nothing is left of the take.
    Source: the formats of Biovision and Acclaim. Resampling: Shoemake 1985, SIGGRAPH (slerp).
    """
    motion, rate = _read(Path(file), skeleton, recorded, scale)
    start = round(first * rate)
    stop = len(motion.root) if seconds == 0 else min(len(motion.root), start + round(seconds * rate) + 1)
    if stop - start < 2:
        raise ValueError(
            f"{_WHO}: {Path(file).name} lasts {len(motion.root) / rate:.2f} s; a take from {first} s must lie within"
        )
    motion = motion._replace(root=motion.root[start:stop], turn=motion.turn[start:stop])
    if fps > 0 and fps != rate:
        motion, rate = resampled(motion, rate, fps), fps
    joints = joint_positions(motion.parents, motion.offset, motion.root, motion.turn)
    sequence = SkeletonSequence(
        joints.astype(np.float32), motion.parents, np.array(motion.names), np.array(rate, np.float32)
    )
    return Mocap(sequence, motion.turn.astype(np.float32), motion.offset.astype(np.float32))


def _read(path: Path, skeleton: str, recorded: float, scale: float) -> tuple[Articulation, float]:
    ending = path.suffix.lower()
    if ending not in (".bvh", ".amc") or (ending == ".amc" and not skeleton):
        raise ValueError(f"{_WHO}: {path.name} must be .bvh, or .amc with `skeleton` naming its .asf")
    try:
        if ending == ".bvh":
            motion, rate = parse_bvh(_text(path))
            metres = scale or 1.0
        else:
            bones = parse_asf(_text(Path(skeleton)))
            motion, rate = parse_amc(_text(path), bones), recorded
            metres = scale / bones.metres if scale else 1.0
    except (ValueError, KeyError, IndexError) as error:
        raise ValueError(f"{_WHO}: {path.name} cannot be read: {error}") from error
    return motion._replace(root=motion.root * metres, offset=motion.offset * metres), rate


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="latin-1")
    except OSError as error:
        raise ValueError(f"{path} cannot be opened: {error}") from error
