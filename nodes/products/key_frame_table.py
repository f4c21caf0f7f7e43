"""Key-framed synthesis summed up, one row per key-frame sequence."""

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.product import Axes

_METRES = Axes("row", dtype="float64", unit="m")
_SECONDS = Axes("row", dtype="float64", unit="s")
_SHARE = Axes("row", dtype="float64", unit="1")


class KeyFrameTable(NamedTuple):
    """Least, root mean square and greatest errors over all targets that are met; nan: not measured."""

    character: Annotated[np.ndarray, Axes("row", dtype="str")]
    keys: Annotated[np.ndarray, Axes("row", dtype="str")]
    smoothness_min: Annotated[np.ndarray, _METRES]
    smoothness_max: Annotated[np.ndarray, _METRES]
    distance_min: Annotated[np.ndarray, _METRES]
    distance_rms: Annotated[np.ndarray, _METRES]
    distance_max: Annotated[np.ndarray, _METRES]
    duration_min: Annotated[np.ndarray, _SECONDS]
    duration_rms: Annotated[np.ndarray, _SECONDS]
    duration_max: Annotated[np.ndarray, _SECONDS]
    relative_distance_rms: Annotated[np.ndarray, _SHARE]
    relative_distance_max: Annotated[np.ndarray, _SHARE]
    relative_duration_rms: Annotated[np.ndarray, _SHARE]
    relative_duration_max: Annotated[np.ndarray, _SHARE]
    # of all targets: proved that no walk meets them; neither met nor disproved
    infeasible: Annotated[np.ndarray, _SHARE]
    undecided: Annotated[np.ndarray, _SHARE]
    # greatest cost - bound
    gap: Annotated[np.ndarray, _SHARE]
    # to fill the table, and per target then
    prepare: Annotated[np.ndarray, _SECONDS]
    target: Annotated[np.ndarray, _SECONDS]
