"""The catalogue: every node of the package and of plug-ins, described without importing any of them.

Descriptions are read from the nodes' signatures once and kept beside the user's other caches, under a digest of all
sources; as long as no source changes, planning a pipeline imports no node and none of the libraries nodes use.
"""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import inspect
import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from reperform.nodes.distributions import plug_ins
from reperform.nodes.fingerprint import SourceTree

GROUP = "reperform.nodes"
# Prefix of node names, package with nodes, files of its top-level package by module.
Package = tuple[str, str, dict[str, Path]]
# What turns a signature into a description: where one of these changes, all nodes are read anew.
LAW = ("catalogue", "declaration", "fingerprint", "product", "schema")
KEPT = 16
_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+([\w.]+)[ \t]+import[ \t]+(\([^)]*\)|[^\n#]+)|import[ \t]+([^\n#]+))", re.MULTILINE
)


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
    """The catalogue of this installation. What no source changed comes from the cache, the rest is read anew."""
    packages = list(_packages())
    texts = {module: path.read_bytes() for _, _, files in packages for module, path in files.items()}
    kept = cache_folder() / f"catalogue-{_digest(*_state(packages, texts))}.json"
    try:
        return _from_json(json.loads(kept.read_text()))
    except (FileNotFoundError, ValueError, KeyError, TypeError):
        # absent or unreadable: it is only a copy of what the sources say
        described = _discover(packages, texts, _known(kept.parent))
    catalogue = _from_json(json.loads(json.dumps(described)))
    kept.parent.mkdir(parents=True, exist_ok=True)
    beside = kept.with_suffix(f".{os.getpid()}")
    beside.write_text(json.dumps(described))
    os.replace(beside, kept)
    for old in _newest(kept.parent)[KEPT:]:
        old.unlink(missing_ok=True)
    return catalogue


def _state(packages: list[Package], texts: Mapping[str, bytes]) -> Iterator[bytes]:
    yield repr(sys.version_info[:3]).encode()
    for prefix, package, files in packages:
        yield f"{prefix}={package}".encode()
        for module in files:
            yield from (module.encode(), texts[module])


def _digest(*parts: bytes) -> str:
    state = hashlib.blake2b(digest_size=16)
    for part in parts:
        state.update(len(part).to_bytes(8, "little") + part)
    return state.hexdigest()


def _newest(folder: Path) -> list[Path]:
    return sorted(folder.glob("catalogue-*.json"), key=lambda path: path.stat().st_mtime, reverse=True)


def _known(folder: Path) -> dict[str, Any]:
    """Descriptions of modules in the newest catalogues kept, by digest of all that they stand on."""
    known: dict[str, Any] = {}
    for path in _newest(folder)[:4]:
        try:
            known = json.loads(path.read_text())["modules"] | known
        except (FileNotFoundError, ValueError, KeyError, TypeError):
            continue
    return known


