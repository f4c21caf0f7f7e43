"""What the engine and its workers say to each other: batches of items, and what came of them. No arrays among it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from reperform.nodes.catalogue import FieldSpec


@dataclass(frozen=True)
class Feed:
    """What a port gets: manifests by label, and whether they are cut by frame and camera.

    many: one, pair, dataset or pairs (labels of pairs are `a/b`).
    """

    port: str
    many: str
    kind: tuple[str, str]
    fields: Mapping[str, FieldSpec]
    part: str
    manifests: tuple[tuple[str, str], ...]
    by_frame: bool = False
    by_camera: bool = False


@dataclass(frozen=True)
class Item:
    """One call: its frame and camera where it is cut, and the frames of its window."""

    frame: int | None = None
    camera: int | None = None
    window: tuple[int, int] | None = None


@dataclass(frozen=True)
class Batch:
    """Items of one unit that are computed together and stored as one segment."""

    url: str
    node: str
    function: tuple[str, str]
    over: str
    output: tuple[str, str]
    fields: Mapping[str, FieldSpec]
    # labels of the outputs of a node that returns one product per take
    outputs: tuple[str, ...] | None
    parameters: Mapping[str, Any]
    feeds: tuple[Feed, ...]
    items: tuple[Item, ...]
    threads: int = 1


@dataclass
class ItemOutcome:
    """What came of one item: digests of its fields, or an error."""

    tables: bytes = b""
    seconds: float = 0.0
    error: str | None = None
    trace: str | None = None
    row: int = 0
    segment: int = 0


@dataclass
class Outcome:
    """What came of a batch: segments written (name, bytes, stamp) and the outcome of every item (or output)."""

    items: list[ItemOutcome] = field(default_factory=list)
    segments: list[tuple[str, int, str]] = field(default_factory=list)
    damaged: tuple[str, tuple[int, ...] | None, str] | None = None
    store_error: str | None = None
