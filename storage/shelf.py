"""The shelf: where segments and manifests lie. Workers read and write here and never see the index.

A segment is written beside and renamed on a file system; on an object store it is simply not named by the index until
all of it is there.
"""

from __future__ import annotations

import errno
import functools
import os
import shutil
import sys
import uuid
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reperform.storage.errors import DamagedResult, StoreError

if TYPE_CHECKING:
    import numpy as np

SEGMENTS, MANIFESTS = "segments", "manifests"


class Shelf:
    """Segments and manifests under one URL: a local folder, or anything fsspec opens."""

    def __init__(self, url: str) -> None:
        self.url = url
        self.folder: Path | None = None if is_remote(url) else Path(url)

    def prepare(self) -> None:
        """Make the folders of a local shelf."""
        if self.folder is not None:
            (self.folder / SEGMENTS).mkdir(parents=True, exist_ok=True)
            (self.folder / MANIFESTS).mkdir(exist_ok=True)

    @functools.cached_property
    def filesystem(self) -> tuple[Any, str]:
        """The fsspec file system and the path of the store in it."""
        import fsspec

        # listings must show what other machines wrote a moment ago
        fs, root = fsspec.core.url_to_fs(self.url, use_listings_cache=False)
        return fs, root.rstrip("/")

    @functools.cached_property
    def segments(self) -> Any:
        """What holds all segments: a folder, or a zarr store elsewhere."""
        if self.folder is not None:
            return self.folder / SEGMENTS
        from zarr.storage import FsspecStore

        return FsspecStore.from_url(f"{self.url.rstrip('/')}/{SEGMENTS}")

    def write_segment(
        self, node: str, fields: Mapping[str, np.ndarray | Sequence[np.ndarray]], by_item: bool = False
    ) -> tuple[str, int, str]:
        """Write a segment whole or not at all. Returns its name, bytes before compression, and its stamp."""
        from reperform.storage.segment import write_segment

        name = f"{node}/{uuid.uuid4().hex}"
        if self.folder is None:
            try:
                return name, write_segment(self.segments, name, fields, by_item), ""
            except failures() as error:
                raise _explained(error, self.url) from error
        beside = f".writing-{uuid.uuid4().hex}"
        place = self.folder / SEGMENTS
        try:
            size = write_segment(self.segments, beside, fields, by_item)
            (place / node).mkdir(parents=True, exist_ok=True)
            os.rename(place / beside, place / name)
        except OSError as error:
            shutil.rmtree(place / beside, ignore_errors=True)
            raise _explained(error, self.url) from error
        return name, size, self.stamp(name)

    def reader(self, name: str) -> Any:
        """The reader of a segment (kept open: segments never change)."""
        return _open_reader(self.url, name)

    def stamp(self, name: str) -> str:
        """Number, bytes and newest change time of a segment's files; empty on object stores, which check themselves."""
        if self.folder is None:
            return ""
        count = size = newest = 0
        stack = [os.path.join(self.folder, SEGMENTS, name)]
        while stack:
            try:
                with os.scandir(stack.pop()) as entries:
                    for entry in entries:
                        if entry.is_dir(follow_symlinks=False):
                            stack.append(entry.path)
                            continue
                        state = entry.stat(follow_symlinks=False)
                        count, size, newest = count + 1, size + state.st_size, max(newest, state.st_mtime_ns)
            except FileNotFoundError:
                return "gone"
        return f"{count}/{size}/{newest}"

    def write_manifest(self, name: str, data: bytes) -> None:
        """Store the bytes of a manifest."""
        if self.folder is None:
            fs, root = self.filesystem
            try:
                fs.makedirs(f"{root}/{MANIFESTS}", exist_ok=True)
                fs.pipe_file(f"{root}/{MANIFESTS}/{name}", data)
            except failures() as error:
                raise _explained(error, self.url) from error
            return
        path = self.folder / MANIFESTS / name
        beside = path.with_name(f".writing-{uuid.uuid4().hex}")
        try:
            beside.write_bytes(data)
            os.replace(beside, path)
        except OSError as error:
            beside.unlink(missing_ok=True)
            raise _explained(error, self.url) from error

    def read_manifest(self, name: str) -> bytes:
        """The bytes of a manifest. Raises DamagedResult where it is gone."""
        try:
            if self.folder is None:
                fs, root = self.filesystem
                return bytes(fs.cat_file(f"{root}/{MANIFESTS}/{name}"))
            return (self.folder / MANIFESTS / name).read_bytes()
        except FileNotFoundError as error:
            raise DamagedResult(f"{MANIFESTS}/{name}", None, "the manifest is gone") from error

    def has_manifest(self, name: str) -> bool:
        """Whether a manifest lies here (object stores are trusted; a read notices)."""
        return self.folder is None or (self.folder / MANIFESTS / name).exists()

    def remove(self, kind: str, name: str) -> None:
        """Delete a segment or a manifest."""
        if self.folder is None:
            fs, root = self.filesystem
            if fs.exists(f"{root}/{kind}/{name}"):
                fs.rm(f"{root}/{kind}/{name}", recursive=True)
            return
        path = self.folder / kind / name
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)

    def changed(self, kind: str, name: str) -> float:
        """When a segment or manifest was last written."""
        if self.folder is None:
            fs, root = self.filesystem
            files = fs.find(f"{root}/{kind}/{name}")
            return max((fs.modified(path).timestamp() for path in files), default=0.0)
        return (self.folder / kind / name).stat().st_mtime

    def copy_to(self, other: Shelf, kind: str, name: str) -> None:
        """Copy a segment or a manifest to another shelf, file by file."""
        here, root = self.filesystem
        there, base = other.filesystem
        for path in here.find(f"{root}/{kind}/{name}"):
            target = f"{base}{path[len(root) :]}"
            there.makedirs(target.rpartition("/")[0], exist_ok=True)
            there.pipe_file(target, here.cat_file(path))

    def names(self, kind: str) -> list[str]:
        """Names of all segments (or manifests) that lie here, unfinished ones too."""
        if self.folder is None:
            fs, root = self.filesystem
            base = f"{root}/{kind}/"
            found = {path.split(base, 1)[1] for path in fs.find(base)} if fs.exists(base) else set()
            return sorted({"/".join(f.split("/")[:2]) for f in found} if kind == SEGMENTS else found)
        place = self.folder / kind
        if kind == MANIFESTS:
            return sorted(path.name for path in place.iterdir())
        nodes = [path for path in place.iterdir() if path.is_dir()]
        unfinished = [path.name for path in nodes if path.name.startswith(".")]
        return sorted(
            unfinished
            + [f"{n.name}/{p.name}" for n in nodes if not n.name.startswith(".") for p in n.iterdir()]
        )


