"""A pipeline as a picture: steps in station colours, wired by input name, with their states."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

from reperform.viewer.layered_layout import Layout, layered_layout
from reperform.viewer.palette import INK, RULE, SOFT_INK, STATES, station_colour, tint

HEAD, ROW, PAD, GAP, MARGIN, COLUMN_GAP = 46.0, 18.0, 7.0, 22.0, 24.0, 58.0
FONT = "'DejaVu Sans', 'Segoe UI', Helvetica, Arial, sans-serif"


@dataclass(frozen=True)
class GraphStep:
    """One step of a pipeline.

    inputs: input name -> the step that feeds it, or `step.field`.  state: fresh, stale, failed, missing or
    empty.  detail: a short remark under the name, such as `400 items`.
    """

    name: str
    node: str
    inputs: Mapping[str, str] = field(default_factory=dict)
    state: str = ""
    detail: str = ""


def svg(steps: Sequence[GraphStep], title: str = "") -> str:
    """The pipeline as SVG text, left to right; the same steps give the same text to the byte.

    Raises ValueError where an input comes from no step, or where the steps have a cycle.
    """
    _check_sources(steps)
    edges = [(_source(source), step.name) for step in steps for source in step.inputs.values()]
    heights = {step.name: _height(step) for step in steps}
    layout = layered_layout([step.name for step in steps], edges, heights, GAP, 10.0)
    lefts, widths = _columns(steps, layout)
    head = MARGIN + (28.0 if title else 0.0)
    places = {
        step.name: (
            lefts[layout.layer[step.name]],
            head + layout.centre[step.name] - heights[step.name] / 2,
            widths[layout.layer[step.name]],
            heights[step.name],
        )
        for step in steps
    }
    width = max((x + w for x, _, w, _ in places.values()), default=200.0) + MARGIN
    height = head + layout.height + MARGIN + 26.0
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" '
        f'height="{height:.0f}" font-family="{FONT}" font-size="12">',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="#ffffff"/>',
    ]
    if title:
        parts.append(
            f'<text x="{MARGIN}" y="32" font-size="16" font-weight="600" fill="{INK}">{escape(title)}</text>'
        )
    for step in steps:
        parts += _wires(step, steps, places, layout, lefts, widths, head)
    parts += [_box(step, *places[step.name]) for step in steps]
    parts.append(_legend(steps, height - 18.0))
    return "\n".join([*parts, "</svg>", ""])


def _source(reference: str) -> str:
    return reference.partition(".")[0]


def _check_sources(steps: Sequence[GraphStep]) -> None:
    names = {step.name for step in steps}
    for step in steps:
        for port, reference in step.inputs.items():
            if _source(reference) not in names:
                raise ValueError(
                    f"step {step.name!r}: input {port!r} must come from a step of the drawing, "
                    f"got {reference!r}; the steps are {', '.join(sorted(names))}"
                )


def _height(step: GraphStep) -> float:
    return _head(step) + ROW * len(step.inputs) + (2 * PAD if step.inputs else 0.0)


def _head(step: GraphStep) -> float:
    return HEAD + (14.0 if step.detail else 0.0)


def _text_width(text: str, size: float) -> float:
    # DejaVu Sans: wide and narrow letters, measured; close enough to size boxes.
    return size * sum(0.32 if c in "ijl.,:'| " else 0.95 if c in "mwMW@" else 0.63 for c in text)


def _port_text(port: str, reference: str) -> tuple[str, str]:
    inner = reference.partition(".")[2]
    return port, f".{inner}" if inner else ""


def _columns(steps: Sequence[GraphStep], layout: Layout) -> tuple[list[float], list[float]]:
    widths = [120.0] * (max(layout.layer.values(), default=-1) + 1)
    for step in steps:
        rows = [_text_width("".join(_port_text(*item)), 11) + 28 for item in step.inputs.items()]
        state = _text_width(step.state, 10) + 24 if step.state else 0.0
        need = max(
            _text_width(step.name, 13.5) + 24 + state,
            _text_width(step.node, 11) + 24,
            _text_width(step.detail, 11) + 24,
            *rows,
        )
        column = layout.layer[step.name]
        widths[column] = max(widths[column], need)
    lefts, x = [], MARGIN
    for width in widths:
        lefts.append(x)
        x += width + COLUMN_GAP
    return lefts, widths


def _port_y(step: GraphStep, port: str, top: float) -> float:
    return top + _head(step) + PAD + ROW * (list(step.inputs).index(port) + 0.5)


def _wires(
    step: GraphStep,
    steps: Sequence[GraphStep],
    places: Mapping[str, tuple[float, float, float, float]],
    layout: Layout,
    lefts: Sequence[float],
    widths: Sequence[float],
    head: float,
) -> list[str]:
    x, y, _, _ = places[step.name]
    wires = []
    for port, reference in step.inputs.items():
        source = _source(reference)
        node = next(other.node for other in steps if other.name == source)
        sx, sy, sw, _ = places[source]
        points = [(sx + sw, sy + HEAD / 2)]
        for k, lane in enumerate(layout.through[source, step.name]):
            column = layout.layer[source] + 1 + k
            points += [(lefts[column], head + lane), (lefts[column] + widths[column], head + lane)]
        points.append((x, _port_y(step, port, y)))
        colour = tint(station_colour(node), 0.2)
        wires.append(
            f'<path d="{_curve(points)}" fill="none" stroke="{colour}" stroke-width="1.8">'
            f"<title>{escape(reference)} to {escape(step.name)}: {escape(port)}</title></path>"
        )
    return wires


def _curve(points: Sequence[tuple[float, float]]) -> str:
    """Horizontal at every way point: an S between columns, straight through a column."""
    text = f"M{points[0][0]:.1f},{points[0][1]:.1f}"
    for (ax, ay), (bx, by) in itertools.pairwise(points):
        bend = (bx - ax) / 2
        text += f" C{ax + bend:.1f},{ay:.1f} {bx - bend:.1f},{by:.1f} {bx:.1f},{by:.1f}"
    return text


def _rect(x: float, y: float, w: float, h: float, radius: float, attributes: str) -> str:
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{w:.1f}" height="{h:.1f}" rx="{radius:g}" {attributes}/>'


def _dot(x: float, y: float, attributes: str, radius: float = 3.6) -> str:
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" {attributes}/>'


def _text(x: float, y: float, size: float, text: str, fill: str = INK, attributes: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size:g}" fill="{fill}"{attributes}>{text}</text>'


def _box(step: GraphStep, x: float, y: float, w: float, h: float) -> str:
    colour, head = station_colour(step.node), _head(step)
    shade = f'fill="{tint(colour, 0.72)}"'
    stroke, dash, weight = colour, "", 1.4
    if step.state == "failed":
        stroke, weight = STATES["failed"], 2.4
    elif step.state in ("stale", "missing"):
        dash = ' stroke-dasharray="5 3"'
    parts = [
        f"<g><title>{escape(step.name)}: {escape(step.node)}</title>",
        _rect(x, y, w, h, 7, f'fill="{tint(colour, 0.9)}"' if step.inputs else shade),
    ]
    if step.inputs:
        corners = f"V{y + 7:.1f} a7,7 0 0 1 7,-7 H{x + w - 7:.1f} a7,7 0 0 1 7,7"
        parts.append(f'<path d="M{x:.1f},{y + head:.1f} {corners} V{y + head:.1f} Z" {shade}/>')
    parts += [
        _rect(x, y, w, h, 7, f'fill="none" stroke="{stroke}" stroke-width="{weight}"{dash}'),
        _text(x + 12, y + 20, 13.5, escape(step.name), attributes=' font-weight="600"'),
        _text(x + 12, y + 36, 11, escape(step.node), SOFT_INK),
        _dot(x + w, y + HEAD / 2, f'fill="{colour}"', 4),
    ]
    if step.detail:
        parts.append(_text(x + 12, y + 51, 11, escape(step.detail), SOFT_INK))
    if step.state:
        right = x + w - 12
        state_fill = f'fill="{STATES.get(step.state, SOFT_INK)}"'
        parts.append(_dot(right - _text_width(step.state, 10) - 7, y + 16, state_fill))
        parts.append(_text(right, y + 19.5, 10, escape(step.state), attributes=' text-anchor="end"'))
    for port, reference in step.inputs.items():
        name, inner = _port_text(port, reference)
        row = _port_y(step, port, y)
        label = f'{escape(name)}<tspan fill="{SOFT_INK}" dx="5">{escape(inner)}</tspan>'
        parts.append(_dot(x, row, f'fill="#ffffff" stroke="{colour}" stroke-width="1.6"'))
        parts.append(_text(x + 12, row + 4, 11, label))
    return "\n".join([*parts, "</g>"])


def _legend(steps: Sequence[GraphStep], y: float) -> str:
    stations = list(dict.fromkeys(step.node.partition(".")[0] for step in steps))
    x, parts = MARGIN, [f'<path d="M{MARGIN},{y - 16:.1f} h40" stroke="{RULE}"/>']
    for station in stations:
        parts.append(_rect(x, y - 9, 10, 10, 2, f'fill="{station_colour(station)}"'))
        parts.append(_text(x + 15, y, 10.5, escape(station), SOFT_INK))
        x += 33 + _text_width(station, 10.5)
    return "".join(parts)
