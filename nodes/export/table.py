"""Tables as CSV."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from reperform.nodes.export.atomic import beside
from reperform.nodes.products.key_frame_table import KeyFrameTable
from reperform.nodes.products.table import Table


def write_csv(path: Path, table: Table | KeyFrameTable) -> None:
    """One line per row, a header line first; numbers with all their digits, UTF-8; complete or absent."""
    columns = [np.asarray(column).tolist() for column in table]
    with beside(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(table._fields)
        writer.writerows(zip(*columns, strict=True))
