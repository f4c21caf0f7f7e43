"""Pipelines: steps wired and checked, before anything runs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from reperform.graphs.document import Document, fill, find_pipeline, read_document, read_takes
from reperform.graphs.errors import DefinitionError, Place, nearest
from reperform.graphs.matrix import expand, variants
from reperform.graphs.parameters import check
from reperform.graphs.wiring import Input, in_order, reference, wires
from reperform.nodes.catalogue import Catalogue, NodeSpec, PortSpec, read_catalogue

Domain = Literal["single", "take", "pair"]


@dataclass(frozen=True)
class Step:
    """A node placed in a pipeline."""

    name: str
    node: NodeSpec
    inputs: Mapping[str, Input]
    # canonical parameters by unit; "" stands for every unit that is not a take
    params: Mapping[str, Mapping[str, Any]]
    domain: Domain
    takes: tuple[str, ...]
    place: Place
    about: str = ""
    # what the step came from before a sweep multiplied it
    base: str = ""
    # the takes that the definition holds it to; none: all that its inputs have
    held: tuple[str, ...] = ()

    def sees(self, takes: Sequence[str]) -> tuple[str, ...]:
        """Those of some takes, or pairs of takes, that a port for many of them sees."""
        if not self.held:
            return tuple(takes)
        return tuple(label for label in takes if all(take in self.held for take in label.split("/")))

    @property
    def units(self) -> tuple[str, ...]:
        """Labels of its outputs: takes, `a/b` for pairs, or one empty label."""
        if self.domain == "take":
            return self.takes
        if self.domain == "pair":
            return tuple(f"{a}/{b}" for a in self.takes for b in self.takes)
        return ("",)

    def parameters(self, unit: str) -> Mapping[str, Any]:
        """The canonical parameters of one unit."""
        return self.params.get(unit, self.params.get("", {}))


@dataclass(frozen=True)
class Pipeline:
    """A checked pipeline: its steps in an order in which they can run."""

    name: str
    file: str
    about: str
    takes: tuple[str, ...]
    steps: Mapping[str, Step]
    exports: Mapping[str, Input]
    catalogue: Catalogue = field(repr=False)

    def chosen(self, names: Sequence[str] = ()) -> list[str]:
        """The steps to run for the steps asked for (none: all), with all that they stand on, in order."""
        wanted: set[str] = set()
        todo = [step for name in names for step in self.match(name)] or list(self.steps)
        while todo:
            name = todo.pop()
            if name not in wanted:
                wanted.add(name)
                todo += [step for wired in self.steps[name].inputs.values() for step in wired.steps]
        return [name for name in self.steps if name in wanted]

    def match(self, name: str) -> list[str]:
        """Steps by name; the bare name of a swept step stands for all its variants."""
        found = [name] if name in self.steps else list(variants(name, list(self.steps)).values())
        if not found:
            raise DefinitionError(f"pipeline {self.name!r} has no step {name!r}: {nearest(name, self.steps)}")
        return found

    def run(self, **options: Any) -> Any:
        """Run it; see `reperform.graphs.api.run`."""
        from reperform.graphs.api import run

        return run(self, **options)


def read_pipeline(
    name: str | os.PathLike[str], sets: Sequence[str] = (), catalogue: Catalogue | None = None
) -> Pipeline:
    """Read and check a pipeline by path or shipped name. Raises DefinitionError before anything runs."""
    document = read_document(find_pipeline(os.fspath(name)), sets)
    return build(document, catalogue or read_catalogue())


def build(document: Document, catalogue: Catalogue) -> Pipeline:
    """Check a document and wire its steps."""
    if not document.steps:
        raise DefinitionError("a pipeline needs at least one step under `steps`", document.place())
    takes = read_takes(document)
    expanded = expand(document)
    order = in_order(
        document, {name: wires(name, entry, expanded, document) for name, entry in expanded.items()}
    )
    steps: dict[str, Step] = {}
    for name, inputs in order.items():
        base, body, values = expanded[name]
        steps[name] = _Builder(document, catalogue, takes, steps, name, base, body, values).step(inputs)
    exports = {}
    for target, text in document.exports.items():
        place = document.place("exports", target)
        exports[str(fill(target, document.vars, place))] = reference(str(text), expanded, place, "exports")
    return Pipeline(document.name, document.file, document.about, tuple(takes), steps, exports, catalogue)


@dataclass(frozen=True)
class _Builder:
    """Checks one step against its node and the steps before it."""

    document: Document
    catalogue: Catalogue
    takes: Mapping[str, Mapping[str, Any]]
    steps: Mapping[str, Step]
    name: str
    base: str
    body: Mapping[str, Any]
    values: Mapping[str, Any]

    def step(self, inputs: Mapping[str, Input]) -> Step:
        node = self._node()
        ports = {port.name: port for port in node.ports}
        for name in inputs:
            if name not in ports:
                raise self._error(
                    f"node {node.name} has no input {name!r}: {nearest(name, ports)}", "inputs", name
                )
        for port in node.ports:
            if port.name in inputs:
                self._check_type(port, inputs[port.name])
            elif not port.optional:
                fitting = [s for s in self.steps if port.product in self._products(Input(s))]
                hint = f"; a step that gives one: {', '.join(fitting)}" if fitting else ""
                raise self._error(
                    f"input {port.name!r} ({port.product.rsplit('.', 1)[1]}) is not wired{hint}", "inputs"
                )
        domain, takes = self._domain(node, ports, inputs)
        units = takes if domain == "take" and node.over != "dataset" else ("",)
        params = {unit: self._parameters(node, unit) for unit in units}
        return Step(
            self.name, node, inputs, params, domain, takes,
            self.document.place("steps", self.base), str(self.body.get("about") or ""), self.base,
            () if self.body.get("takes") is None else self._own_takes(self.body["takes"]),
        )  # fmt: skip

    def _error(self, message: str, *keys: str | int) -> DefinitionError:
        return DefinitionError(
            f"step {self.name!r}: {message}", self.document.place("steps", self.base, *keys)
        )

    def _node(self) -> NodeSpec:
        name = self.body.get("node")
        if not name:
            raise self._error("the key `node` is missing")
        if name not in self.catalogue.nodes:
            raise self._error(f"no node {name!r}: {nearest(name, self.catalogue.nodes)}", "node")
        return self.catalogue.nodes[name]

    def _products(self, wired: Input) -> tuple[str, ...]:
        """Qualified names of the product that an input gives, and of what it derives from; empty if no such part."""
        output = self.steps[wired.steps[0]].node.output
        for name in wired.part.split(".") if wired.part else ():
            inside = self.catalogue.products[output].inside
            if name not in inside:
                return ()
            output = inside[name]
        return self.catalogue.products[output].bases

    def _check_type(self, port: PortSpec, wired: Input) -> None:
        for name in wired.steps:
            self._check_one_type(port, Input(name, wired.part))

    def _check_one_type(self, port: PortSpec, wired: Input) -> None:
        given = self._products(wired)
        wanted = port.product.rsplit(".", 1)[1]
        if not given:
            source = self.catalogue.products[self.steps[wired.step].node.output]
            raise self._error(
                f"step {wired.step!r} has no output {wired.part!r}: {nearest(wired.part, source.inside)}",
                "inputs",
                port.name,
            )
        if port.product not in given:
            inner = self.catalogue.products[given[0]].inside
            parts = [
                name for name, kind in inner.items() if port.product in self.catalogue.products[kind].bases
            ]
            hint = f": did you mean '{wired.step}.{parts[0]}'?" if parts else ""
            raise self._error(
                f"input {port.name!r} must be {wanted}, but {wired.step!r} gives {given[0].rsplit('.', 1)[1]}{hint}",
                "inputs",
                port.name,
            )

    def _domain(
        self, node: NodeSpec, ports: Mapping[str, PortSpec], inputs: Mapping[str, Input]
    ) -> tuple[Domain, tuple[str, ...]]:
        own = self.body.get("takes")
        takes = tuple(self.takes) if own is None else self._own_takes(own)
        domains: dict[str, Domain] = {}
        for name, wired in inputs.items():
            source = self.steps[wired.steps[0]]
            domain: Domain = "single" if wired.item is not None else source.domain
            if wired.item is not None and wired.item not in source.units:
                raise self._error(
                    f"step {wired.step!r} has no item {wired.item!r}: {nearest(wired.item, source.units)}",
                    "inputs",
                    name,
                )
            if wired.gather and ports[name].many != "dataset":
                raise self._error(
                    f"input {name!r} takes one product; {wired.step} gathers several", "inputs", name
                )
            several = [name for name in wired.steps if self.steps[name].domain != "single"]
            if wired.gather and wired.item is None and several:
                raise self._error(
                    f"input {name!r} gathers one product per step, but {several[0]!r} gives one per "
                    f"{self.steps[several[0]].domain}: choose one of its items",
                    "inputs",
                    name,
                )
            if not wired.gather and domain != "single":
                takes = tuple(take for take in takes if take in source.takes)
            domains[name] = domain
            wanted: dict[str, tuple[str, ...]] = {
                "one": ("single", "take", "pair"), "pair": ("take", "single"), "dataset": ("take", "single"), "pairs": ("pair",)
            }  # fmt: skip
            if not wired.gather and domain not in wanted[ports[name].many]:
                raise self._error(
                    f"input {name!r} wants one product per {wanted[ports[name].many][0]}, "
                    f"but {wired.step!r} gives one per {domain}",
                    "inputs",
                    name,
                )
        ones = {name: domain for name, domain in domains.items() if ports[name].many == "one"}
        if node.over == "pair":
            if "pair" not in domains.values() and "take" not in domains.values():
                raise self._error(
                    f"node {node.name} works on pairs of takes, but no input has takes", "inputs"
                )
            return "pair", takes
        if node.over == "dataset":
            for name, domain in ones.items():
                if domain != "single":
                    raise self._error(
                        f"input {name!r} wants one product, but {inputs[name].step!r} gives one per {domain}: "
                        f"choose one, as '{inputs[name].step}/{takes[0] if takes else 'TAKE'}'",
                        "inputs",
                        name,
                    )
            return ("take" if node.output_many == "dataset" else "single"), takes
        if "take" in ones.values() and "pair" in ones.values():
            raise self._error(
                "inputs per take and inputs per pair of takes cannot meet in one step", "inputs"
            )
        if "pair" in ones.values():
            return "pair", takes
        if "take" in ones.values() or (not ones and node.over == "take"):
            return "take", takes
        return "single", takes

    def _own_takes(self, own: str | list[str]) -> tuple[str, ...]:
        names = [own] if isinstance(own, str) else [str(name) for name in own]
        for name in names:
            if name not in self.takes:
                raise self._error(f"no take {name!r}: {nearest(name, self.takes)}", "takes")
        return tuple(take for take in self.takes if take in names)

    def _parameters(self, node: NodeSpec, unit: str) -> dict[str, Any]:
        specs = {parameter.name: parameter for parameter in node.parameters}
        given = dict(self.body.get("params") or {})
        own: dict[str, Any] = {}
        variables = {**self.document.vars, **self.values}
        if unit:
            variables |= self.takes[unit]["vars"]
            own = self.takes[unit]["params"].get(self.base) or {}
            given |= own
        values: dict[str, Any] = {}
        for name, value in given.items():
            at = (
                ("takes", unit, "params", self.base, name)
                if name in own
                else ("steps", self.base, "params", name)
            )
            where = self.document.place(*at)
            if name not in specs:
                raise DefinitionError(
                    f"step {self.name!r}: node {node.name} has no parameter {name!r}: {nearest(name, specs)}",
                    where,
                )
            try:
                values[name] = check(fill(value, variables, where), specs[name])
            except DefinitionError:
                raise
            except ValueError as error:
                raise DefinitionError(f"step {self.name!r}: parameter {name!r} {error}", where) from error
            if specs[name].file:
                values[name] = self._existing(values[name], name, where)
        for name, spec in specs.items():
            if name not in values:
                if spec.required:
                    raise self._error(
                        f"parameter {name!r} ({spec.about}) has no default and is not set", "params"
                    )
                values[name] = (
                    float(spec.default)
                    if spec.schema == {"type": "number"} and spec.default is not None
                    else spec.default
                )
        return dict(sorted(values.items()))

    def _existing(self, path: Any, name: str, where: Place) -> Any:
        """Absolute paths of a file parameter; relative ones are tried from here, then from the pipeline's folder."""
        if isinstance(path, list):
            return [self._existing(item, name, where) for item in path]
        if not path:
            return path
        for base in (Path.cwd(), Path(self.document.file).resolve().parent):
            if (base / path).exists():
                return str((base / path).resolve())
        raise DefinitionError(
            f"step {self.name!r}: parameter {name!r}: no file or folder {path!r} "
            f"(looked from {Path.cwd()} and beside the pipeline file)",
            where,
        )
