"""Products: named tuples of arrays with named axes, dtype and unit."""

from __future__ import annotations

import typing
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar

import numpy as np

T = TypeVar("T")

# What a port may ask for besides a plain product: the two products of a pair, all takes, all pairs of takes.
Pair = tuple[T, T]
Dataset = Mapping[str, T]
Pairs = Mapping[tuple[str, str], T]

ITEM_AXES = ("frame", "camera")


@dataclass(frozen=True, init=False)
class Axes:
    """The axes, dtype and unit of one field.

    An axis is a name. `frame` and `camera` are the item axes: along them a product is cut into items. A number
    is a fixed length (`"3"`). A star (`"vertex*"`) marks an axis whose length differs from frame to frame: a node
    that sees many frames gets a `Ragged` there. dtype is numpy's name, or `str`.
    """

    names: tuple[str, ...]
    dtype: str
    unit: str

    def __init__(self, *names: str, dtype: str = "float32", unit: str = "1") -> None:
        if "camera" in names and "frame" in names and names[:2] != ("frame", "camera"):
            raise ValueError(f"a field cut by frame and camera starts with these two axes, got {names}")
        if any(axis in names and names[0] not in ITEM_AXES for axis in ITEM_AXES):
            raise ValueError(f"the item axes frame and camera come first, got {names}")
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "dtype", dtype)
        object.__setattr__(self, "unit", unit)

    @property
    def items(self) -> tuple[str, ...]:
        """The item axes of the field, in order."""
        return tuple(name for name in self.names if name in ITEM_AXES)

    @property
    def ragged(self) -> bool:
        """Whether the shape differs from frame to frame."""
        return any(name.endswith("*") for name in self.names)

    def __repr__(self) -> str:
        return f"Axes({', '.join(map(repr, self.names))}, dtype={self.dtype!r}, unit={self.unit!r})"


def is_product(kind: Any) -> bool:
    """Whether a type is a product: a `NamedTuple` whose fields are annotated with `Axes` or are products."""
    return isinstance(kind, type) and issubclass(kind, tuple) and hasattr(kind, "_fields")


def product_fields(kind: type) -> dict[str, Axes]:
    """The fields of a product type by name; those of a product inside it as `inner.field`.

    Raises TypeError where a field has no `Axes`.
    """
    fields: dict[str, Axes] = {}
    for name, annotation in typing.get_type_hints(kind, include_extras=True).items():
        if is_product(annotation):
            fields |= {f"{name}.{inner}": axes for inner, axes in product_fields(annotation).items()}
            continue
        axes = [extra for extra in typing.get_args(annotation)[1:] if isinstance(extra, Axes)]
        if typing.get_origin(annotation) is not Annotated or len(axes) != 1:
            raise TypeError(
                f"field {name!r} of product {kind.__name__} must be Annotated[np.ndarray, Axes(...)] or a product"
            )
        fields[name] = axes[0]
    return fields


def flatten(product: Any) -> dict[str, Any]:
    """The arrays of a product by (dotted) field name."""
    flat: dict[str, Any] = {}
    for name, value in zip(product._fields, product, strict=True):
        if is_product(type(value)):
            flat |= {f"{name}.{inner}": array for inner, array in flatten(value).items()}
        else:
            flat[name] = value
    return flat


def unflatten(kind: type, flat: Mapping[str, Any]) -> Any:
    """The product of a type from its arrays by (dotted) field name: the inverse of `flatten`."""
    hints = typing.get_type_hints(kind)
    return kind(
        *(
            unflatten(
                hints[name], {k.split(".", 1)[1]: v for k, v in flat.items() if k.startswith(name + ".")}
            )
            if is_product(hints[name])
            else flat[name]
            for name in kind._fields  # type: ignore[attr-defined]
        )
    )


def conform(value: Any, axes: Axes, name: str) -> np.ndarray:
    """One frame's (or the whole) array of a field, as declared: dtype converted only where nothing can be lost.

    Raises TypeError with field, what was declared and what was got.
    """
    array = np.asarray(value)
    if axes.dtype == "str":
        if array.dtype.kind not in "UT":
            raise TypeError(f"field {name!r} must hold text, got dtype {array.dtype}")
        return array.astype(str)
    dtype = np.dtype(axes.dtype)
    if array.dtype != dtype:
        same_kind = np.can_cast(array.dtype, dtype, "same_kind") or array.size == 0
        if not same_kind and not (array.dtype.kind in "iu" and np.array_equal(array, array.astype(dtype))):
            raise TypeError(f"field {name!r} must be {dtype}, got {array.dtype}: convert it in the node")
        array = array.astype(dtype)
    return array
