"""Any product as a NumPy archive."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from reperform.nodes.export.atomic import beside
from reperform.nodes.product import flatten, product_fields


def write_npz(path: Path, product: Any) -> None:
    """All fields by their (dotted) names, compressed; complete or absent.

    A field whose shape differs from frame to frame becomes one array per frame, `field.00000`,
    `field.00001`, ...
    """
    arrays: dict[str, np.ndarray] = {}
    fields = product_fields(type(product))
    for name, value in flatten(product).items():
        if fields[name].ragged:
            arrays |= {f"{name}.{k:05d}": np.asarray(value[k]) for k in range(len(value))}
        else:
            arrays[name] = np.asarray(value)
    # Not np.savez: a field may be called `file`; and the entries carry no time, so equal products give equal files.
    with beside(path) as draft, zipfile.ZipFile(draft, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            with archive.open(zipfile.ZipInfo(f"{name}.npy"), "w", force_zip64=True) as entry:
                np.lib.format.write_array(entry, np.ascontiguousarray(array), allow_pickle=False)