def cache_folder() -> Path:
    """The folder for what can be made again: `$XDG_CACHE_HOME/reperform`, by default in `~/.cache`."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "reperform"


def _packages() -> Iterator[Package]:
    """The own stations, then plug-ins by entry point."""
    yield "", "reperform.nodes", _modules("reperform.nodes", os.path.dirname(__file__))
    for name, value in sorted(plug_ins(GROUP)):
        package = value.partition(":")[0]
        top = package.partition(".")[0]
        spec = importlib.util.find_spec(top)
        if spec is None or spec.origin is None:
            raise ImportError(
                f"plug-in {name!r} ({GROUP}) names module {package!r}, which cannot be found: reinstall it"
            )
        inside = bool(spec.submodule_search_locations)
        files = _modules(top, os.path.dirname(spec.origin)) if inside else {top: Path(spec.origin)}
        yield f"{name}.", package, files


def _modules(package: str, folder: str) -> dict[str, Path]:
    found = {}
    for place, folders, files in os.walk(folder):
        folders.sort()
        inside = place[len(folder) :].strip(os.sep).split(os.sep) if place != folder else []
        for file in sorted(files):
            if file.endswith(".py"):
                parts = [package, *inside] if file == "__init__.py" else [package, *inside, file[:-3]]
                found[".".join(parts)] = Path(place, file)
    return found


def _discover(
    packages: list[Package], texts: Mapping[str, bytes], known: Mapping[str, Any]
) -> dict[str, dict[str, Any]]:
    """Descriptions of all modules that declare nodes, by digest of each and of all that it imports."""
    inits = {module for _, _, files in packages for module, path in files.items() if path.stem == "__init__"}
    tree = SourceTree(lambda name: texts[name].decode() if name in texts else None, inits)
    needs = {module: _imported(module, text, texts, module in inits) for module, text in texts.items()}
    law = [texts[f"reperform.nodes.{name}"] for name in LAW]
    found: dict[str, Any] = {}
    for prefix, package, files in packages:
        for module in files:
            if b"@" not in texts[module] or not f"{module}.".startswith(f"{package}."):
                continue
            closure = _closure(module, needs)
            digest = _digest(
                prefix.encode(),
                module.encode(),
                *law,
                *(part for m in closure for part in (m.encode(), texts[m])),
            )
            found[digest] = known[digest] if digest in known else _read_module(prefix, module, tree)
    return {"modules": found}


def _imported(module: str, text: bytes, known: Mapping[str, Any], is_package: bool) -> set[str]:
    """Modules among the known that a module imports anywhere (or seems to: one too many does no harm)."""
    names: set[str] = set()
    for match in _IMPORT.finditer(text.decode()):
        source, things = match[1] or "", match[2] or match[3] or ""
        level = len(source) - len(source.lstrip("."))
        if level:
            parts = module.split(".")
            parents = parts[: len(parts) - level + is_package]
            source = ".".join([*parents, *filter(None, [source[level:]])])
        words = [part.split()[0] for part in things.strip("()").split(",") if part.split()]
        names |= {source} | {f"{source}.{word}" if source else word for word in words}
    return names & known.keys()


def _closure(module: str, needs: Mapping[str, set[str]]) -> list[str]:
    reached: set[str] = set()
    todo = [module]
    while todo:
        name = todo.pop()
        if name not in reached:
            reached.add(name)
            todo += needs[name]
    return sorted(reached)


def _read_module(prefix: str, module: str, tree: SourceTree) -> dict[str, Any]:
    """Import one module and describe its nodes and their products."""
    nodes: list[dict[str, Any]] = []
    products: dict[str, ProductSpec] = {}
    for function in _declared(importlib.import_module(module)):
        station = prefix or f"{module.split('.')[2]}."
        nodes.append(asdict(_describe(f"{station}{function.__name__}", function, tree, products)))
    return {"nodes": nodes, "products": [asdict(product) for product in products.values()]}


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
    nodes: dict[str, NodeSpec] = {}
    products: dict[str, ProductSpec] = {}
    for entry in data["modules"].values():
        for raw in entry["nodes"]:
            if raw["name"] in nodes:
                first = nodes[raw["name"]].module
                raise NameError(f"two nodes are called {raw['name']!r}: in {first} and in {raw['module']}")
            nodes[raw["name"]] = _node(raw)
        for raw in entry["products"]:
            if raw["name"] not in products:
                products[raw["name"]] = _product(raw)
    return Catalogue(dict(sorted(nodes.items())), products)


def _node(raw: Mapping[str, Any]) -> NodeSpec:
    return NodeSpec(
        **{
            **raw,
            "window": tuple(raw["window"]),
            "ports": tuple(PortSpec(**port) for port in raw["ports"]),
            "parameters": tuple(ParameterSpec(**parameter) for parameter in raw["parameters"]),
        }
    )


def _product(raw: Mapping[str, Any]) -> ProductSpec:
    fields = {k: FieldSpec(tuple(f["axes"]), f["dtype"], f["unit"]) for k, f in raw["fields"].items()}
    return ProductSpec(raw["name"], raw["module"], raw["about"], fields, raw["inside"], tuple(raw["bases"]))
