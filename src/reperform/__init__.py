"""From multi-camera footage of an actor to a character that can be directed.

The public names: declare a node with `node`, `Param`, `File` and `Axes`; open a pipeline with `load`.
"""

from typing import TYPE_CHECKING, Any

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.product import Axes, Dataset, Pair, Pairs
from reperform.nodes.ragged import Ragged

if TYPE_CHECKING:
    from reperform.graphs.api import load

__all__ = ["Axes", "Dataset", "File", "Pair", "Pairs", "Param", "Ragged", "load", "node"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    # `load` pulls in the pipeline reader, which a module that only declares nodes does not need.
    if name == "load":
        from reperform.graphs.api import load

        return load
    raise AttributeError(f"module 'reperform' has no attribute {name!r}")
