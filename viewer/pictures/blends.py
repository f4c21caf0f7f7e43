"""Blends: a space of them, and how well they do."""

from __future__ import annotations

from typing import Any

import numpy as np

from reperform.nodes.blend.space_fields import hybrid_fields
from reperform.nodes.kernels.hybrid_blend import evaluate, linear_into, new_scratch
from reperform.nodes.products.blend_measures import BlendErrors, BlendTable, ThresholdCurves
from reperform.nodes.products.blend_space import BlendSpace
from reperform.viewer.palette import ACCENT, INK, SOFT_INK, STATIONS
from reperform.viewer.pictures.canvas import figure, pixels, write_text
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.scene import Body, draw_scene, ground_under
from reperform.viewer.pictures.tabulate import Cell, draw_table, number

COLOURS = {
    "linear": STATIONS["similarity"],
    "hybrid R=1": STATIONS["studio"],
    "hybrid R=3": ACCENT,
    "non-linear": INK,
}
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)


def blend_space_picture(product: BlendSpace, frame: int, look: Look) -> np.ndarray:
    """The first take turning into the last: linear blends coloured by what is corrected, and corrected blends.

    Drawn at the pose that is corrected most half way; colours go from blue (nothing) to red (most).
    """
    fields = hybrid_fields(product)
    count, poses = fields.inputs.shape[:2]
    ways = [np.eye(count)[0] * (1.0 - share) + np.eye(count)[-1] * share for share in SHARES]
    out, scratch = np.empty(np.shape(product.vertices)[2:], np.float32), new_scratch(fields)

    def drawn(pose: int, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        linear_into(fields, pose, weights, out)
        linear = out.astype(np.float64)
        evaluate(fields, pose, weights, out, scratch)
        return linear, out.astype(np.float64)

    def gap(pose: int) -> float:
        linear, corrected = drawn(pose, ways[len(ways) // 2])
        return float(np.linalg.norm(corrected - linear, axis=1).max())

    pose = max(range(poses), key=gap)
    pairs = [drawn(pose, weights) for weights in ways]
    most = max(float(np.linalg.norm(b - a, axis=1).max()) for a, b in pairs)
    faces = np.asarray(product.faces)
    half = (look.size[0], look.size[1] // 2)
    heats = [np.linalg.norm(b - a, axis=1) / max(most, 1e-9) for a, b in pairs]
    top = _row([_heated(a, faces, heat) for (a, _), heat in zip(pairs, heats, strict=True)], look, half)
    bottom = _row([Body(b, faces) for _, b in pairs], look, half)
    image = np.concatenate([top, bottom], axis=0)
    names = ", ".join(f"{share:g}" for share in SHARES)
    label = f"linear, coloured by what is corrected (red: {1000 * most:.0f} mm); pose {pose}, weights {names}"
    image = write_text(image, label, (12, 8), 12)
    return write_text(
        image,
        f"corrected at {len(product.weights)} weight{'s' * (len(product.weights) != 1)} between",
        (12, half[1] + 8),
        12,
    )


def _heated(vertices: np.ndarray, faces: np.ndarray, heat: np.ndarray) -> Body:
    import matplotlib

    strip = (matplotlib.colormaps["turbo"](np.linspace(0.05, 0.95, 256))[:, :3] * 255).astype(np.uint8)
    uv = np.stack([np.clip(heat, 0.0, 1.0) * 255 / 256 + 0.5 / 256, np.full(len(heat), 0.5)], axis=1)
    return Body(vertices, faces, uv=uv, faces_uv=faces, image=np.repeat(strip[None], 4, axis=0))


def _row(bodies: list[Body], look: Look, size: tuple[int, int]) -> np.ndarray:
    """Bodies side by side across the view."""
    right = np.array([np.cos(look.view.azimuth), 0.0, -np.sin(look.view.azimuth)])
    edge, placed = 0.0, []
    for body in bodies:
        along = body.vertices @ right
        middle = (body.vertices.min(0) + body.vertices.max(0)) / 2
        across = middle - right * (middle @ right)
        shift = right * (edge - along.min()) - across * [1, 0, 1]
        placed.append(
            Body(body.vertices + shift, body.faces, uv=body.uv, faces_uv=body.faces_uv, image=body.image)
        )
        edge += float(np.ptp(along)) + 0.15
    cloud = np.concatenate([body.vertices for body in placed])
    return draw_scene(placed, look.view, size, ground=ground_under(cloud))


def blend_errors_picture(product: BlendErrors, frame: int, look: Look) -> np.ndarray:
    """Average, largest and root-mean-square distance to the non-linear blend against the weight, pair by pair."""
    pairs = np.asarray(product.pair)
    weights = np.asarray(product.weight)
    with figure(look.size) as fig:
        grid = fig.subplots(len(pairs), 3, squeeze=False, sharex=True)
        for k, pair in enumerate(pairs):
            for c, (name, field) in enumerate(
                (("average", product.average), ("largest", product.largest), ("RMS", product.rms))
            ):
                axis: Any = grid[k, c]
                for m, method in enumerate(map(str, np.asarray(product.method))):
                    if method != "non-linear":
                        axis.plot(
                            weights,
                            1000 * np.asarray(field)[k, m],
                            color=COLOURS.get(method),
                            label=method,
                            lw=1.3,
                        )
                axis.set_ylim(bottom=0)
                axis.grid(alpha=0.5)
                axis.tick_params(labelsize=7)
                if k == 0:
                    axis.set_title(f"{name}, mm", fontsize=9)
                if c == 0:
                    axis.set_ylabel(str(pair), fontsize=8)
                if k == len(pairs) - 1:
                    axis.set_xlabel("weight of the second pose", fontsize=8)
        grid[0, 2].legend(fontsize=7)
        return pixels(fig)


def threshold_curves_picture(product: ThresholdCurves, frame: int, look: Look) -> np.ndarray:
    """Largest error, stored memory and corrected share of the surface against the threshold."""
    epsilon = 1000 * np.asarray(product.epsilon)
    shades = [STATIONS["studio"], ACCENT, STATIONS["surface"], STATIONS["skeleton"], STATIONS["texture"]]
    with figure(look.size) as fig:
        error, memory, share = fig.subplots(1, 3)
        for k, count in enumerate(np.asarray(product.references).tolist()):
            style = {"color": shades[k % len(shades)], "marker": "o", "markersize": 3, "lw": 1.3}
            error.plot(epsilon, 1000 * np.asarray(product.error)[k], label=f"R = {count}", **style)
            memory.plot(epsilon, np.asarray(product.stored)[k] / 1e6, **style)
            memory.axhline(float(product.dense[k]) / 1e6, color=style["color"], ls=":", lw=1.0)
            share.plot(epsilon, 100 * np.asarray(product.corrected)[k], **style)
        error.plot(epsilon, epsilon, color=SOFT_INK, ls="--", lw=0.9, label="threshold")
        error.set(title="largest error, mm", xlabel="threshold, mm")
        error.legend(fontsize=8)
        memory.set(title="memory, MB (dotted: dense)", xlabel="threshold, mm", yscale="log")
        share.set(title="surface corrected, %", xlabel="threshold, mm")
        for axis in (error, memory, share):
            axis.grid(alpha=0.5)
        error.set_ylim(bottom=0)
        share.set_ylim(bottom=0)
        return pixels(fig)


def blend_table_picture(product: BlendTable, frame: int, look: Look) -> np.ndarray:
    """The seeds' table: per pair and method the greatest errors and the time per frame."""
    heads = [
        "poses", "vertices", "method", "max error %", "cm", "max RMS cm", "volume %", "edges %", "true middle mm", "ms",
    ]  # fmt: skip
    columns = (product.share, product.largest, product.rms, product.volume, product.strain, product.truth)
    scales = (100, 100, 100, 100, 100, 1000)
    rows = []
    for k, sequence in enumerate(map(str, np.asarray(product.sequence))):
        first = k == 0 or sequence != str(product.sequence[k - 1])
        values = [
            Cell(number(round(scale * float(column[k]), 3)), right=True)
            for column, scale in zip(columns, scales, strict=True)
        ]
        rows.append(
            [
                Cell(sequence if first else ""),
                Cell(str(int(product.vertices[k])) if first else "", SOFT_INK),
                Cell(str(product.method[k])),
                *values,
                Cell(number(round(1000 * float(product.seconds[k]), 4)), right=True),
            ]
        )
    return draw_table(heads, rows, look.size, look.title)
