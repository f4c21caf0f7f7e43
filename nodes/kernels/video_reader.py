"""Single pictures out of video files: counted without decoding, read by exact frame number."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import av
import numpy as np

# How far ahead decoding on is preferred to seeking, in frames.
_STEP_AHEAD = 48
_OPEN_PER_THREAD = 12
# MPEG-4 part 2 in AVI: encoders put one byte where the packet before holds two pictures.
_PLACEHOLDER_BYTES = 1


class VideoFacts(NamedTuple):
    """What the container says about a video."""

    frames: int
    promised: int
    width: int
    height: int
    rate: Fraction
    # presentation times in the order of pictures; empty where the container cannot tell
    times: tuple[int, ...]


def inspect(path: str) -> VideoFacts:
    """Count the pictures of a video by its packets; nothing is decoded.

    Raises ValueError where the file cannot be read as a video.
    """
    try:
        with av.open(path) as container:
            stream = _video_stream(container, path)
            return _facts(container, stream)
    except av.error.FFmpegError as error:
        raise ValueError(f"{path}: not a readable video ({error.strerror}): is it complete?") from error


def read_video_picture(path: str, index: int) -> np.ndarray:
    """Picture `index` (from 0) of a video, RGB (y, x, 3) uint8.

    Each thread keeps its last decoders open, so that consecutive pictures are decoded once each.
    Raises ValueError naming file and picture where it does not exist or is damaged.
    """
    try:
        return _reader(path).read(index)
    except (av.error.FFmpegError, EOFError) as error:
        _forget(path)
        raise ValueError(f"{path}: picture {index} cannot be decoded ({error})") from error


class _Reader:
    """An open decoder and the number of the picture that comes next."""

    def __init__(self, path: str) -> None:
        self.path = path
        facts = inspect(path)
        self.times = facts.times
        self.container = av.open(path)
        self.pictures = self._start()
        self.next = 0

    def read(self, index: int) -> np.ndarray:
        frame = None
        if not self.next <= index < self.next + _STEP_AHEAD:
            frame = self._seek(index)
        while frame is None or self.next <= index:
            frame = next(self.pictures, None)
            if frame is None:
                count, self.next = self.next, 1 << 62
                raise EOFError(f"the video ends after {count} pictures")
            self.next += 1
        return frame.to_ndarray(format="rgb24")

    def _start(self) -> Iterator[av.VideoFrame]:
        stream = _video_stream(self.container, self.path)
        # one thread: the engine runs as many views at once as there are cores
        stream.thread_type = "NONE"
        return self.container.decode(stream)

    def _seek(self, index: int) -> av.VideoFrame | None:
        """Jump to the key frame before and decode up to the picture; where times mislead, start over."""
        if index < len(self.times) and index >= _STEP_AHEAD:
            stream = self.container.streams.video[0]
            self.container.seek(self.times[index], stream=stream, backward=True)
            for frame in self.container.decode(stream):
                if frame.pts == self.times[index]:
                    self.pictures, self.next = self.container.decode(stream), index + 1
                    return frame
                if frame.pts is None or frame.pts > self.times[index]:
                    break
        self.container.close()
        self.container = av.open(self.path)
        self.pictures, self.next = self._start(), 0
        return None


_open = threading.local()


def _reader(path: str) -> _Reader:
    readers: OrderedDict[tuple[str, int, int], _Reader] = _open.__dict__.setdefault("readers", OrderedDict())
    status = Path(path).stat()
    key = (path, status.st_mtime_ns, status.st_size)
    reader = readers.pop(key, None) or _Reader(path)
    readers[key] = reader
    while len(readers) > _OPEN_PER_THREAD:
        readers.popitem(last=False)[1].container.close()
    return reader


def _forget(path: str) -> None:
    readers = _open.__dict__.get("readers", {})
    for key in [key for key in readers if key[0] == path]:
        readers.pop(key).container.close()


def _video_stream(container: av.container.InputContainer, path: str) -> av.VideoStream:
    if not container.streams.video:
        raise ValueError(f"{path}: holds no video stream")
    return container.streams.video[0]


def _facts(container: av.container.InputContainer, stream: av.VideoStream) -> VideoFacts:
    placeholder = _PLACEHOLDER_BYTES if stream.codec_context.name == "mpeg4" else 0
    sizes, stamps = [], []
    for packet in container.demux(stream):
        sizes.append(packet.size)
        stamps.append(packet.pts)
    # the last, empty packet only says that the end is reached
    times = [stamp for stamp, size in zip(stamps, sizes, strict=True) if size > placeholder]
    # AVI stores no presentation times: with reordered pictures those it reports are guesses.
    guessed = "avi" in container.format.name and stream.codec_context.has_b_frames
    told = not guessed and None not in times and len(set(times)) == len(times)
    return VideoFacts(
        frames=len(times),
        promised=stream.frames - sum(0 < size <= placeholder for size in sizes),
        width=stream.codec_context.width,
        height=stream.codec_context.height,
        rate=Fraction(stream.average_rate or stream.guessed_rate or 0),
        times=tuple(sorted(times)) if told else (),
    )
