"""From the results of all items of a unit to its manifest."""

from __future__ import annotations

import uuid
from collections.abc import Mapping

import numpy as np

from reperform.graphs.unit import Unit, Work
from reperform.nodes.catalogue import FieldSpec
from reperform.storage.index import Manifest, Records
from reperform.storage.manifest import Contents
from reperform.storage.store import Store
from reperform.storage.tables import unpack_tables


def complete(unit: Unit, work: Work, fields: Mapping[str, FieldSpec], store: Store) -> dict[str, Manifest]:
    """Write the manifests of a unit whose items all have results. Raises ValueError where the items disagree."""
    if work.outputs is not None:
        contents = {
            take: _whole([work.results[key].segment], work.results[key].tables, fields)
            for take, key in zip(work.outputs, work.keys, strict=True)
        }
        keys = dict(zip(work.outputs, work.keys, strict=True))
    elif work.layout == "whole":
        result = work.results[unit.key]
        contents, keys = {unit.label: _whole([result.segment], result.tables, fields)}, {unit.label: unit.key}
    else:
        contents, keys = {unit.label: _stacked(work, fields)}, {unit.label: unit.key}
    records, manifests = Records(), {}
    for label, content in contents.items():
        name = f"{keys[label].hex()}-{uuid.uuid4().hex[:8]}"
        store.shelf.write_manifest(name, content.to_bytes())
        manifest = Manifest(keys[label], name, unit.step.node.name, content.summary())
        manifests[label] = manifest
        records.manifests.append((manifest, list(dict.fromkeys(content.segments))))
    store.index.commit(records)
    return manifests


def _whole(segments: list[str], packed: bytes, fields: Mapping[str, FieldSpec]) -> Contents:
    tables = unpack_tables(packed)
    axes = {name: fields[name].items for name in tables}
    lengths: dict[str, int] = {}
    for name, table in tables.items():
        lengths |= dict(zip(axes[name], table.shape[:-1], strict=True))
    return Contents("whole", axes, lengths, tables, segments, np.zeros(1, np.int32), np.zeros(1, np.int32))


def _stacked(work: Work, fields: Mapping[str, FieldSpec]) -> Contents:
    """Tables of all items side by side; a field without the items' axis must be the same in all of them."""
    results = [work.results[key] for key in work.keys]
    unpacked = [unpack_tables(result.tables) for result in results]
    cut = ("frame", "camera") if work.layout == "view" else ("frame",)
    shape = tuple(work.lengths[axis] for axis in cut)
    axes = {name: spec.items for name, spec in fields.items()}
    lengths, tables = dict(work.lengths), {}
    for name in fields:
        if len({item[name].shape for item in unpacked}) > 1:
            raise ValueError(f"field {name!r} must have the same number of cameras in all frames")
        table = np.stack([item[name] for item in unpacked]).reshape(*shape, *unpacked[0][name].shape)
        for position, axis in reversed(list(enumerate(cut))):
            if axis not in axes[name]:
                if (table != np.take(table, [0], axis=position)).any():
                    raise ValueError(
                        f"field {name!r} has no {axis} axis, so it must be the same for every {axis}, but it differs"
                    )
                table = np.take(table, 0, axis=position)
        tables[name] = np.ascontiguousarray(table)
        lengths |= dict(zip(axes[name], table.shape[:-1], strict=True))
    segments = list(dict.fromkeys(result.segment for result in results))
    place = {name: k for k, name in enumerate(segments)}
    where = np.array([place[result.segment] for result in results], np.int32)
    rows = np.array([result.row for result in results], np.int32)
    return Contents(work.layout, axes, lengths, tables, segments, where, rows)  # type: ignore[arg-type]
