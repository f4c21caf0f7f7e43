"""Several pipelines in one: each under a prefix of its own, so that steps and variables cannot clash."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from reperform.graphs.errors import DefinitionError, Place

if TYPE_CHECKING:
    from reperform.graphs.document import Document

_MENTION = re.compile(r"\$\{([^{}]*)\}")
_STEP = re.compile(r"^[A-Za-z_][\w-]*")


def put_under_prefix(document: Document, prefix: str, takes: Mapping[str, Mapping[str, Any]]) -> None:
    """Call every step and variable of a document PREFIX_NAME, wherever it is named; takes keep their names.

    takes: those of the document, as `read_takes` gives them. Every step is held to them, so that takes which other
    pipelines bring along are not its own.
    """
    variables = {name: f"{prefix}_{name}" for name in (*document.vars, *document.matrix)}
    steps = {name: f"{prefix}_{name}" for name in document.steps}

    def named(value: Any) -> Any:
        if isinstance(value, list):
            return [named(item) for item in value]
        if isinstance(value, dict):
            return {key: named(item) for key, item in value.items()}
        if not isinstance(value, str):
            return value
        return _MENTION.sub(lambda match: f"${{{variables.get(match[1], match[1])}}}", value)

    def wired(value: Any) -> Any:
        if isinstance(value, list):
            return [wired(item) for item in value]
        return _STEP.sub(lambda match: steps.get(match[0], match[0]), str(value))

    def placed(keys: tuple[str | int, ...]) -> tuple[str | int, ...]:
        known = {"steps": steps, "vars": variables, "matrix": variables}.get(str(keys[0]) if keys else "", {})
        return (keys[0], known.get(str(keys[1]), keys[1]), *keys[2:]) if len(keys) > 1 else keys

    document.steps = {
        steps[name]: {
            **named(body),
            "takes": named(body["takes"]) if body.get("takes") is not None else list(takes),
            **(
                {"inputs": {port: wired(text) for port, text in body["inputs"].items()}}
                if body.get("inputs")
                else {}
            ),
        }
        for name, body in document.steps.items()
    }
    document.vars = {variables[name]: named(value) for name, value in document.vars.items()}
    document.matrix = {variables[name]: named(values) for name, values in document.matrix.items()}
    document.takes = {
        take: {
            "vars": {variables.get(name, name): named(value) for name, value in body["vars"].items()},
            "params": {steps[step]: named(values) for step, values in body["params"].items()},
        }
        for take, body in takes.items()
    }
    document.exports = {named(file): wired(text) for file, text in document.exports.items()}
    document.places = {placed(keys): place for keys, place in document.places.items()}


def all_takes(
    before: Mapping[str, Mapping[str, Any]], more: Mapping[str, Mapping[str, Any]], place: Place
) -> dict[str, Mapping[str, Any]]:
    """Takes of two pipelines together. Raises DefinitionError where both have one of the same name."""
    both = [take for take in more if take in before]
    if both:
        raise DefinitionError(
            f"include: two of the pipelines have a take {both[0]!r}: rename it in one of them", place
        )
    return {**before, **more}
