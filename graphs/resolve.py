"""From a unit whose inputs are complete to its key, and, where that is not in the index, to its items and theirs."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from reperform.graphs.keys import code_key, output_key, product_digest, unit_key
from reperform.graphs.messages import Feed, Item
from reperform.graphs.parameters import canonical
from reperform.graphs.pipeline import Pipeline, Step
from reperform.graphs.unit import Unit, Work
from reperform.graphs.wiring import Input
from reperform.nodes.catalogue import PortSpec
from reperform.storage.digest import digest_bytes
from reperform.storage.index import Index, Manifest

# (step, label) -> manifest of what an earlier unit gave
Lookup = Callable[[str, str], Manifest]
Labelled = list[tuple[str, Manifest]]
Inputs = list[tuple[PortSpec, str, Labelled]]


class Resolver:
    """Works out keys and items of units of one pipeline."""

    def __init__(self, pipeline: Pipeline, url: str, index: Index, lookup: Lookup, run: bytes) -> None:
        self._pipeline, self._url, self._index, self._lookup, self._run = pipeline, url, index, lookup, run

    def needs(self, step: Step, label: str) -> list[tuple[str, str]]:
        """(step, label) of everything a unit stands on."""
        return [
            (source, inner)
            for port in step.node.ports
            if port.name in step.inputs
            for _, source, inner in self._sources(step, port, step.inputs[port.name], label)
        ]

    def _sources(self, step: Step, port: PortSpec, wired: Input, label: str) -> list[tuple[str, str, str]]:
        """(label in the port, step, label there) of what a port of a unit sees."""
        if wired.gather:
            return [(name, source, "" if wired.item is None else wired.item) for name, source in wired.gather]
        source = self._pipeline.steps[wired.step]
        if wired.item is not None:
            takes = step.takes if port.many == "dataset" else ("",)
            return [(take, source.name, wired.item) for take in takes]
        if port.many == "one":
            return [("", source.name, label if source.domain != "single" else "")]
        if port.many == "pair":
            return [
                (take, source.name, take if source.domain == "take" else "") for take in label.split("/", 1)
            ]
        if port.many == "dataset":
            takes = step.sees(source.takes) if source.domain == "take" else step.takes
            return [(take, source.name, take if source.domain == "take" else "") for take in takes]
        return [(pair, source.name, pair) for pair in step.sees(source.units)]

    def _inputs(self, unit: Unit) -> Inputs:
        """(port, part, manifests by label), for every port of the signature; an unwired optional one has none."""
        found: Inputs = []
        for port in unit.step.node.ports:
            wired = unit.step.inputs.get(port.name)
            if wired is None:
                found.append((port, "", []))
                continue
            sources = self._sources(unit.step, port, wired, unit.label)
            found.append(
                (port, wired.part, [(label, self._lookup(step, inner)) for label, step, inner in sources])
            )
        return found

    def key(self, unit: Unit) -> None:
        """Fill in the key of a unit, and the parts of it that `why` tells of."""
        node = unit.step.node
        parameters = self._key_parameters(unit)
        ports = [(port.name, self._digests(part, manifests)) for port, part, manifests in self._inputs(unit)]
        unit.key = unit_key(self._code(unit, parameters), ports)
        unit.parts = {
            "key": unit.key.hex(),
            "node": node.name,
            "functions": node.functions,
            "params": parameters,
            "inputs": {name: {label: digest.hex() for label, digest in inputs} for name, inputs in ports},
        }

    def _code(self, unit: Unit, parameters: dict[str, Any] | None = None) -> bytes:
        given = self._key_parameters(unit) if parameters is None else parameters
        # what measures gets keys of its own in every run
        return code_key(unit.step.node, canonical(given) + (self._run if unit.step.node.volatile else b""))

    def expand(self, unit: Unit) -> Work:
        """The items of a unit and their keys. Raises ValueError where the inputs' frames or cameras do not agree."""
        node, inputs = unit.step.node, self._inputs(unit)
        feeds = {port.name: self._feed(port, part, manifests) for port, part, manifests in inputs}
        if node.over not in ("frame", "view"):
            outputs = unit.step.takes if node.output_many == "dataset" else None
            keys = [output_key(unit.key, take) for take in outputs] if outputs is not None else [unit.key]
            return Work(
                "whole", {}, [Item()], keys, tuple(feeds.values()), unit.step.parameters(unit.label), outputs
            )
        return self._expand_items(unit, inputs, feeds)

    def _expand_items(self, unit: Unit, inputs: Inputs, feeds: dict[str, Feed]) -> Work:
        # digest tables need numpy, which a run with nothing to do is spared
        from reperform.graphs.item_keys import SlicedPort, item_keys, length
        from reperform.storage.manifest import open_unit

        node, cut = unit.step.node, []
        for port, part, manifests in inputs:
            cuts = self._cuts(unit, port)
            if any(cuts):
                cut.append(
                    SlicedPort(port.name, open_unit(self._url, manifests[0][1].name).contents, part, *cuts)
                )
        frames = length("frame", [port for port in cut if port.by_frame], node.name)
        cameras = (
            length("camera", [p for p in cut if p.by_camera], node.name) if node.over == "view" else None
        )
        names = {port.name: port for port in cut}
        whole = [(p.name, self._digests(part, found)) for p, part, found in inputs if p.name not in names]
        keys = item_keys(self._code(unit), cut, whole, frames, cameras, node.window)
        for name, sliced in names.items():
            feeds[name] = replace(feeds[name], by_frame=sliced.by_frame, by_camera=sliced.by_camera)
        lengths = {"frame": frames} if cameras is None else {"frame": frames, "camera": cameras}
        items = _items(frames, cameras, node.window)
        return Work(node.over, lengths, items, keys, tuple(feeds.values()), unit.step.parameters(unit.label))

    def _cuts(self, unit: Unit, port: PortSpec) -> tuple[bool, bool]:
        """Whether a port of a frame or view unit is cut by frame, and by camera."""
        wired = unit.step.inputs.get(port.name)
        if wired is None or port.many != "one":
            return False, False
        prefix = f"{wired.part}." if wired.part else ""
        source = self._pipeline.steps[wired.steps[0]]
        fields = self._pipeline.catalogue.products[source.node.output].fields
        axes = {axis for name, field in fields.items() if name.startswith(prefix) for axis in field.items}
        domain = "single" if wired.item is not None else source.domain
        # a product that all takes share has a time line of its own: its frames are not theirs
        by_frame = "frame" in axes and domain == unit.step.domain
        return by_frame, "camera" in axes and unit.step.node.over == "view"

    def _feed(self, port: PortSpec, part: str, manifests: Labelled) -> Feed:
        product = self._pipeline.catalogue.products[port.product]
        return Feed(
            port.name,
            port.many,
            (product.module, product.name.rsplit(".", 1)[1]),
            product.fields,
            part,
            tuple((label, manifest.name) for label, manifest in manifests),
        )

    def _digests(self, part: str, manifests: Labelled) -> Sequence[tuple[str, bytes]]:
        return [(label, product_digest(manifest.summary, part)) for label, manifest in manifests]

    def _key_parameters(self, unit: Unit) -> dict[str, Any]:
        """Parameters as they are in the key: files by content, those that cannot change the result left out."""
        specs = {parameter.name: parameter for parameter in unit.step.node.parameters}
        values: dict[str, Any] = {}
        for name, value in unit.step.parameters(unit.label).items():
            if specs[name].in_key:
                values[name] = self._content(value) if specs[name].file else value
        return values

    def _content(self, path: Any) -> Any:
        if isinstance(path, list):
            return [self._content(item) for item in path]
        return file_digest(Path(path), self._index).hex() if path else ""


