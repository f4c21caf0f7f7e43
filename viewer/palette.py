"""Colours: one per station, one per state, and the inks of all pictures."""

from __future__ import annotations

INK = "#1f2933"
SOFT_INK = "#66727f"
RULE = "#d5dbe1"
PAPER = "#ffffff"
PANEL = "#f4f6f8"
ACCENT = "#d1495b"

# In the order of the chain; neighbours differ in hue and lightness.
STATIONS: dict[str, str] = {
    "studio": "#5b6c8f",
    "capture": "#2f8f9d",
    "surface": "#4c956c",
    "align": "#8fa83c",
    "skeleton": "#c9a227",
    "similarity": "#dd8433",
    "blend": "#cf6a5b",
    "motion_graph": "#b9527e",
    "synthesis": "#8b5fa8",
    "texture": "#5f6fc2",
    "evaluate": "#6b7680",
    "export": "#9a7b5f",
}
OTHER_STATION = "#8a939c"

STATES: dict[str, str] = {
    "fresh": "#3a9d5d",
    "stale": "#d99a1c",
    "failed": "#cc3d3d",
    "missing": "#a3adb7",
}


def station_colour(node: str) -> str:
    """The colour of a node's station, by the part of its name before the dot."""
    return STATIONS.get(node.partition(".")[0], OTHER_STATION)


def state_colour(state: str) -> str:
    """The colour of a state; an unknown one is drawn as missing."""
    return STATES.get(state, STATES["missing"])


def rgb(colour: str) -> tuple[int, int, int]:
    """`"#rrggbb"` as three numbers of 0-255."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def tint(colour: str, amount: float) -> str:
    """A colour mixed with white: 0 leaves it, 1 is white."""
    return "#" + "".join(f"{round(part + (255 - part) * amount):02x}" for part in rgb(colour))
