"""Parameter values: checked against their declaration, with units converted."""

from __future__ import annotations

import json
import math
import re
from typing import Any

from reperform.graphs.errors import nearest
from reperform.nodes.catalogue import ParameterSpec

# unit -> (dimension, factor to the dimension's base)
UNITS: dict[str, tuple[str, float]] = {
    "m": ("length", 1.0), "cm": ("length", 0.01), "mm": ("length", 0.001), "km": ("length", 1000.0),
    "s": ("time", 1.0), "ms": ("time", 0.001), "min": ("time", 60.0), "h": ("time", 3600.0),
    "rad": ("angle", 1.0), "deg": ("angle", math.pi / 180), "turn": ("angle", 2 * math.pi),
    "Hz": ("rate", 1.0), "fps": ("rate", 1.0), "kHz": ("rate", 1000.0),
    "m/s": ("speed", 1.0), "cm/s": ("speed", 0.01), "mm/s": ("speed", 0.001), "km/h": ("speed", 1 / 3.6),
    "rad/s": ("turning", 1.0), "deg/s": ("turning", math.pi / 180),
    "px": ("picture", 1.0), "1": ("ratio", 1.0), "%": ("ratio", 0.01), "": ("ratio", 1.0),
    "GB": ("memory", 1.0), "MB": ("memory", 0.001),
}  # fmt: skip
_QUANTITY = re.compile(r"^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([A-Za-z%/]+)\s*$")


def check(value: Any, spec: ParameterSpec) -> Any:
    """The canonical value of a parameter: type as declared, in the declared unit, within bounds.

    Raises ValueError with what was expected and what was got.
    """
    value = _typed(value, spec.schema, spec)
    for number in _numbers(value):
        if (spec.lower is not None and number < spec.lower) or (
            spec.upper is not None and number > spec.upper
        ):
            low, high = (_bound(spec.lower, "-inf"), _bound(spec.upper, "inf"))
            unit = "" if spec.unit in ("1", "") else f" {spec.unit}"
            raise ValueError(f"must be within {low} .. {high}{unit}, got {number:g}")
    return value


def canonical(parameters: dict[str, Any]) -> bytes:
    """Parameters as the bytes that go into a key: sorted, and 1.0 is 1.0 however it was written."""
    return json.dumps(parameters, sort_keys=True, separators=(",", ":"), ensure_ascii=False).encode()


def _bound(value: float | None, none: str) -> str:
    return none if value is None else f"{value:g}"


def _numbers(value: Any) -> list[float]:
    if isinstance(value, list):
        return [number for item in value for number in _numbers(item)]
    return [value] if isinstance(value, int | float) and not isinstance(value, bool) else []


def _typed(value: Any, schema: dict[str, Any], spec: ParameterSpec) -> Any:
    if "enum" in schema:
        if value not in schema["enum"]:
            raise ValueError(f"got {value!r}: {nearest(str(value), map(str, schema['enum']))}")
        return value
    if "anyOf" in schema:
        errors = []
        for option in schema["anyOf"]:
            try:
                return _typed(value, option, spec)
            except ValueError as error:
                errors.append(str(error))
        raise ValueError("; or ".join(dict.fromkeys(errors)))
    kind = schema["type"]
    if kind == "number":
        return _number(value, spec)
    if kind == "integer" and (isinstance(value, bool) or not isinstance(value, int)):
        if isinstance(value, str) and _QUANTITY.match(value) and _number(value, spec).is_integer():
            return int(_number(value, spec))
        raise ValueError(f"must be a whole number, got {value!r}")
    if kind == "boolean" and not isinstance(value, bool):
        raise ValueError(f"must be true or false, got {value!r}")
    if kind == "string" and not isinstance(value, str):
        raise ValueError(f"must be text, got {value!r}: put it in quotes if it is meant as text")
    if kind == "null" and value is not None:
        raise ValueError(f"must be empty, got {value!r}")
    if kind == "array":
        return _list(value, schema, spec)
    if kind == "object":
        if not isinstance(value, dict):
            raise ValueError(f"must be a mapping, got {value!r}")
        return {str(key): _typed(item, schema["additionalProperties"], spec) for key, item in value.items()}
    return value


def _list(value: Any, schema: dict[str, Any], spec: ParameterSpec) -> list[Any]:
    if not isinstance(value, list | tuple):
        raise ValueError(f"must be a list, got {value!r}")
    if "prefixItems" in schema:
        if len(value) != schema["minItems"]:
            raise ValueError(f"must have {schema['minItems']} elements, got {len(value)}")
        return [_typed(item, inner, spec) for item, inner in zip(value, schema["prefixItems"], strict=True)]
    return [_typed(item, schema["items"], spec) for item in value]


def _number(value: Any, spec: ParameterSpec) -> float:
    unit = spec.unit or "1"
    if isinstance(value, str) and (match := _QUANTITY.match(value)):
        given = match[2]
        if given not in UNITS:
            raise ValueError(f"unknown unit {given!r}: {nearest(given, [u for u in UNITS if u])}")
        if unit not in UNITS or UNITS[given][0] != UNITS[unit][0]:
            raise ValueError(f"wrong unit: must be in {unit if unit != '1' else 'no unit'}, got {value!r}")
        # divide by what one unit is in the other: exact for mm -> m, where a factor of 0.001 is not
        ratio = UNITS[unit][1] / UNITS[given][1]
        return float(match[1]) / ratio if ratio >= 1 else float(match[1]) * (UNITS[given][1] / UNITS[unit][1])
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"must be a number{'' if unit == '1' else f' in {unit}'}, got {value!r}")
    if not math.isfinite(value):
        raise ValueError(f"must be finite, got {value}")
    return float(value)
