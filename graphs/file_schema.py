"""JSON Schema of pipeline files: completion and validation in any editor, from the nodes' signatures."""

from __future__ import annotations

from typing import Any

from reperform.nodes.catalogue import Catalogue, NodeSpec, ParameterSpec

_TEXT = {"type": "string"}
_TEXTS = {"type": "array", "items": _TEXT, "minItems": 1}
_VARIABLE = {"type": "string", "pattern": r"\$\{[^{}]+\}"}


def file_schema(catalogue: Catalogue) -> dict[str, Any]:
    """The schema, draft 2020-12."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "reperform pipeline",
        "type": "object",
        "additionalProperties": False,
        "properties": {
            "about": _TEXT,
            "include": {
                "oneOf": [
                    {"$ref": "#/$defs/include"},
                    {"type": "array", "items": {"$ref": "#/$defs/include"}},
                ]
            },
            "vars": {"type": "object"},
            "matrix": {"type": "object", "additionalProperties": {"type": "array", "minItems": 1}},
            "takes": {"oneOf": [_TEXT, {"type": "array", "items": _TEXT}, {"type": "object"}]},
            "steps": {"type": "object", "additionalProperties": {"$ref": "#/$defs/step"}},
            "exports": {"type": "object", "additionalProperties": _TEXT},
        },
        "$defs": {
            "include": {
                "oneOf": [
                    _TEXT,
                    {
                        "type": "object",
                        "required": ["pipeline"],
                        "additionalProperties": False,
                        "properties": {"pipeline": _TEXT, "as": _TEXT, "vars": {"type": "object"}},
                    },
                ]
            },
            "step": {
                "type": "object",
                "additionalProperties": False,
                "properties": {
                    "node": {"enum": list(catalogue.nodes)},
                    "inputs": {"type": "object", "additionalProperties": {"oneOf": [_TEXT, _TEXTS]}},
                    "params": {"type": "object"},
                    "about": _TEXT,
                    "takes": {"oneOf": [_TEXT, {"type": "array", "items": _TEXT}]},
                },
                "allOf": [_of_node(node) for node in catalogue.nodes.values()],
            },
        },
    }


def _of_node(node: NodeSpec) -> dict[str, Any]:
    inputs = {
        port.name: {
            **({"oneOf": [_TEXT, _TEXTS]} if port.many == "dataset" else _TEXT),
            "description": f"{port.many}: {port.product.rsplit('.', 1)[1]}",
        }
        for port in node.ports
    }
    params = {parameter.name: _parameter(parameter) for parameter in node.parameters}
    return {
        "if": {"properties": {"node": {"const": node.name}}, "required": ["node"]},
        "then": {
            "description": node.doc.partition("\n")[0],
            "properties": {
                "inputs": {"properties": inputs, "additionalProperties": False},
                "params": {"properties": params, "additionalProperties": False},
            },
        },
    }


def _parameter(parameter: ParameterSpec) -> dict[str, Any]:
    schema = dict(parameter.schema)
    if schema.get("type") in ("number", "integer"):
        if parameter.lower is not None:
            schema["minimum"] = parameter.lower
        if parameter.upper is not None:
            schema["maximum"] = parameter.upper
    unit = "" if parameter.unit in ("1", "") else f" ({parameter.unit})"
    found: dict[str, Any] = {"description": f"{parameter.about}{unit}", "anyOf": [schema, _VARIABLE]}
    if schema.get("type") in ("number", "integer"):
        # a quantity with a unit of its own, such as `10 mm`
        found["anyOf"].append({"type": "string", "pattern": r"^\s*[-+0-9.eE]+\s*[A-Za-z%/]+\s*$"})
    if not parameter.required:
        found["default"] = parameter.default
    return found
