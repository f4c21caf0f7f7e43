"""Results in words: fields with axes, shapes, units and ranges; tables as tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from reperform.nodes.product import Axes, flatten, product_fields
from reperform.nodes.products.table import Table

SAMPLED_FRAMES = 16


def show_json(products: Mapping[str, Any]) -> Any:
    """A Table as columns and rows; other products as fields, by item where there are several."""
    described = {
        label: _table(p) if isinstance(p, Table) else {"fields": _fields(p)} for label, p in products.items()
    }
    return next(iter(described.values())) if len(described) == 1 else described


def show_text(products: Mapping[str, Any]) -> str:
    """The same for people."""
    parts = []
    for label, product in products.items():
        if label:
            parts.append(f"{label}:")
        if isinstance(product, Table):
            parts.append(_grid(_table(product)))
        else:
            parts += [_line(name, field) for name, field in _fields(product).items()]
    return "\n".join(parts)


def _table(table: Table) -> dict[str, Any]:
    columns = list(Table._fields)
    arrays = [np.asarray(getattr(table, name)) for name in columns]
    return {
        "columns": columns,
        "rows": [[_plain(array[k]) for array in arrays] for k in range(len(arrays[0]))],
    }


def _plain(value: Any) -> Any:
    value = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _grid(table: Mapping[str, Any]) -> str:
    marks = {1: "yes", 0: "NO", -1: "?"}
    holds = table["columns"].index("holds")
    rows = [[marks[v] if k == holds else _short(v) for k, v in enumerate(row)] for row in table["rows"]]
    widths = [max(map(len, column)) for column in zip(table["columns"], *rows, strict=True)]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in [table["columns"], *rows]
    ]
    return "\n".join([lines[0], "-" * len(lines[0]), *lines[1:]])


def _short(value: Any) -> str:
    return "" if value is None else f"{value:.5g}" if isinstance(value, float) else str(value)


def _fields(product: Any) -> dict[str, dict[str, Any]]:
    declared = product_fields(type(product))
    return {name: _describe(value, declared[name]) for name, value in flatten(product).items()}


def _describe(value: Any, axes: Axes) -> dict[str, Any]:
    found: dict[str, Any] = {
        "axes": list(axes.names),
        "shape": list(value.shape),
        "dtype": axes.dtype,
        "unit": axes.unit,
    }
    sample = _sample(value, axes)
    if axes.dtype == "str":
        found["values"] = [str(v) for v in sample.ravel()[:64]]
    elif sample.size:
        finite = sample[np.isfinite(sample)] if sample.dtype.kind == "f" else sample
        if finite.size:
            found["range"] = [_plain(finite.min()), _plain(finite.max())]
    return found


def _sample(value: Any, axes: Axes) -> np.ndarray:
    """Values to tell the range from: all of a small field, some frames of a long one."""
    if "frame" not in axes.names:
        return np.asarray(value)
    count = len(value)
    frames = sorted({int(k) for k in np.linspace(0, count - 1, min(count, SAMPLED_FRAMES))}) if count else []
    picked = [np.asarray(value[k]).ravel() for k in frames]
    return np.concatenate(picked) if picked else np.zeros(0)


def _line(name: str, field: Mapping[str, Any]) -> str:
    shape = " x ".join(
        f"{axis} {'*' if n is None else n}" for axis, n in zip(field["axes"], field["shape"], strict=True)
    )
    unit = "" if field["unit"] == "1" else f" {field['unit']}"
    if "values" in field:
        told = ", ".join(field["values"][:12])
    else:
        told = " .. ".join(f"{bound:.5g}" for bound in field["range"]) + unit if "range" in field else ""
    return f"  {name:28} {field['dtype']:8} {shape or 'scalar':40} {told}"
