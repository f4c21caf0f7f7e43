"""From multi-camera footage of an actor to a character that can be directed.

The public names: declare a node with `node`, `Param`, `File` and `Axes`; open a pipeline with `load`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from reperform.graphs.api import load
    from reperform.nodes.declaration import File, Param, node
    from reperform.nodes.product import Axes, Dataset, Pair, Pairs
    from reperform.nodes.ragged import Ragged

__all__ = ["Axes", "Dataset", "File", "Pair", "Pairs", "Param", "Ragged", "load", "node"]
__version__ = "0.1.0"

# Imported when asked for: a run with nothing to do needs no numpy, a module of nodes no pipeline reader.
_HOMES = {
    "reperform.graphs.api": ("load",),
    "reperform.nodes.declaration": ("File", "Param", "node"),
    "reperform.nodes.product": ("Axes", "Dataset", "Pair", "Pairs"),
    "reperform.nodes.ragged": ("Ragged",),
}


def __getattr__(name: str) -> Any:
    for module, names in _HOMES.items():
        if name in names:
            return getattr(import_module(module), name)
    raise AttributeError(f"module 'reperform' has no attribute {name!r}")
