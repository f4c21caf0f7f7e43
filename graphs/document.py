"""Pipeline documents: files read, included, merged, overridden; variables filled in."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from reperform.graphs.errors import DefinitionError, Place, nearest
from reperform.graphs.prefix import all_takes, put_under_prefix
from reperform.graphs.yaml_source import Keys, parse_yaml, read_yaml

SHIPPED = Path(__file__).parent
TOP_KEYS = {
    "about": str, "include": (str, list, dict), "vars": dict, "matrix": dict, "takes": (str, list, dict),
    "steps": dict, "exports": dict,
}  # fmt: skip
STEP_KEYS = {"node": str, "inputs": dict, "params": dict, "about": str, "takes": (str, list)}
_VARIABLE = re.compile(r"\$\{([^{}]*)\}")


@dataclass
class Document:
    """The merged content of a pipeline file and all that it includes, and where every part of it stands."""

    name: str
    file: str
    about: str = ""
    vars: dict[str, Any] = field(default_factory=dict)
    matrix: dict[str, list[Any]] = field(default_factory=dict)
    takes: Any = None
    steps: dict[str, dict[str, Any]] = field(default_factory=dict)
    exports: dict[str, str] = field(default_factory=dict)
    places: dict[Keys, Place] = field(default_factory=dict)

    def place(self, *keys: str | int) -> Place:
        """Where a part of the document stands, or the nearest enclosing one."""
        while keys and keys not in self.places:
            keys = keys[:-1]
        return self.places.get(keys, Place(self.file, 1))


def find_pipeline(name: str, place: Place | None = None) -> Path:
    """The file of a pipeline: a path, or the bare name of a shipped one."""
    path = Path(name)
    if path.is_file():
        return path
    shipped = SHIPPED / f"{name}.yaml"
    if shipped.is_file():
        return shipped
    known = sorted(p.relative_to(SHIPPED).with_suffix("").as_posix() for p in SHIPPED.rglob("*.yaml"))
    raise DefinitionError(
        f"no pipeline {name!r}: neither a file nor a shipped pipeline; {nearest(name, known)}", place
    )


def read_document(path: Path, sets: Sequence[str] = ()) -> Document:
    """Read a pipeline file with its includes, then apply `STEP.PARAM=VALUE` and `VARIABLE=VALUE` overrides."""
    document = _read(path, ())
    for override in sets:
        _override(document, override)
    return document


def _read(path: Path, above: tuple[Path, ...], place: Place | None = None) -> Document:
    if path.resolve() in above:
        raise DefinitionError(
            f"include: {path} includes itself by way of {' -> '.join(p.name for p in above)}", place
        )
    source = read_yaml(path)
    name = path.stem
    if SHIPPED in path.resolve().parents:
        name = path.resolve().relative_to(SHIPPED).with_suffix("").as_posix()
    document = Document(name, str(path))
    if not isinstance(source.value, dict):
        raise DefinitionError("a pipeline file is a mapping with the key `steps`", source.place())
    _check_keys(source.value, TOP_KEYS, "a pipeline", source.place, ())
    includes = source.value.get("include", [])
    for k, include in enumerate(includes if isinstance(includes, list) else [includes]):
        where = source.place("include", k) if isinstance(includes, list) else source.place("include")
        entry = {"pipeline": include} if isinstance(include, str) else include
        if not isinstance(entry, dict) or "pipeline" not in entry or set(entry) - {"pipeline", "vars", "as"}:
            raise DefinitionError(
                "include: expected a name or path, or {pipeline: ..., as: PREFIX, vars: {...}}", where
            )
        beside = path.parent / str(entry["pipeline"])
        inner = _read(
            beside if beside.is_file() else find_pipeline(str(entry["pipeline"]), where),
            (*above, path.resolve()),
            where,
        )
        inner.vars |= entry.get("vars", {})
        if "as" in entry:
            _put_beside(document, inner, str(entry["as"]), where)
        _merge(document, inner)
    own = Document(name, str(path), places={keys: source.place(*keys) for keys in source.lines})
    for key, value in source.value.items():
        if key != "include" and value is not None:
            setattr(own, key, value)
    for variable, values in own.matrix.items():
        if not isinstance(values, list) or not values:
            raise DefinitionError(
                f"matrix: {variable!r} must be a list of values, got {values!r}",
                source.place("matrix", variable),
            )
    for step, body in own.steps.items():
        if not isinstance(body, dict):
            raise DefinitionError(
                f"step {step!r} must be a mapping with the key `node`", source.place("steps", step)
            )
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_-]*", step):
            raise DefinitionError(
                f"step {step!r}: a name is letters, digits, _ and -", source.place("steps", step)
            )
        _check_keys(body, STEP_KEYS, f"step {step!r}", source.place, ("steps", step))
    _merge(document, own)
    return document


def _put_beside(document: Document, inner: Document, prefix: str, place: Place) -> None:
    """Put an included pipeline under a prefix, and the takes of both together."""
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", prefix):
        raise DefinitionError(f"include: `as` is letters, digits and _, got {prefix!r}", place)
    put_under_prefix(inner, prefix, read_takes(inner))
    inner.takes = all_takes(read_takes(document) if document.steps else {}, inner.takes, place)


def _check_keys(value: Mapping[str, Any], known: Mapping[str, Any], who: str, place: Any, at: Keys) -> None:
    for key, inner in value.items():
        if key not in known:
            raise DefinitionError(f"{who} has no key {key!r}: {nearest(key, known)}", place(*at, key))
        if inner is not None and not isinstance(inner, known[key]):
            kinds = known[key] if isinstance(known[key], tuple) else (known[key],)
            names = {dict: "a mapping", list: "a list", str: "text"}
            expected = " or ".join(names[kind] for kind in kinds)
            raise DefinitionError(f"{who}: {key} must be {expected}, got {inner!r}", place(*at, key))


def _merge(base: Document, over: Document) -> None:
    """Lay one document over another: mappings merge key by key, everything else is replaced."""
    for step, body in over.steps.items():
        merged = base.steps.setdefault(step, {})
        for key, value in body.items():
            merged[key] = {**merged.get(key, {}), **value} if isinstance(value, dict) else value
    base.vars |= over.vars
    base.matrix |= over.matrix
    base.exports |= over.exports
    base.takes = base.takes if over.takes is None else over.takes
    base.about = over.about or base.about
    base.places |= over.places
    base.name, base.file = over.name, over.file


def _override(document: Document, override: str) -> None:
    target, equals, text = override.partition("=")
    place = Place(f"--set {override}", 0)
    if not equals:
        raise DefinitionError("expected STEP.PARAM=VALUE or VARIABLE=VALUE", place)
    value = parse_yaml(text, f"--set {override}").value if text.strip() else ""
    step, dot, parameter = target.partition(".")
    if dot:
        if step not in document.steps:
            raise DefinitionError(f"no step {step!r}: {nearest(step, document.steps)}", place)
        document.steps[step]["params"] = {**(document.steps[step].get("params") or {}), parameter: value}
        document.places["steps", step, "params", parameter] = place
    elif target in document.matrix:
        document.matrix[target] = value if isinstance(value, list) else [value]
    elif target in document.vars or target == "data":
        document.vars[target] = value
    else:
        raise DefinitionError(f"no variable {target!r}: {nearest(target, document.vars)}", place)


def fill(value: Any, variables: Mapping[str, Any], place: Place) -> Any:
    """Fill `${name}` and `${env.NAME:default}` in; a text that is just one variable takes its value as it is."""
    if isinstance(value, list):
        return [fill(item, variables, place) for item in value]
    if isinstance(value, dict):
        return {key: fill(item, variables, place) for key, item in value.items()}
    if not isinstance(value, str) or "${" not in value:
        return value
    whole = _VARIABLE.fullmatch(value)
    if whole:
        return _variable(whole[1], variables, place)
    return _VARIABLE.sub(lambda match: str(_variable(match[1], variables, place)), value)


def variables_in(value: Any) -> set[str]:
    """Names of the variables that a value mentions."""
    if isinstance(value, list):
        return set().union(*map(variables_in, value)) if value else set()
    if isinstance(value, dict):
        return variables_in(list(value.values()))
    return set(_VARIABLE.findall(value)) if isinstance(value, str) else set()


def _variable(name: str, variables: Mapping[str, Any], place: Place) -> Any:
    if name.startswith("env."):
        variable, _, default = name[4:].partition(":")
        return os.environ.get(variable, default)
    if name in variables:
        return fill(variables[name], {k: v for k, v in variables.items() if k != name}, place)
    if name == "data":
        return str(data_folder(place))
    raise DefinitionError(f"no variable {name!r}: {nearest(name, [*variables, 'data'])}", place)


def data_folder(place: Place | None = None) -> Path:
    """The folder of real footage: `REPERFORM_DATA`, else `../shared/data`. Raises DefinitionError if missing."""
    if given := os.environ.get("REPERFORM_DATA"):
        if Path(given).is_dir():
            return Path(given).resolve()
        raise DefinitionError(f"REPERFORM_DATA names {given}, which is no folder", place)
    looked = [Path("../shared/data"), SHIPPED.resolve().parents[1] / "shared" / "data"]
    for folder in looked:
        if folder.is_dir():
            return folder.resolve()
    raise DefinitionError(
        f"the footage is missing: no folder {' or '.join(map(str, looked))}; set the environment variable "
        "REPERFORM_DATA (or --set data=FOLDER) to where it is",
        place,
    )


def read_takes(document: Document) -> dict[str, dict[str, Any]]:
    """Takes in order: name -> its variables (`take`, `path` and those it sets) and `params` by step."""
    place = document.place("takes")
    takes = document.takes
    if takes is None:
        return {"take": {"vars": {"take": "take"}, "params": {}}}
    if isinstance(takes, str) or (isinstance(takes, dict) and set(takes) == {"glob"}):
        pattern = str(fill(takes if isinstance(takes, str) else takes["glob"], document.vars, place))
        paths = sorted(glob.glob(pattern))
        if not paths:
            raise DefinitionError(f"takes: nothing matches {pattern!r} (looked from {Path.cwd()})", place)
        return {
            Path(p).stem: {"vars": {"take": Path(p).stem, "path": os.path.abspath(p)}, "params": {}}
            for p in paths
        }
    entries = {str(name): None for name in takes} if isinstance(takes, list) else takes
    found = {}
    for name, body in entries.items():
        body = body or {}
        if not isinstance(body, dict) or set(body) - {"vars", "params"}:
            raise DefinitionError(
                f"take {name!r}: expected {{vars: ..., params: {{STEP: ...}}}}", document.place("takes", name)
            )
        if "/" in name:
            raise DefinitionError(f"take {name!r}: a name has no slash", document.place("takes", name))
        for step in body.get("params") or {}:
            if step not in document.steps:
                raise DefinitionError(
                    f"take {name!r} sets parameters of an unknown step {step!r}: {nearest(step, document.steps)}",
                    document.place("takes", name, "params", step),
                )
            if not isinstance(body["params"][step] or {}, dict):
                raise DefinitionError(
                    f"take {name!r}: parameters of step {step!r} must be a mapping",
                    document.place("takes", name, "params", step),
                )
        found[name] = {"vars": {"take": name, **(body.get("vars") or {})}, "params": body.get("params") or {}}
    if not found:
        raise DefinitionError("takes: the list is empty", place)
    return found
