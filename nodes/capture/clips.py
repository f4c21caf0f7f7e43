"""Index the footage of a take without decoding it."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import blake2b
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from PIL import Image, UnidentifiedImageError

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.file_pattern import match_files
from reperform.nodes.kernels.video_reader import inspect
from reperform.nodes.products.clips import Clips

_VIDEO = {".avi", ".mp4", ".mov", ".mkv", ".webm", ".m4v", ".mpg", ".mpeg", ".mxf", ".ts", ".wmv"}
_IMAGE_RATE = 25.0


class _Strip(NamedTuple):
    """One camera's pictures: file, index in it, digest and frame number of each; their size and rate."""

    files: list[str]
    indices: list[int]
    digests: list[str]
    numbers: list[int]
    size: tuple[int, int]
    rate: float


@node(over="take")
def clips(
    *,
    folder: Annotated[str, File("folder with the pictures or videos of all cameras")],
    pattern: Annotated[str, Param(about="file names: {camera}, {frame}, * and ?")] = "cam{camera}/video.avi",
    cameras: Annotated[list[str], Param(about="cameras to take, in this order; empty: all")] = [],  # noqa: B006
    first: Annotated[int, Param("frame", 0, None, "first frame to take")] = 0,
    count: Annotated[int, Param("frame", 0, None, "frames to take; 0: all, alike for all cameras")] = 0,
    step: Annotated[int, Param("frame", 1, None, "take every step-th frame")] = 1,
    fps: Annotated[float, Param("Hz", 0, 1000, "recorded rate; 0: the videos', 25 for images")] = 0.0,
) -> Clips:
    """Where every picture of a take lies: file, index in it and a digest of its content; nothing is decoded.

    `pattern` names the files below `folder`: `cam{camera}.png` (one image per camera: one frame),
    `{camera}/{frame}.png` (numbered images), `{camera}/*.png` (images in natural order of name) or
    `cam{camera}/video.avi` (a video per camera). Cameras are named by what `{camera}` matched, in natural order.
    Frames first, first + step, ... are taken; `fps` of the product is the recorded rate / step.

    Raises ValueError for a missing camera, an unreadable or truncated file, and for counts, frame numbers, sizes or
    rates that differ between cameras.

    Source: reading of files; no published method.
    """
    matched = match_files(Path(folder), pattern)
    if not matched:
        raise ValueError(
            f"clips: no file below {folder} matches pattern {pattern!r}: check folder and pattern "
            "({camera} and {frame} stand for names and numbers)"
        )
    names = list(cameras) or list(matched)
    missing = [name for name in names if name not in matched]
    if missing:
        raise ValueError(
            f"clips: camera {', '.join(missing)} has no file that matches {pattern!r} in {folder}; "
            f"found cameras {', '.join(matched)}"
        )
    strips = [_strip(Path(folder), name, matched[name]) for name in names]
    _refuse_different(names, strips, count > 0)
    wanted = _wanted(names, strips, first, count, step)
    rate = (fps or strips[0].rate) / step
    return Clips(
        file=np.array([[strip.files[k] for strip in strips] for k in wanted], dtype=str),
        position=np.array([[strip.indices[k] for strip in strips] for k in wanted], np.int32),
        digest=np.array([[strip.digests[k] for strip in strips] for k in wanted], dtype=str),
        image_size=np.array([strip.size for strip in strips], np.int32),
        name=np.array(names, dtype=str),
        fps=np.asarray(rate, np.float32),
    )


def _strip(folder: Path, camera: str, files: Sequence[tuple[int, str]]) -> _Strip:
    videos = [name for _, name in files if Path(name).suffix.lower() in _VIDEO]
    if not videos:
        return _image_strip(folder, files)
    if len(files) > 1:
        raise ValueError(
            f"clips: camera {camera} has {len(files)} files ({files[0][1]}, {files[1][1]}, ...) of which "
            f"{len(videos)} are videos: a camera is one video or many images, narrow the pattern"
        )
    return _video_strip(folder, videos[0])


