"""From signatures to plain descriptions: JSON Schema of parameters, fields of products."""

from __future__ import annotations

import inspect
import types
import typing
from typing import Any, Literal

from reperform.nodes.catalogue import FieldSpec, ParameterSpec, ProductSpec
from reperform.nodes.declaration import Parameter
from reperform.nodes.product import is_product, product_fields

_SIMPLE = {bool: "boolean", int: "integer", float: "number", str: "string", type(None): "null"}


def json_schema(kind: Any, who: str = "parameter") -> dict[str, Any]:
    """JSON Schema of a parameter's type. Raises TypeError for types that YAML cannot say."""
    origin, args = typing.get_origin(kind), typing.get_args(kind)
    if kind in _SIMPLE:
        return {"type": _SIMPLE[kind]}
    if origin is Literal:
        return {"enum": list(args)}
    if origin in (typing.Union, types.UnionType):
        return {"anyOf": [json_schema(arg, who) for arg in args]}
    if origin is list or (origin is tuple and args[-1] is Ellipsis):
        return {"type": "array", "items": json_schema(args[0], who)}
    if origin is tuple:
        return {
            "type": "array",
            "prefixItems": [json_schema(a, who) for a in args],
            "minItems": len(args),
            "maxItems": len(args),
        }
    if origin is dict and args[0] is str:
        return {"type": "object", "additionalProperties": json_schema(args[1], who)}
    raise TypeError(f"{who}: type {kind} is none that a pipeline file can hold")


def parameter_spec(parameter: Parameter, who: str) -> ParameterSpec:
    """Describe a parameter; its default must be within its own bounds."""
    param, file = parameter.param, parameter.file
    required = parameter.default is inspect.Parameter.empty
    default = None if required else parameter.default
    if isinstance(default, tuple):
        default = list(default)
    return ParameterSpec(
        parameter.name,
        json_schema(parameter.annotation, f"{who}: parameter {parameter.name!r}"),
        required,
        default,
        param.unit,
        param.lower,
        param.upper,
        file.about if file else param.about,
        file.in_key if file else param.in_key,
        file is not None,
    )


def qualified(kind: type) -> str:
    """The name by which product types are matched: module and class."""
    return f"{kind.__module__}.{kind.__qualname__}"


def product_spec(kind: type, known: dict[str, ProductSpec]) -> str:
    """Describe a product type (and those inside it) into `known`; returns its qualified name."""
    name = qualified(kind)
    if name not in known:
        inside = {
            field: product_spec(hint, known)
            for field, hint in typing.get_type_hints(kind).items()
            if is_product(hint)
        }
        fields = {k: FieldSpec(axes.names, axes.dtype, axes.unit) for k, axes in product_fields(kind).items()}
        bases = tuple(qualified(base) for base in kind.__mro__ if is_product(base))
        known[name] = ProductSpec(name, kind.__module__, inspect.getdoc(kind) or "", fields, inside, bases)
    return name
