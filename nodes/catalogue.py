"""The catalogue: every node of the package and of plug-ins, described without importing any of them.

Descriptions are read from the nodes' signatures once and kept beside the user's other caches, under a digest of all
sources; as long as no source changes, planning a pipeline imports no node and none of the libraries nodes use.
"""

from __future__ import annotations

import hashlib
import importlib
import importlib.metadata
import importlib.util
import inspect
import json
import os
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from reperform.nodes.fingerprint import SourceTree

GROUP = "reperform.nodes"


@dataclass(frozen=True)
class PortSpec:
    """A product that goes in: type by its qualified name; many: one, pair, dataset or pairs."""

    name: str
    product: str
    many: str
    optional: bool


@dataclass(frozen=True)
class ParameterSpec:
    """A parameter: JSON Schema of its type, default, unit, bounds, meaning; file: its content is the value."""

    name: str
    schema: dict[str, Any]
    required: bool
    default: Any
    unit: str
    lower: float | None
    upper: float | None
    about: str
    in_key: bool
    file: bool


@dataclass(frozen=True)
class NodeSpec:
    """All that is known of a node without importing it."""

    name: str
    module: str
    function: str
    doc: str
    over: str
    window: tuple[int, int]
    volatile: bool
    memory: float
    threads: int
    ports: tuple[PortSpec, ...]
    parameters: tuple[ParameterSpec, ...]
    output: str
    output_many: str
    # `module:name` -> hash of everything the node reaches in its package
    functions: dict[str, str]

    @property
    def fingerprint(self) -> str:
        """One hash of the node's code and all that it reaches."""
        return hashlib.blake2b(
            json.dumps(self.functions, sort_keys=True).encode(), digest_size=16
        ).hexdigest()

    def load(self) -> Callable[..., Any]:
        """Import the node's function."""
        return getattr(importlib.import_module(self.module), self.function)


@dataclass(frozen=True)
class FieldSpec:
    """A field of a product: axes, dtype, unit, as declared."""

    axes: tuple[str, ...]
    dtype: str
    unit: str

    @property
    def items(self) -> tuple[str, ...]:
        """The item axes (`frame`, `camera`) of the field."""
        return tuple(axis for axis in self.axes if axis in ("frame", "camera"))

    @property
    def ragged(self) -> bool:
        """Whether the shape differs from frame to frame."""
        return any(axis.endswith("*") for axis in self.axes)


@dataclass(frozen=True)
class ProductSpec:
    """A product type: its fields by (dotted) name, and the types of the products inside it by prefix."""

    name: str
    module: str
    about: str
    fields: dict[str, FieldSpec]
    inside: dict[str, str]
    # qualified names of the classes it derives from, itself first
    bases: tuple[str, ...] = ()

    def load(self) -> type:
        """Import the product's class."""
        return getattr(importlib.import_module(self.module), self.name.rsplit(".", 1)[1])


@dataclass(frozen=True)
class Catalogue:
    """Nodes by name and product types by qualified name."""

    nodes: dict[str, NodeSpec]
    products: dict[str, ProductSpec]


def read_catalogue() -> Catalogue:
    """The catalogue of this installation: from the cache where no source changed, else read anew."""
    sources = list(_packages())
    state = hashlib.blake2b(repr(sys.version_info[:3]).encode(), digest_size=16)
    for prefix, package, files in sources:
        state.update(f"{prefix}={package}".encode())
        for module, path in (files if not prefix else _top_files(package.partition(".")[0])).items():
            state.update(module.encode())
            state.update(path.read_bytes())
    kept = cache_folder() / f"catalogue-{state.hexdigest()}.json"
    try:
        return _from_json(json.loads(kept.read_text()))
    except (FileNotFoundError, ValueError, KeyError, TypeError):
        # absent or unreadable: it is only a copy of what the sources say
        catalogue = _discover(sources)
    kept.parent.mkdir(parents=True, exist_ok=True)
    beside = kept.with_suffix(f".{os.getpid()}")
    beside.write_text(
        json.dumps(
            {
                "nodes": [asdict(n) for n in catalogue.nodes.values()],
                "products": [asdict(p) for p in catalogue.products.values()],
            }
        )
    )
    os.replace(beside, kept)
    return catalogue