def _image_strip(folder: Path, files: Sequence[tuple[int, str]]) -> _Strip:
    sizes = {}
    for _, name in files:
        try:
            with Image.open(folder / name) as image:
                sizes[name] = image.size
        except (UnidentifiedImageError, OSError) as error:
            raise ValueError(f"clips: {folder / name} is not a readable image: replace it") from error
    odd = next((name for name in sizes if sizes[name] != sizes[files[0][1]]), None)
    if odd is not None:
        raise ValueError(
            f"clips: images of one camera must have one size, got {_by(sizes[files[0][1]])} in {files[0][1]} "
            f"and {_by(sizes[odd])} in {odd}"
        )
    return _Strip(
        files=[name for _, name in files],
        indices=[0] * len(files),
        digests=[_digest((folder / name).read_bytes()) for _, name in files],
        numbers=[number for number, _ in files],
        size=sizes[files[0][1]],
        rate=_IMAGE_RATE,
    )


def _video_strip(folder: Path, name: str) -> _Strip:
    facts = inspect(str(folder / name))
    if facts.frames == 0 or facts.frames < facts.promised:
        raise ValueError(
            f"clips: video {folder / name} is truncated: its header promises {facts.promised} frames, "
            f"{facts.frames} are there; copy it again"
        )
    with open(folder / name, "rb") as stream:
        whole = _digest_stream(stream)
    return _Strip(
        files=[name] * facts.frames,
        indices=list(range(facts.frames)),
        digests=[_digest(f"{whole}:{k}".encode()) for k in range(facts.frames)],
        numbers=list(range(facts.frames)),
        size=(facts.width, facts.height),
        rate=float(facts.rate) or _IMAGE_RATE,
    )


def _refuse_different(names: Sequence[str], strips: Sequence[_Strip], count_given: bool) -> None:
    counts = [len(strip.files) for strip in strips]
    if len(set(counts)) > 1 and not count_given:
        listing = ", ".join(f"{name}: {n}" for name, n in zip(names, counts, strict=True))
        raise ValueError(
            f"clips: cameras must have equally many frames, got {listing}: set count (at most {min(counts)}) if the "
            "first frames are simultaneous"
        )
    for name, strip in zip(names, strips, strict=True):
        if strip.size != strips[0].size:
            raise ValueError(
                f"clips: cameras must have one picture size, got {_by(strips[0].size)} px in camera {names[0]} and "
                f"{_by(strip.size)} px in camera {name}: scale pictures and calibration, or leave a camera out"
            )
        if abs(strip.rate - strips[0].rate) > 1e-3 * strips[0].rate:
            raise ValueError(
                f"clips: cameras must have one frame rate, got {strips[0].rate:g} Hz in camera {names[0]} and "
                f"{strip.rate:g} Hz in camera {name}"
            )


def _wanted(names: Sequence[str], strips: Sequence[_Strip], first: int, count: int, step: int) -> list[int]:
    available = [len(strip.files) for strip in strips]
    last = first + (count - 1) * step if count else min(available) - 1
    for name, n in zip(names, available, strict=True):
        if last >= n or first >= n:
            raise ValueError(
                f"clips: frames {first} .. {max(last, first)} are asked for, camera {name} has {n}: lower first, "
                "count or step"
            )
    wanted = list(range(first, last + 1, step))
    for k in wanted:
        numbers = {name: strip.numbers[k] for name, strip in zip(names, strips, strict=True)}
        if len(set(numbers.values())) > 1:
            low = min(numbers, key=lambda name: numbers[name])
            high = max(numbers, key=lambda name: numbers[name])
            raise ValueError(
                f"clips: frame {numbers[low]} is there for camera {low} but not for camera {high} (its next is "
                f"{numbers[high]}): add or remove the file; where numbers have no meaning write * for {{frame}}"
            )
    return wanted


def _digest(content: bytes) -> str:
    return blake2b(content, digest_size=16).hexdigest()


def _digest_stream(stream: object) -> str:
    digest = blake2b(digest_size=16)
    while block := stream.read(1 << 20):  # type: ignore[attr-defined]
        digest.update(block)
    return digest.hexdigest()


def _by(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"
