"""Units of work: one output of a step, what is known of it, and what is still to be computed."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from reperform.graphs.messages import Batch, Feed, Item
from reperform.graphs.pipeline import Step
from reperform.nodes.catalogue import ProductSpec
from reperform.storage.index import Manifest, Result

Name = tuple[str, str]  # step, unit


@dataclass
class Unit:
    """One output of a step during a run (label `*`: all outputs of a node that returns one product per take).

    status: waiting (for `missing`), open (items to compute), done, failed, skipped.
    """

    step: Step
    label: str
    missing: set[Name] = field(default_factory=set)
    consumers: list[Name] = field(default_factory=list)
    status: str = "waiting"
    key: bytes = b""
    # by label: the unit's own, or one per take for a node that returns a dataset
    manifests: dict[str, Manifest] = field(default_factory=dict)
    parts: dict[str, Any] = field(default_factory=dict)
    reasons: list[str] = field(default_factory=list)
    work: Work | None = None
    computed: int = 0
    cached: int = 0
    failed: int = 0
    seconds: float = 0.0
    errors: list[str] = field(default_factory=list)
    # how many times damage sent it back; more than a few is a failing disk
    mended: int = 0

    @property
    def name(self) -> Name:
        """Step and label."""
        return self.step.name, self.label

    @property
    def item_text(self) -> str:
        """How commands call it: STEP or STEP/ITEM."""
        return f"{self.step.name}/{self.label}" if self.label not in ("", "*") else self.step.name


@dataclass
class Work:
    """The items of an open unit.

    layout: whole, frame or view.  lengths: along frame and camera.  outputs: labels, where one call gives a product
    per take (then the results are filed under `keys` in that order).
    """

    layout: str
    lengths: dict[str, int]
    items: list[Item]
    keys: list[bytes]
    feeds: tuple[Feed, ...]
    parameters: Mapping[str, Any]
    outputs: tuple[str, ...] | None = None
    results: dict[bytes, Result] = field(default_factory=dict)
    queue: deque[int] = field(default_factory=deque)
    # positions that another run is computing now
    elsewhere: deque[int] = field(default_factory=deque)
    running: int = 0
    failed: dict[int, str] = field(default_factory=dict)

    @property
    def is_over(self) -> bool:
        """Whether no item is left to compute, here or elsewhere."""
        return not self.queue and not self.elsewhere and self.running == 0


def batch_of(url: str, unit: Unit, work: Work, positions: Sequence[int], product: ProductSpec) -> Batch:
    """Some items of a unit as a batch for a worker."""
    node = unit.step.node
    return Batch(
        url,
        node.name,
        (node.module, node.function),
        node.over,
        (product.module, product.name.rsplit(".", 1)[1]),
        product.fields,
        work.outputs,
        work.parameters,
        work.feeds,
        tuple(work.items[k] for k in positions),
        node.threads,
    )
