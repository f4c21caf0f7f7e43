"""YAML files as plain values that remember the line each of them stands on."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from reperform.graphs.errors import DefinitionError, Place

Keys = tuple[str | int, ...]


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """YAML 1.2's idea of booleans and numbers: `no` and `on` are words, `1e-3` is a number."""


_Loader.yaml_implicit_resolvers = {
    first: [
        (tag, pattern)
        for tag, pattern in resolvers
        if tag
        not in (
            "tag:yaml.org,2002:bool",
            "tag:yaml.org,2002:float",
            "tag:yaml.org,2002:timestamp",
            "tag:yaml.org,2002:int",
        )
    ]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:bool", re.compile(r"^(?:true|True|TRUE|false|False|FALSE)$"), list("tTfF")
)
_Loader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?[0-9]+$"), list("-+0123456789"))
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(
        r"^(?:[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN))$"
    ),
    list("-+0123456789."),
)


@dataclass(frozen=True)
class Source:
    """The values of a YAML file, and the place of every key and element by its path."""

    file: str
    value: Any
    lines: dict[Keys, int]

    def place(self, *keys: str | int) -> Place:
        """Where a value stands, or the nearest enclosing one."""
        while keys and keys not in self.lines:
            keys = keys[:-1]
        return Place(self.file, self.lines.get(keys, 1))


def read_yaml(path: Path) -> Source:
    """Read a file. Raises DefinitionError with the line where it is no YAML, or holds a key twice."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise DefinitionError(f"cannot read the pipeline file {path}: {error}") from error
    return parse_yaml(text, str(path))


def parse_yaml(text: str, file: str) -> Source:
    """Parse YAML text; `file` is what errors call it."""
    try:
        root = yaml.compose(text, _Loader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        # what is cut off ends on the last line, not on the one after it
        line = min(mark.line, len(text.splitlines()) - 1) + 1 if mark else 1
        problem = getattr(error, "problem", None) or str(error)
        raise DefinitionError(
            f"this is not YAML: {problem} (is the file cut off or the indentation off?)", Place(file, line)
        ) from error
    lines: dict[Keys, int] = {}
    if root is None:
        return Source(file, {}, {(): 1})
    value = _construct(root, (), lines, file, _Loader(""))
    return Source(file, value, lines)


def _construct(node: Any, keys: Keys, lines: dict[Keys, int], file: str, loader: Any) -> Any:
    lines.setdefault(keys, node.start_mark.line + 1)
    if isinstance(node, yaml.MappingNode):
        found: dict[Any, Any] = {}
        for key_node, value_node in node.value:
            key = _construct(key_node, (*keys, "?"), {}, file, loader)
            if not isinstance(key, str | int | float) or isinstance(key, bool):
                raise DefinitionError(
                    f"a key must be a word, got {key!r}", Place(file, key_node.start_mark.line + 1)
                )
            key = str(key)
            if key in found:
                raise DefinitionError(f"key {key!r} stands twice", Place(file, key_node.start_mark.line + 1))
            lines[(*keys, key)] = key_node.start_mark.line + 1
            found[key] = _construct(value_node, (*keys, key), lines, file, loader)
        return found
    if isinstance(node, yaml.SequenceNode):
        return [_construct(item, (*keys, k), lines, file, loader) for k, item in enumerate(node.value)]
    try:
        return loader.construct_object(node)
    except yaml.YAMLError as error:
        raise DefinitionError(
            f"cannot read this value: {error}", Place(file, node.start_mark.line + 1)
        ) from error