def _items(frames: int, cameras: int | None, window: tuple[int, int]) -> list[Item]:
    if cameras is not None:
        return [Item(f, c) for f in range(frames) for c in range(cameras)]
    if window == (0, 0):
        return [Item(f) for f in range(frames)]
    return [Item(f, None, (max(0, f - window[0]), min(frames, f + window[1] + 1))) for f in range(frames)]


def file_digest(path: Path, index: Index) -> bytes:
    """Digest of a file's bytes, or of a folder's files and their relative names.

    Size and change time only spare reading again what was read before; they are in no key.
    """
    if path.is_dir():
        inner = sorted(p for p in path.rglob("*") if p.is_file())
        parts = [
            part for p in inner for part in (p.relative_to(path).as_posix().encode(), file_digest(p, index))
        ]
        return digest_bytes(b"folder", *parts)
    state = os.stat(path)
    known = index.file_digest(str(path), state.st_size, state.st_mtime_ns)
    if known is None:
        known = _read_digest(path)
        index.remember_files([(str(path), state.st_size, state.st_mtime_ns, known)])
    return known


def _read_digest(path: Path) -> bytes:
    import hashlib

    with path.open("rb") as stream:
        return hashlib.file_digest(stream, lambda: hashlib.blake2b(digest_size=16)).digest()
