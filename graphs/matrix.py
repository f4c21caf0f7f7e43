"""Sweeps: a step that uses a matrix variable, and all that stands on it, exists once per value."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

from reperform.graphs.document import Document, variables_in


def expand(document: Document) -> dict[str, tuple[str, dict[str, Any], dict[str, Any]]]:
    """Steps after expansion: name -> (name in the document, body, matrix values).

    A variant is called `step[variable=value]`. An input `step[*]` gathers all variants of a step into a dataset.
    """
    used = {name: _uses(name, document, ()) for name in document.steps}
    steps = {}
    for name, body in document.steps.items():
        for values in _combinations(used[name], document.matrix):
            inputs = {}
            for port, wired in (body.get("inputs") or {}).items():
                named = [_variant(text, used, values) for text in sources(wired)]
                inputs[port] = named if isinstance(wired, list) else named[0]
            steps[label(name, values)] = (name, {**body, "inputs": inputs} if inputs else body, values)
    return steps


def sources(wired: Any) -> list[str]:
    """The references of an input: one, or those of a list."""
    return [str(text) for text in wired] if isinstance(wired, list) else [str(wired)]


def _variant(text: str, used: Mapping[str, list[str]], values: Mapping[str, Any]) -> str:
    step, rest = _split(text)
    if rest.startswith("[*]") or not used.get(step):
        return text
    return label(step, {k: values[k] for k in used[step]}) + rest


def label(step: str, values: Mapping[str, Any]) -> str:
    """The name of a variant."""
    return f"{step}[{','.join(f'{k}={v}' for k, v in values.items())}]" if values else step


def variants(step: str, names: list[str]) -> dict[str, str]:
    """Variants of a step by their label inside the brackets (a step without variants is its own)."""
    return {
        name[len(step) + 1 : -1] or step: name
        for name in names
        if name == step or name.startswith(step + "[")
    }


def _split(text: str) -> tuple[str, str]:
    for k, letter in enumerate(text):
        if letter in "./[":
            return text[:k], text[k:]
    return text, ""


def _uses(name: str, document: Document, above: tuple[str, ...]) -> list[str]:
    """Matrix variables that a step depends on, in the order of the document."""
    body = document.steps.get(name)
    if body is None or name in above:
        return []  # reported later, as an unknown step or a cycle
    direct = variables_in(body.get("params") or {})
    for text in [text for wired in (body.get("inputs") or {}).values() for text in sources(wired)]:
        step, rest = _split(text)
        if not rest.startswith("[*]"):
            direct |= set(_uses(step, document, (*above, name)))
    return [variable for variable in document.matrix if variable in direct]


def _combinations(used: list[str], matrix: Mapping[str, list[Any]]) -> list[dict[str, Any]]:
    return [dict(zip(used, values, strict=True)) for values in itertools.product(*(matrix[k] for k in used))]
