"""File names with placeholders: which file belongs to which camera and frame."""

from __future__ import annotations

import re
from pathlib import Path

_TOKEN = re.compile(r"(\{camera\}|\{frame\}|\*|\?)")


def natural_key(text: str) -> tuple[tuple[int, int, str], ...]:
    """Sort key that reads runs of digits as numbers: cam2 before cam10."""
    parts = re.split(r"(\d+)", text)
    return tuple((0, int(part), part) if part.isdigit() else (1, 0, part) for part in parts if part)


def compile_pattern(pattern: str) -> re.Pattern[str]:
    """The regular expression of a pattern such as `{camera}/{frame}.png`.

    `{camera}` stands for any text and `{frame}` for a number, both within one path segment; used twice they
    must be the same text. `*` and `?` are wild within a segment. Raises ValueError for other braces.
    """
    seen: set[str] = set()
    expression = ""
    for part in _TOKEN.split(pattern):
        if part in ("{camera}", "{frame}"):
            name = part[1:-1]
            if name in seen:
                expression += f"(?P={name})"
            else:
                expression += f"(?P<{name}>{'[^/]+?' if name == 'camera' else '[0-9]+'})"
            seen.add(name)
        elif part in ("*", "?"):
            expression += "[^/]*" if part == "*" else "[^/]"
        elif "{" in part or "}" in part:
            raise ValueError(
                f"pattern {pattern!r}: the placeholders are {{camera}} and {{frame}}, got {part!r}"
            )
        else:
            expression += re.escape(part)
    return re.compile(expression + r"\Z")


def match_files(folder: Path, pattern: str) -> dict[str, list[tuple[int, str]]]:
    """Files under a folder that match: camera -> [(frame number, relative name)], both in natural order.

    Without `{camera}` there is one camera, "0"; without `{frame}` frames are numbered in natural order of name.
    """
    expression = compile_pattern(pattern)
    depth = pattern.count("/") + 1
    found: dict[str, list[tuple[int, str]]] = {}
    for path in folder.glob("/".join("*" * depth)):
        name = path.relative_to(folder).as_posix()
        match = expression.match(name)
        if match is None or not path.is_file():
            continue
        groups = match.groupdict()
        found.setdefault(groups.get("camera", "0"), []).append((int(groups.get("frame", -1)), name))
    ordered = {}
    for camera in sorted(found, key=natural_key):
        files = sorted(found[camera], key=lambda item: (item[0], natural_key(item[1])))
        ordered[camera] = [(k if number < 0 else number, name) for k, (number, name) in enumerate(files)]
    return ordered
