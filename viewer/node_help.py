"""What there is to know of a node, from its signature."""

from __future__ import annotations

from typing import Any

from reperform.nodes.catalogue import Catalogue, NodeSpec, ParameterSpec


def node_line(node: NodeSpec) -> str:
    """One line: name, what one call sees, its promise."""
    return f"{node.name:34} {node.over:8} {node.doc.partition(chr(10))[0]}"


def node_json(node: NodeSpec, catalogue: Catalogue) -> dict[str, Any]:
    """All of it, plain."""
    return {
        "name": node.name,
        "over": node.over,
        "window": list(node.window),
        "volatile": node.volatile,
        "memory_gb": node.memory,
        "threads": node.threads,
        "doc": node.doc,
        "inputs": [
            {"name": p.name, "product": _short(p.product), "many": p.many, "optional": p.optional}
            for p in node.ports
        ],
        "parameters": [_parameter(parameter) for parameter in node.parameters],
        "output": _short(node.output),
        "output_many": node.output_many,
        "fields": {
            name: {"axes": list(f.axes), "dtype": f.dtype, "unit": f.unit}
            for name, f in catalogue.products[node.output].fields.items()
        },
    }


def node_text(node: NodeSpec, catalogue: Catalogue) -> str:
    """All of it, for people."""
    many = {"one": "", "pair": "the pair of ", "dataset": "all takes of ", "pairs": "all pairs of "}
    lines = [f"{node.name}  (one call sees: {node.over})", "", node.doc, "", "inputs:"]
    lines += [
        f"  {p.name}: {many[p.many]}{_short(p.product)}{' (optional)' if p.optional else ''}"
        for p in node.ports
    ] or ["  none"]
    lines.append("parameters:")
    lines += [_parameter_line(parameter) for parameter in node.parameters] or ["  none"]
    lines.append(f"output: {many.get(node.output_many, '')}{_short(node.output)}")
    for name, field in catalogue.products[node.output].fields.items():
        unit = "" if field.unit == "1" else f", {field.unit}"
        lines.append(f"  {name}: ({', '.join(field.axes)}) {field.dtype}{unit}")
    return "\n".join(lines)


def _parameter(parameter: ParameterSpec) -> dict[str, Any]:
    return {
        "name": parameter.name,
        "schema": parameter.schema,
        "default": parameter.default,
        "required": parameter.required,
        "unit": parameter.unit,
        "lower": parameter.lower,
        "upper": parameter.upper,
        "about": parameter.about,
        "file": parameter.file,
    }


def _parameter_line(p: ParameterSpec) -> str:
    kind = p.schema.get("type") or " | ".join(map(str, p.schema.get("enum", ["..."])))
    unit = "" if p.unit in ("1", "") else f" {p.unit}"
    bounds = (
        ""
        if p.lower is None and p.upper is None
        else f" [{'' if p.lower is None else f'{p.lower:g}'} .. {'' if p.upper is None else f'{p.upper:g}'}]"
    )
    default = "required" if p.required else f"default {p.default!r}"
    return f"  {p.name}: {kind}{unit}{bounds}, {default}  {p.about}"


def _short(product: str) -> str:
    return product.rsplit(".", 1)[1]
