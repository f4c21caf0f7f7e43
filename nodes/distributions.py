"""What is installed: entry points and versions of distributions, read straight from `sys.path`.

`importlib.metadata` would read the metadata of every distribution, which takes longer than a run with nothing to do.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Collection, Iterator


def plug_ins(group: str) -> set[tuple[str, str]]:
    """(name, value) of all entry points of a group."""
    return {entry for folder, names in _folders() for entry in _in_folder(folder, names, group)}


def versions(distributions: Collection[str]) -> dict[str, str]:
    """Versions of some distributions by name."""
    found = dict.fromkeys(distributions, "not installed")
    wanted = {name.replace("-", "_").lower(): name for name in distributions}
    for _, names in _folders():
        for name in names:
            if name.endswith(".dist-info"):
                distribution, _, version = name.removesuffix(".dist-info").partition("-")
                key = wanted.get(distribution.replace(".", "_").lower())
                if key and found[key] == "not installed":
                    found[key] = version
    return found


def _folders() -> Iterator[tuple[str, list[str]]]:
    for path in dict.fromkeys(sys.path):
        try:
            yield path or os.curdir, os.listdir(path or os.curdir)
        except OSError:
            # not every entry of sys.path is a folder, or there
            continue


def _in_folder(folder: str, names: list[str], group: str) -> Iterator[tuple[str, str]]:
    for name in names:
        if name.endswith((".dist-info", ".egg-info")):
            try:
                with open(os.path.join(folder, name, "entry_points.txt"), encoding="utf-8") as stream:
                    text = stream.read()
            except OSError:
                continue
            if group in text:
                yield from _parsed(text, group)


def _parsed(text: str, group: str) -> Iterator[tuple[str, str]]:
    section = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith("["):
            section = line.strip("[]").strip()
        elif section == group and "=" in line and line[0] not in "#;":
            name, _, value = line.partition("=")
            yield name.strip(), value.partition("[")[0].strip()
