"""What a product holds, seen from outside: its frames, rate, mesh and atlas, without reading arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.product import Axes, flatten, is_product, product_fields
from reperform.nodes.products.mesh import TextureAtlas


def fields(product: Any) -> dict[str, tuple[Axes, Any]]:
    """Axes and (lazy) array of each field by dotted name."""
    arrays = flatten(product)
    return {name: (axes, arrays[name]) for name, axes in product_fields(type(product)).items()}


def frame_count(product: Any) -> int:
    """How many frames the product has in time; 1 where it has no frame axis."""
    counts = [_length(array) for axes, array in fields(product).values() if "frame" in axes.items]
    return max(counts, default=1)


def camera_count(product: Any) -> int:
    """How many cameras the product has; 0 where it has no camera axis."""
    for axes, array in fields(product).values():
        if axes.items == ("camera",):
            return _length(array)
        if axes.items == ("frame", "camera"):
            return int(array.shape[1])
    return 0


def frames_per_second(product: Any, default: float = 25.0) -> float:
    """The frame rate in Hz that the product states, else the default."""
    for name, (_, array) in fields(product).items():
        if name.rpartition(".")[2] == "fps":
            rate = float(np.asarray(array))
            return rate if rate > 0 else default
    return default


def mesh_of(product: Any) -> Any | None:
    """The product, or the product inside it, that has `vertices` and `faces`; None without one."""
    if not is_product(type(product)):
        return None
    names = type(product)._fields
    if "vertices" in names and "faces" in names:
        return product
    for name in names:
        inner = mesh_of(getattr(product, name))
        if inner is not None:
            return inner
    return None


def has_mesh(product: Any) -> bool:
    """Whether the product can be shown as a surface."""
    return mesh_of(product) is not None


def mesh_frame(product: Any, frame: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) float64 in metres and faces (F, 3) int32 of one frame.

    Raises TypeError where the product holds no mesh.
    """
    mesh = mesh_of(product)
    if mesh is None:
        raise TypeError(
            f"a surface can be shown of a product with vertices and faces, got {type(product).__name__}"
        )
    axes = product_fields(type(mesh))
    read = {
        name: np.asarray(array[frame] if "frame" in axes[name].items else array)
        for name, array in (("vertices", mesh.vertices), ("faces", mesh.faces))
    }
    return read["vertices"].astype(np.float64), read["faces"].astype(np.int32)


def one_topology(product: Any) -> bool:
    """Whether all frames share their faces, so that a colour on a vertex shows correspondence."""
    mesh = mesh_of(product)
    return mesh is not None and "frame" not in product_fields(type(mesh))["faces"].items


def atlas_of(product: Any) -> TextureAtlas | None:
    """The texture atlas that is the product or lies in it."""
    if isinstance(product, TextureAtlas):
        return product
    if is_product(type(product)):
        for name in type(product)._fields:
            inner = atlas_of(getattr(product, name))
            if inner is not None:
                return inner
    return None


def summary(product: Any) -> list[tuple[str, str]]:
    """(field, axes with lengths, dtype and unit) as text, without reading a value."""
    rows = []
    for name, (axes, array) in fields(product).items():
        shape = tuple(getattr(array, "shape", ())) or ((_length(array),) if axes.names else ())
        lengths = list(shape) + [None] * (len(axes.names) - len(shape))
        named = [
            axis if length is None or axis.isdigit() or axis.endswith("*") else f"{axis} {length}"
            for axis, length in zip(axes.names, lengths, strict=False)
        ]
        unit = "" if axes.unit == "1" else f", {axes.unit}"
        rows.append((name, f"({', '.join(named)}) {axes.dtype}{unit}" if named else f"{axes.dtype}{unit}"))
    return rows


def _length(array: Any) -> int:
    shape = getattr(array, "shape", None)
    return int(shape[0]) if shape else len(array)
