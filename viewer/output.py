"""What commands write."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click


def write_json(target: str | None, value: Any) -> None:
    """Write JSON to a file, to standard output (-), or nowhere (None)."""
    if target == "-":
        click.echo(json.dumps(value, indent=2))
    elif target:
        Path(target).write_text(json.dumps(value, indent=2) + "\n", encoding="utf-8")


def size_text(count: float) -> str:
    """A number of bytes for people."""
    for unit in ("B", "kB", "MB", "GB"):
        if abs(count) < 1000 or unit == "GB":
            return f"{count:.0f} {unit}" if unit == "B" else f"{count:.1f} {unit}"
        count /= 1000
    return ""
