"""A node is a pure function whose signature is its declaration."""

from __future__ import annotations

import inspect
import types
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, TypeVar

from reperform.nodes.product import is_product, product_fields

Over = Literal["view", "frame", "take", "pair", "dataset"]
F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True)
class Param:
    """Unit, bounds (inclusive) and meaning of a parameter: `Annotated[float, Param("m", 0.002, 0.1, "edge")]`."""

    unit: str = "1"
    lower: float | None = None
    upper: float | None = None
    about: str = ""
    # A parameter that cannot change the result (worker counts, verbosity) is left out of the key.
    in_key: bool = True


@dataclass(frozen=True)
class File:
    """Marks a `str` parameter as a file or folder; the node gets its absolute path.

    Its content, not its path, is in the cache key. `in_key=False` leaves it out, for nodes whose input products
    already carry digests of what they will read there.
    """

    about: str = ""
    in_key: bool = True


@dataclass(frozen=True)
class Declaration:
    """What `@node` records on the function; everything else is read from the signature on demand."""

    over: Over
    window: tuple[int, int] = (0, 0)
    volatile: bool = False
    memory: float = 0.5
    threads: int = 1


@dataclass(frozen=True)
class Port:
    """A product that goes in: its name, type, and how many of them the node sees."""

    name: str
    kind: type
    many: Literal["one", "pair", "dataset", "pairs"] = "one"
    optional: bool = False


@dataclass(frozen=True)
class Parameter:
    """A keyword-only parameter: its name, type as in the signature, default and `Param` or `File`."""

    name: str
    annotation: Any
    default: Any = inspect.Parameter.empty
    param: Param = field(default_factory=Param)
    file: File | None = None


@dataclass(frozen=True)
class Signature:
    """The ports, parameters and output of a node, as its signature says."""

    ports: tuple[Port, ...]
    parameters: tuple[Parameter, ...]
    output: type
    # "dataset": the node returns one product per take (a mapping).
    output_many: Literal["one", "dataset"] = "one"


def node(
    *,
    over: Over,
    window: tuple[int, int] = (0, 0),
    volatile: bool = False,
    memory: float = 0.5,
    threads: int = 1,
) -> Callable[[F], F]:
    """Declare a pure function as a node. The function stays callable as it stands.

    over: what one call sees: a view (one frame of one camera), a frame, a take, an ordered pair of takes or the
        whole dataset.
    window: (before, after), for frame nodes: the call also gets that many neighbours, clipped at the ends; the
        frame axis stays, and the parameter `centre` (int, declared last) says which of them is the item's frame.
    volatile: the node measures (time, a peer): it runs whenever its pipeline runs.
    memory: GB that one call needs at most.  threads: threads that one call keeps busy.

    Raises TypeError where the signature is not a declaration.
    """

    def declare(function: F) -> F:
        if window != (0, 0) and over != "frame":
            raise TypeError(f"node {function.__name__}: window is for over='frame', not over={over!r}")
        function.__node__ = Declaration(over, window, volatile, memory, threads)  # type: ignore[attr-defined]
        return function

    return declare


def read_signature(function: Callable[..., Any]) -> Signature:
    """Read ports, parameters and output from a node's signature. Raises TypeError with what is missing."""
    who = f"node {function.__module__}.{function.__name__}"
    hints = typing.get_type_hints(function, include_extras=True)
    ports, parameters = [], []
    for name, parameter in inspect.signature(function).parameters.items():
        if name not in hints:
            raise TypeError(f"{who}: {name!r} has no annotation")
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY:
            if name != "centre":
                parameters.append(_read_parameter(name, hints[name], parameter.default, who))
        elif parameter.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD:
            ports.append(_read_port(name, hints[name], parameter.default, who))
        else:
            raise TypeError(f"{who}: {name!r} must be positional (a product) or keyword-only (a parameter)")
    if "return" not in hints:
        raise TypeError(f"{who}: the return annotation (the product that comes out) is missing")
    output, many = hints["return"], "one"
    if typing.get_origin(output) in (Mapping, dict) or getattr(output, "__origin__", None) is Mapping:
        output, many = typing.get_args(output)[1], "dataset"
    if not is_product(output):
        raise TypeError(f"{who}: the return annotation must be a product, got {output}")
    product_fields(output)
    return Signature(tuple(ports), tuple(parameters), output, many)  # type: ignore[arg-type]


def _read_port(name: str, hint: Any, default: Any, who: str) -> Port:
    optional = default is None
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        hint = next(kind for kind in typing.get_args(hint) if kind is not type(None))
    many: Literal["one", "pair", "dataset", "pairs"] = "one"
    args = typing.get_args(hint)
    if typing.get_origin(hint) is tuple and len(args) == 2 and args[0] is args[1]:
        hint, many = args[0], "pair"
    elif args and getattr(typing.get_origin(hint), "__name__", "") == "Mapping":
        hint, many = args[1], ("dataset" if args[0] is str else "pairs")
    if not is_product(hint):
        raise TypeError(f"{who}: input {name!r} must be a product, Pair, Dataset or Pairs of one, got {hint}")
    return Port(name, hint, many, optional)


def _read_parameter(name: str, hint: Any, default: Any, who: str) -> Parameter:
    param, file = Param(), None
    if typing.get_origin(hint) is Annotated:
        base, *extras = typing.get_args(hint)
        hint = base
        param = next((extra for extra in extras if isinstance(extra, Param)), param)
        file = next((extra for extra in extras if isinstance(extra, File)), None)
    allowed = (bool, int, float, str)
    flat = typing.get_args(hint) or (hint,)
    simple = typing.get_origin(hint) is Literal or all(
        kind in (*allowed, type(None), Ellipsis) or typing.get_origin(kind) in (list, tuple, dict, Literal)
        for kind in flat
    )
    if not simple:
        raise TypeError(
            f"{who}: parameter {name!r} must be a bool, int, float, str, Literal, or a list of these"
        )
    return Parameter(name, hint, default, param, file)
