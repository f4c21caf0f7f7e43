"""Products read from a store: whole and at once, or field by field and frame by frame as they are indexed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from reperform.nodes.catalogue import FieldSpec
from reperform.nodes.product import unflatten
from reperform.nodes.ragged import Ragged
from reperform.storage.manifest import StoredUnit, open_unit


class LazyField:
    """A stored field that reads what is indexed: `field[frame]`, `field[frame, camera]`, `field[a:b]`, `np.asarray(field)`.

    A ragged field gives one array per frame and a `Ragged` where several frames are asked for.
    """

    def __init__(self, unit: StoredUnit, name: str, spec: FieldSpec) -> None:
        self._unit, self._name, self._spec = unit, name, spec

    def __len__(self) -> int:
        axes = self._spec.items
        return self._unit.contents.lengths[axes[0]] if axes else int(self.shape[0])

    def __iter__(self) -> Iterator[Any]:
        return (self[k] for k in range(len(self)))

    @property
    def dtype(self) -> np.dtype:
        """dtype of the values."""
        return self._unit.dtype(self._name)

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return len(self._spec.axes)

    @property
    def shape(self) -> tuple[Any, ...]:
        """Length along each axis; None where it differs from frame to frame."""
        if self._spec.dtype == "str":
            return tuple(np.shape(np.asarray(self)))
        if "frame" not in self._spec.axes:
            return self._unit.shape(self._name)
        inner = self._unit.shape(self._name, 0) if len(self) else tuple(0 for _ in self._spec.axes[1:])
        ragged = [
            None if axis.endswith("*") else n for axis, n in zip(self._spec.axes[1:], inner, strict=True)
        ]
        return (len(self), *ragged)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        if self._spec.ragged:
            raise TypeError(
                f"field {self._name!r} differs in shape from frame to frame: index one frame of it"
            )
        array = self.read()
        return array if dtype is None else array.astype(dtype)

    def __float__(self) -> float:
        return float(np.asarray(self))

    def __int__(self) -> int:
        return int(np.asarray(self))

    def read(self) -> Any:
        """The whole field: an array, or a `Ragged`."""
        if "frame" not in self._spec.axes:
            return self._unit.constant(self._name)
        return self._frames(range(len(self)))

    def __getitem__(self, index: Any) -> Any:
        first, rest = (index[0], index[1:]) if isinstance(index, tuple) and index else (index, ())
        if "frame" not in self._spec.axes or isinstance(first, type(Ellipsis) | type(None)):
            return np.asarray(self)[index]
        if isinstance(first, int | np.integer):
            frame = range(len(self))[first]
            if rest and "camera" in self._spec.axes and isinstance(rest[0], int | np.integer):
                count = self._unit.contents.lengths["camera"]
                view = self._unit.frames(self._name, [frame], range(count)[rest[0]])[0]
                return view[rest[1:]] if rest[1:] else view
            array = self._unit.frames(self._name, [frame])[0]
            return array[rest] if rest else array
        frames = (
            range(len(self))[first] if isinstance(first, slice) else np.arange(len(self))[np.asarray(first)]
        )
        got = self._frames([int(k) for k in frames])
        return got[(slice(None), *rest)] if rest else got

    def _frames(self, frames: Sequence[int]) -> Any:
        arrays = self._unit.frames(self._name, list(frames))
        if self._spec.ragged:
            return Ragged(arrays)
        if arrays:
            return np.stack(arrays)
        return np.zeros((0, *(n or 0 for n in self.shape[1:])), self.dtype)

    def __repr__(self) -> str:
        return f"<{self._name} {self._spec.axes} of a stored product, read on demand>"


def lazy_product(url: str, manifest: str, part: str, kind: type, fields: Mapping[str, FieldSpec]) -> Any:
    """A stored product whose fields read on demand."""
    unit = open_unit(url, manifest)
    prefix = f"{part}." if part else ""
    return unflatten(kind, {name: LazyField(unit, prefix + name, spec) for name, spec in fields.items()})


def whole_product(url: str, manifest: str, part: str, kind: type, fields: Mapping[str, FieldSpec]) -> Any:
    """A stored product with all of its arrays in memory, read-only."""
    unit = open_unit(url, manifest)
    prefix = f"{part}." if part else ""
    values: dict[str, Any] = {}
    for name, spec in fields.items():
        value = LazyField(unit, prefix + name, spec).read()
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        values[name] = value
    return unflatten(kind, values)
