"""What the key of a unit was made of when it last completed, and what has changed since."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from reperform.graphs.unit import Unit
from reperform.nodes.distributions import versions as installed
from reperform.storage.index import Index

LIBRARIES = (
    "numpy",
    "scipy",
    "numba",
    "opencv-contrib-python-headless",
    "trimesh",
    "vtk",
    "fast-simplification",
    "zarr",
)


def changed_parts(
    pipeline: str, units: Iterable[Unit], index: Index
) -> dict[tuple[str, str], dict[str, Any]]:
    """Parts of finished units that differ from those remembered."""
    known = index.remembered_keys(pipeline)
    changed = {
        unit.name: {**unit.parts, "items": sum(m.summary["items"] for m in unit.manifests.values())}
        for unit in units
        if unit.status == "done" and known.get(unit.name) != unit.parts["key"]
    }
    if changed:
        versions = library_versions()
        changed = {name: {**parts, "versions": versions} for name, parts in changed.items()}
    return changed


def library_versions() -> dict[str, str]:
    """Versions of the libraries results may depend on: recorded, not in keys."""
    return installed(LIBRARIES)


def differences(before: Mapping[str, Any] | None, now: Mapping[str, Any]) -> list[str]:
    """What changed in a key, in words: node, functions, parameters, inputs."""
    if before is None:
        return ["never computed in this store"]
    if before["key"] == now["key"]:
        return []
    found = []
    if before["node"] != now["node"]:
        found.append(f"node changed: {before['node']} -> {now['node']}")
    found += _mapping("function", before["functions"], now["functions"], values=False)
    found += _mapping("parameter", before["params"], now["params"], values=True)
    for port in sorted(set(before["inputs"]) | set(now["inputs"])):
        old, new = before["inputs"].get(port), now["inputs"].get(port)
        if old == new:
            continue
        if old is None or new is None:
            found.append(f"input {port!r} {'removed' if new is None else 'added'}")
            continue
        labels = [label for label in {**old, **new} if old.get(label) != new.get(label)]
        named = f" ({', '.join(labels[:6])}{', ...' if len(labels) > 6 else ''})" if any(labels) else ""
        found.append(f"input {port!r} changed{named}")
    return found or ["order of inputs changed"]


def _mapping(what: str, old: Mapping[str, Any], new: Mapping[str, Any], values: bool) -> list[str]:
    found = []
    for name in sorted(set(old) | set(new)):
        if name not in old:
            found.append(f"{what} {name} added" + (f": {new[name]!r}" if values else ""))
        elif name not in new:
            found.append(f"{what} {name} removed")
        elif old[name] != new[name]:
            found.append(f"{what} {name} changed" + (f": {old[name]!r} -> {new[name]!r}" if values else ""))
    return found
