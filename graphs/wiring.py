"""How steps are wired: references to steps, their parts and items, and an order in which all can run."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from reperform.graphs.document import Document
from reperform.graphs.errors import DefinitionError, Place, nearest
from reperform.graphs.matrix import variants

_REFERENCE = re.compile(
    r"^(?P<step>[A-Za-z_][\w-]*(?:\[[^\]]*\])?)(?:\.(?P<part>[\w.]+))?(?:/(?P<item>.+))?$"
)


@dataclass(frozen=True)
class Input:
    """What a port is wired to: a step, maybe a product inside its output, maybe one of its items.

    gather: instead of `step`, several steps by label: variants of a sweep, or a list.
    """

    step: str
    part: str = ""
    item: str | None = None
    gather: tuple[tuple[str, str], ...] = ()

    @property
    def steps(self) -> tuple[str, ...]:
        """All steps it stands on."""
        return tuple(name for _, name in self.gather) or (self.step,)


def wires(name: str, entry: Any, steps: Mapping[str, Any], document: Document) -> dict[str, Input]:
    """What every port of a step is wired to."""
    base, body, _ = entry
    return {
        port: reference(
            wired, steps, document.place("steps", base, "inputs", port), f"step {name!r}, input {port!r}"
        )
        for port, wired in (body.get("inputs") or {}).items()
    }


def reference(wired: Any, steps: Mapping[str, Any], place: Place, who: str) -> Input:
    """What `STEP`, `STEP.FIELD`, `STEP/ITEM`, `STEP[*]` or a list of steps stands for."""
    if isinstance(wired, list):
        return _several([reference(str(text), steps, place, who) for text in wired], place, who)
    text = str(wired)
    match = _REFERENCE.match(text)
    if not match:
        raise DefinitionError(f"{who}: expected STEP, STEP.FIELD or STEP/TAKE, got {text!r}", place)
    step, part, item = match["step"], match["part"] or "", match["item"]
    if step.endswith("[*]"):
        gathered = variants(step[:-3], list(steps))
        if gathered:
            return Input(step, part, item, tuple(gathered.items()))
    if step not in steps:
        raise DefinitionError(f"{who}: no step {step!r}: {nearest(step, steps)}", place)
    return Input(step, part, item)


def _several(inputs: Sequence[Input], place: Place, who: str) -> Input:
    """A list of steps as one dataset with their names as labels."""
    names = [wired.step for wired in inputs]
    if not names or any(wired.part or wired.item is not None or wired.gather for wired in inputs):
        raise DefinitionError(f"{who}: a list holds names of steps, without field or item", place)
    if len(set(names)) < len(names):
        raise DefinitionError(f"{who}: every step once, got {', '.join(names)}", place)
    return Input(names[0], gather=tuple((name, name) for name in names))


def in_order(document: Document, wires: Mapping[str, dict[str, Input]]) -> dict[str, dict[str, Input]]:
    """Steps so that each comes after what it stands on, else in the order of the file."""
    done: dict[str, dict[str, Input]] = {}

    def visit(name: str, above: tuple[str, ...]) -> None:
        if name in above:
            ring = " -> ".join((*above[above.index(name) :], name))
            raise DefinitionError(
                f"the steps form a cycle: {ring}", document.place("steps", name.partition("[")[0])
            )
        if name not in done:
            for wired in wires[name].values():
                for step in wired.steps:
                    visit(step, (*above, name))
            done[name] = wires[name]

    for name in wires:
        visit(name, ())
    return done
