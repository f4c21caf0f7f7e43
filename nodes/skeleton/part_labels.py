"""Body parts marked by hand, from a file."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.products.part_labels import PartLabels


@node(over="dataset")
def part_labels(
    *,
    file: Annotated[
        str, File("labels of one mesh: .npz with `labels`, `label_names`, or .json {part: [vertex, ...]}")
    ],
    labels: Annotated[str, Param(about="name of the array of labels in an .npz")] = "labels",
    names: Annotated[str, Param(about="name of the array of names in an .npz")] = "label_names",
    vertices: Annotated[
        int, Param("vertex", 0, None, "of the mesh, for a .json; 0: up to the last one named")
    ] = 0,
) -> PartLabels:
    """The part that every vertex belongs to; vertices that the file leaves out belong to none.

    Raises ValueError where the file cannot be read, a label has no name, a vertex is in two parts or beyond the mesh.
    Source: Huang, Tejera, Collomosse and Hilton 2015, ACM TOG (000 section 3: parts are marked on one mesh).
    """
    path = Path(file)
    try:
        if path.suffix.lower() == ".json":
            return _from_sets(json.loads(path.read_text(encoding="utf-8")), vertices)
        with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as archive:
            label, named = np.asarray(archive[labels], np.int32), np.asarray(archive[names]).astype(str)
    except (OSError, ValueError, TypeError, KeyError, AttributeError, EOFError, zipfile.BadZipFile) as error:
        raise ValueError(f"skeleton.part_labels: {path.name} cannot be read: {error}") from error
    if label.ndim != 1 or label.min() < -1 or label.max() >= len(named):
        raise ValueError(
            f"skeleton.part_labels: {path.name}: labels must be (vertex,) of -1 .. {len(named) - 1}, got "
            f"{label.shape} of {label.min()} .. {label.max()}"
        )
    return PartLabels(label, named)


def _from_sets(parts: dict[str, list[int]], vertices: int) -> PartLabels:
    last = max(max(rows) for rows in parts.values())
    count = vertices or last + 1
    if last >= count or min(min(rows) for rows in parts.values()) < 0:
        raise ValueError(f"vertices must be 0 .. {count - 1}, a part has {last}")
    label = np.full(count, -1, np.int32)
    for k, (name, rows) in enumerate(parts.items()):
        if (label[rows] >= 0).any():
            taken = list(parts)[int(label[rows].max())]
            raise ValueError(f"a vertex belongs to one part, {name} and {taken} share some")
        label[rows] = k
    return PartLabels(label, np.array(list(parts)))