def is_remote(url: str) -> bool:
    """Whether a store's URL names something else than a local folder."""
    return "://" in url


@functools.lru_cache(maxsize=256)
def _open_reader(url: str, name: str) -> Any:
    from reperform.storage.segment import SegmentReader

    return SegmentReader(open_shelf(url).segments, name)


@functools.lru_cache(maxsize=8)
def open_shelf(url: str) -> Shelf:
    """The shelf at a URL, one per process."""
    return Shelf(url)


def forget_open_files() -> None:
    """Drop readers kept open: needed only after stored files were changed behind our back."""
    _open_reader.cache_clear()


def failures() -> tuple[type[Exception], ...]:
    """What a file system or an object store raises where it cannot be reached or written."""
    botocore = sys.modules.get("botocore.exceptions")
    return (OSError, botocore.BotoCoreError, botocore.ClientError) if botocore else (OSError,)


def cannot_open(error: Exception, url: str) -> StoreError:
    """The error of a store that does not open."""
    reason = getattr(error, "strerror", None) or str(error)
    cure = (
        "check the URL, the network and the credentials"
        if is_remote(url)
        else "check the path and its permissions"
    )
    return StoreError(
        getattr(error, "errno", None) or errno.EIO, f"store {url}: cannot open: {reason}: {cure}"
    )


def _explained(error: Exception, url: str) -> StoreError:
    number = getattr(error, "errno", None) or errno.EIO
    cure = {
        errno.ENOSPC: "the disk is full: free space or run `reperform store gc`, then run again; finished items are kept",
        errno.EDQUOT: "the disk quota is used up: free space, then run again; finished items are kept",
        errno.EFBIG: "a file grew past the limit of this process: raise it, then run again; finished items are kept",
        errno.EACCES: "no permission to write there: choose another place with --store",
        errno.EROFS: "the file system is read-only: choose another place with --store",
    }.get(number, "finished items are kept; mend the cause, then run again")
    reason = getattr(error, "strerror", None) or str(error)
    return StoreError(number, f"store {url}: cannot write: {reason}: {cure}")
