"""One self-contained page about a run: graph, timings, pictures, tables, versions."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files

import numpy as np

from reperform.nodes.products.table import Table
from reperform.viewer.palette import state_colour, station_colour
from reperform.viewer.pictures.canvas import png
from reperform.viewer.pictures.tabulate import table_cells
from reperform.viewer.progress import duration

# RGB uint8 (H, W, 3), or a PNG or JPEG file.
Picture = np.ndarray | bytes


@dataclass(frozen=True)
class ReportStep:
    """What a report tells of one step.

    seconds: time spent computing.  bytes: size of its results in the store.  pictures: caption -> RGB uint8
    picture (H, W, 3), or the bytes of a PNG or JPEG file.  tables: caption -> table of figures.
    """

    name: str
    node: str
    items: int = 0
    computed: int = 0
    cached: int = 0
    failed: int = 0
    seconds: float = 0.0
    bytes: int = 0
    state: str = ""
    about: str = ""
    pictures: Mapping[str, Picture] = field(default_factory=dict)
    tables: Mapping[str, Table] = field(default_factory=dict)


def report(
    title: str,
    steps: Sequence[ReportStep],
    graph: str = "",
    versions: Mapping[str, str] | None = None,
    about: str = "",
    seconds: float | None = None,
) -> str:
    """The page as HTML text; nothing is loaded from elsewhere, pictures are inside.

    graph: the pipeline as SVG text.  versions: of the packages that took part.  seconds: duration of the run.
    """
    from jinja2 import Environment

    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {
        "duration": duration,
        "size": size,
        "station": station_colour,
        "state": state_colour,
    }
    environment.filters["source"] = data_uri
    template = environment.from_string(
        (files("reperform.viewer") / "report.html").read_text(encoding="utf-8")
    )
    tables = {step.name: {name: table_cells(table) for name, table in step.tables.items()} for step in steps}
    held = [int(mark) for step in steps for table in step.tables.values() for mark in np.asarray(table.holds)]
    return template.render(
        title=title,
        about=about,
        steps=steps,
        tables=tables,
        held=held.count(1),
        missed=held.count(0),
        graph=graph,
        versions=versions or {},
        seconds=seconds,
        slowest=max((step.seconds for step in steps), default=0.0),
    )


def data_uri(picture: Picture) -> str:
    """A picture as the source of an HTML image."""
    data = picture if isinstance(picture, bytes) else png(picture)
    kind = "jpeg" if data[:2] == b"\xff\xd8" else "png"
    return f"data:image/{kind};base64,{base64.b64encode(data).decode('ascii')}"


def size(count: int) -> str:
    """Bytes as people read them: `0 B`, `1.2 MB`."""
    amount = float(count)
    for unit in ("B", "kB", "MB", "GB"):
        if amount < 1000:
            return f"{amount:.0f} {unit}" if unit == "B" or amount >= 100 else f"{amount:.1f} {unit}"
        amount /= 1000
    return f"{amount:.1f} TB"
