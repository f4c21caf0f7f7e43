"""Tables of figures."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes


class Table(NamedTuple):
    """Figures with their targets. `holds` is 1 where the target is met, 0 where not, -1 where unmeasured."""

    figure: Annotated[np.ndarray, Axes("row", dtype="str")]
    value: Annotated[np.ndarray, Axes("row", dtype="float64")]
    unit: Annotated[np.ndarray, Axes("row", dtype="str")]
    # "<=", ">=" or "" (stated only)
    side: Annotated[np.ndarray, Axes("row", dtype="str")]
    target: Annotated[np.ndarray, Axes("row", dtype="float64")]
    holds: Annotated[np.ndarray, Axes("row", dtype="int8")]
    peer: Annotated[np.ndarray, Axes("row", dtype="str")]
    peer_value: Annotated[np.ndarray, Axes("row", dtype="float64")]
    source: Annotated[np.ndarray, Axes("row", dtype="str")]
