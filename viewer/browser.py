"""What the viewer needs to know of a pipeline's results, whatever keeps them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from reperform.nodes.product import is_product


class Browser(Protocol):
    """Steps, their items and products.

    Items are take names, `a/b` for pairs of takes, or "" where a step has one product. Products may have lazy
    fields: only what is shown is read.
    """

    @property
    def title(self) -> str:
        """The name of what is browsed, such as the pipeline's."""
        ...

    def steps(self) -> list[str]:
        """The steps in the order of the chain."""
        ...

    def items(self, step: str) -> list[str]:
        """The items of a step that can be shown; empty where nothing has been computed."""
        ...

    def product(self, step: str, item: str) -> Any:
        """The product of an item. Raises LookupError where it has not been computed."""
        ...

    def status(self, step: str) -> str:
        """`fresh`, `stale`, `failed`, `missing`, or "" where that is not known."""
        ...


class Results:
    """A browser over anything that gives, for a step, its product or a mapping item -> product.

    results: indexed by step (`results[step]`), such as a run or a dict. Keys of a mapping are take names or
    pairs of them.  steps: in the order to show them.  statuses: by step.
    """

    def __init__(
        self, results: Any, steps: Sequence[str], statuses: Mapping[str, str] | None = None, title: str = ""
    ) -> None:
        self._results, self._steps, self._title = results, list(steps), title
        self._statuses = dict(statuses or {})

    @property
    def title(self) -> str:
        """The name given."""
        return self._title

    def steps(self) -> list[str]:
        """The steps given."""
        return list(self._steps)

    def items(self, step: str) -> list[str]:
        """Take names, `a/b` for pairs, [""] for a single product, [] where the step has no result."""
        try:
            result = self._results[step]
        except LookupError:
            return []
        return [""] if is_product(type(result)) else [_name(key) for key in result]

    def product(self, step: str, item: str) -> Any:
        """The product of an item."""
        result = self._results[step]
        if is_product(type(result)):
            return result
        for key in result:
            if _name(key) == item:
                return result[key]
        raise LookupError(
            f"step {step!r} has no item {item!r}; it has {', '.join(map(_name, result)) or 'none'}"
        )

    def status(self, step: str) -> str:
        """The status given, else "fresh" where there is a result and "missing" where not."""
        return self._statuses.get(step) or ("fresh" if self.items(step) else "missing")


def _name(key: str | tuple[str, ...]) -> str:
    return key if isinstance(key, str) else "/".join(key)