def cache_folder() -> Path:
    """The folder for what can be made again: `$XDG_CACHE_HOME/reperform`, by default in `~/.cache`."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "reperform"


def _packages() -> Iterator[tuple[str, str, dict[str, Path]]]:
    """(prefix of node names, package, module -> file): the own stations, then plug-ins by entry point."""
    yield "", "reperform.nodes", _modules("reperform.nodes", Path(__file__).parent)
    for entry in sorted(importlib.metadata.entry_points(group=GROUP), key=lambda e: (e.name, e.value)):
        package = entry.value.partition(":")[0]
        spec = importlib.util.find_spec(package)
        if spec is None or spec.origin is None:
            raise ImportError(
                f"plug-in {entry.name!r} ({GROUP}) names module {package!r}, which cannot be found: reinstall it"
            )
        origin = Path(spec.origin)
        files = _modules(package, origin.parent) if spec.submodule_search_locations else {package: origin}
        yield f"{entry.name}.", package, files


def _modules(package: str, folder: Path) -> dict[str, Path]:
    found = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.relative_to(folder).with_suffix("").parts
        parts = parts[:-1] if parts[-1] == "__init__" else parts
        found[".".join((package, *parts))] = path
    return found


def _discover(sources: list[tuple[str, str, dict[str, Path]]]) -> Catalogue:
    nodes: dict[str, NodeSpec] = {}
    products: dict[str, ProductSpec] = {}
    texts: dict[str, Path] = {module: path for _, _, files in sources for module, path in files.items()}
    for prefix, package, files in sources:
        top = package.partition(".")[0]
        folder_of_top = _top_files(top) if top != "reperform" else files
        tree = SourceTree(
            lambda name, known=folder_of_top | texts: known[name].read_text() if name in known else None
        )
        for module in files:
            if "@" not in files[module].read_text():
                continue
            for function in _declared(importlib.import_module(module)):
                name = (
                    f"{prefix}{function.__name__}"
                    if prefix
                    else f"{module.split('.')[2]}.{function.__name__}"
                )
                if name in nodes:
                    raise TypeError(f"two nodes are called {name!r}: in {nodes[name].module} and in {module}")
                nodes[name] = _describe(name, function, tree, products)
    return Catalogue(dict(sorted(nodes.items())), products)


def _top_files(top: str) -> dict[str, Path]:
    spec = importlib.util.find_spec(top)
    if spec is None or spec.origin is None:
        return {}
    return (
        _modules(top, Path(spec.origin).parent)
        if spec.submodule_search_locations
        else {top: Path(spec.origin)}
    )


def _declared(module: Any) -> list[Callable[..., Any]]:
    return [
        value
        for value in vars(module).values()
        if getattr(value, "__module__", None) == module.__name__
        and "__node__" in getattr(value, "__dict__", {})
    ]


def _describe(
    name: str, function: Callable[..., Any], tree: SourceTree, products: dict[str, ProductSpec]
) -> NodeSpec:
    from reperform.nodes.declaration import read_signature
    from reperform.nodes.schema import parameter_spec, product_spec

    declaration = function.__node__  # type: ignore[attr-defined]
    signature = read_signature(function)
    for kind in (signature.output, *(port.kind for port in signature.ports)):
        product_spec(kind, products)
    functions = tree.functions(function.__module__, function.__name__)
    functions |= tree.functions(signature.output.__module__, signature.output.__name__)
    return NodeSpec(
        name,
        function.__module__,
        function.__name__,
        inspect.getdoc(function) or "",
        declaration.over,
        declaration.window,
        declaration.volatile,
        declaration.memory,
        declaration.threads,
        tuple(PortSpec(p.name, product_spec(p.kind, products), p.many, p.optional) for p in signature.ports),
        tuple(parameter_spec(p, name) for p in signature.parameters),
        product_spec(signature.output, products),
        signature.output_many,
        functions,
    )


def _from_json(data: dict[str, Any]) -> Catalogue:
    nodes = {}
    for raw in data["nodes"]:
        raw["window"] = tuple(raw["window"])
        raw["ports"] = tuple(PortSpec(**port) for port in raw["ports"])
        raw["parameters"] = tuple(ParameterSpec(**parameter) for parameter in raw["parameters"])
        nodes[raw["name"]] = NodeSpec(**raw)
    products = {}
    for raw in data["products"]:
        fields = {k: FieldSpec(tuple(f["axes"]), f["dtype"], f["unit"]) for k, f in raw["fields"].items()}
        products[raw["name"]] = ProductSpec(
            raw["name"], raw["module"], raw["about"], fields, raw["inside"], tuple(raw["bases"])
        )
    return Catalogue(nodes, products)
