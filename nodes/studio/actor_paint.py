"""What the virtual actor's skin, hair and clothes look like: colours as functions of the rest position."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import map_coordinates

from reperform.nodes.kernels.implicit_body import Part, part_coordinates

Rgb = tuple[float, float, float]
_TABLE = np.random.default_rng(20100725).random((32, 32, 32)).astype(np.float32)


def noise(points: np.ndarray, frequency: float | tuple[float, float, float]) -> np.ndarray:
    """Smooth periodic value noise in [0, 1] at points (N, 3); frequency in lattice cells per metre."""
    cells = (np.asarray(points) * np.asarray(frequency)).T
    return map_coordinates(_TABLE, cells, order=1, mode="grid-wrap")


def cloth_coordinates(points: np.ndarray, part: Part) -> tuple[np.ndarray, np.ndarray]:
    """(metres along the part, turns round it from the back in [0, 1)) of points on its surface."""
    t, u, w = part_coordinates(points, part)
    along = t * float(np.linalg.norm(np.subtract(part.end, part.start)))
    return along, np.arctan2(u, w) / (2 * np.pi) + 0.5


def colours(
    points: np.ndarray, owner: np.ndarray, parts: Sequence[Part], palette: dict[str, tuple[Rgb, ...]]
) -> np.ndarray:
    """RGB in [0, 1], (N, 3), of rest points whose nearest part is `owner`."""
    rgb = np.full((len(points), 3), 0.5, np.float32)
    for index, part in enumerate(parts):
        rows = np.flatnonzero(owner == index)
        if len(rows):
            rgb[rows] = _material(points[rows], part, palette[part.material])
    fibre = noise(points, 420.0) - 0.5
    stain = noise(points, 23.0) - 0.5
    # cloth and leather are mottled at the size of a few pixels; skin and hair less
    mottled = np.array([0.08 if part.material in ("skin", "hair") else 0.26 for part in parts])[owner]
    mottle = noise(points + 0.37, 75.0) - 0.5
    return np.clip(rgb * (1 + 0.16 * fibre + mottled * mottle + 0.10 * stain)[:, None], 0, 1)


def _material(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    match part.material:
        case "skin":
            return _skin(points, part, tones)
        case "hair":
            return _hair(points, tones)
        case "top":
            return _knit(points, part, tones)
        case "skirt":
            return _tartan(points, part, tones) if len(tones) == 4 else _flowers(points, part, tones)
        case "bodice":
            return _flowers(points, part, tones)
        case "coat":
            return _coat(points, part, tones)
        case "trousers":
            return _checks(points, part, tones)
        case "tights":
            return _ribbed(points, part, tones)
        case "shoe":
            return _shoe(points, tones)
        case _:
            raise ValueError(f"studio.perform: part {part.name!r} has the unknown material {part.material!r}")


def _mix(base: np.ndarray, tone: Rgb, weight: np.ndarray) -> np.ndarray:
    weight = np.clip(weight, 0, 1)[:, None]
    return base * (1 - weight) + np.asarray(tone, np.float32) * weight


def _flat(points: np.ndarray, tone: Rgb) -> np.ndarray:
    return np.broadcast_to(np.asarray(tone, np.float32), points.shape).copy()


def _spot(
    x: np.ndarray, y: np.ndarray, centre: tuple[float, float], radii: tuple[float, float]
) -> np.ndarray:
    """1 inside an ellipse, 0 outside, with an edge about a millimetre soft."""
    distance = np.hypot((x - centre[0]) / radii[0], (y - centre[1]) / radii[1])
    return np.clip((1 - distance) * min(radii) / 0.0012 + 0.5, 0, 1)


def _stripe(x: np.ndarray, period: float, share: float, offset: float = 0.0) -> np.ndarray:
    """1 in stripes that take `share` of each period, soft-edged."""
    phase = np.abs((x / period + offset) % 1.0 - 0.5) * 2
    return np.clip((share - phase) * 8 + 0.5, 0, 1)


def _skin(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    rgb = _flat(points, tones[0])
    x, y, z = points.T
    if "head" in part.bones and part.name != "neck":
        rgb = _face(rgb, x, y, z, tones)
    if part.name.endswith("fingers"):
        _, _, w = part_coordinates(points, part)
        for groove in (-0.019, 0.0, 0.019):
            rgb = _mix(rgb, tones[2], 0.75 * np.clip(1 - np.abs(w - groove) / 0.0035, 0, 1))
    return rgb


def _face(rgb: np.ndarray, x: np.ndarray, y: np.ndarray, z: np.ndarray, tones: tuple[Rgb, ...]) -> np.ndarray:
    front = z > 0.035
    side = np.abs(x)
    rgb = _mix(
        rgb, tones[1], 0.55 * front * np.exp(-(((side - 0.042) / 0.020) ** 2) - ((y - 1.580) / 0.016) ** 2)
    )
    rgb = _mix(
        rgb, tones[2], 0.45 * front * np.exp(-(((side - 0.031) / 0.022) ** 2) - ((y - 1.618) / 0.012) ** 2)
    )
    brow_line = 1.6335 + 0.004 * np.cos((side - 0.034) / 0.022)
    brow = np.clip(1 - np.abs(y - brow_line) / 0.0045, 0, 1) * ((side > 0.012) & (side < 0.052)) * front
    rgb = _mix(rgb, tones[4], 1.6 * brow)
    rgb = _mix(rgb, tones[4], front * _spot(side, y, (0.0315, 1.6125), (0.0170, 0.0088)))
    rgb = _mix(rgb, (0.95, 0.93, 0.90), front * _spot(side, y, (0.0315, 1.6112), (0.0150, 0.0066)))
    open_eye = front & (np.abs(y - 1.6112) < 0.0062)
    rgb = _mix(rgb, tones[5], open_eye * _spot(side, y, (0.0312, 1.6118), (0.0068, 0.0068)))
    rgb = _mix(rgb, (0.05, 0.04, 0.04), open_eye * _spot(side, y, (0.0312, 1.6118), (0.0032, 0.0032)))
    rgb = _mix(rgb, (1.0, 1.0, 1.0), front * 0.9 * _spot(x % 0.0626, y, (0.0335, 1.6138), (0.0016, 0.0016)))
    rgb = _mix(rgb, tones[2], 0.9 * front * _spot(side, y, (0.0075, 1.5825), (0.0042, 0.0026)))
    rgb = _mix(rgb, tones[3], front * _spot(x, y, (0.0, 1.5555), (0.0255, 0.0095)))
    rgb = _mix(rgb, (0.35, 0.12, 0.12), front * _spot(x, y, (0.0, 1.5560), (0.0225, 0.0016)))
    return rgb


def _hair(points: np.ndarray, tones: tuple[Rgb, ...]) -> np.ndarray:
    strands = noise(points + np.array([0.0, 0.0, 0.3]), (170.0, 14.0, 120.0))
    locks = noise(points, (48.0, 6.0, 40.0))
    return _mix(_flat(points, tones[0]), tones[1], 1.5 * (0.6 * strands + 0.6 * locks - 0.35))


def _knit(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    """A patterned sweater: bands of diamonds and dashes."""
    along, turn = cloth_coordinates(points, part)
    if part.radii is not None:
        along, turn = points[:, 1] - 0.79, np.arctan2(points[:, 0], points[:, 2]) / (2 * np.pi) + 0.5
    across = turn * (18 if part.name == "torso" or part.radii is not None else 8)
    band = np.floor(along / 0.052)
    height = along / 0.052 - band
    rgb = _flat(points, tones[0])
    diamond = np.abs((across % 1) - 0.5) + 0.62 * np.abs(height - 0.5)
    rgb = _mix(rgb, tones[1], (band % 2 == 0) * np.clip((0.36 - diamond) * 16, 0, 1))
    rgb = _mix(rgb, tones[2], (band % 2 == 0) * np.clip((0.15 - diamond) * 16, 0, 1))
    rgb = _mix(rgb, tones[2], (band % 2 == 1) * _stripe(across, 0.5, 0.5) * _stripe(height, 1.0, 0.32))
    rgb = _mix(rgb, tones[1], _stripe(along, 0.052, 0.10, 0.5))
    return _mix(rgb, tones[3], (points[:, 1] > 1.435) & (part.name == "torso"))


def _tartan(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    along, turn = cloth_coordinates(points, part)
    across = turn * 14
    rgb = _flat(points, tones[0])
    rgb = _mix(rgb, tones[1], 0.55 * _stripe(across, 1.0, 0.42))
    rgb = _mix(rgb, tones[1], 0.55 * _stripe(along, 0.094, 0.42))
    rgb = _mix(rgb, tones[2], 0.9 * _stripe(across, 1.0, 0.07, 0.5))
    rgb = _mix(rgb, tones[2], 0.9 * _stripe(along, 0.094, 0.07, 0.5))
    rgb = _mix(rgb, tones[3], 0.8 * _stripe(across, 1.0, 0.05))
    rgb = _mix(rgb, tones[3], 0.8 * _stripe(along, 0.094, 0.05))
    return _mix(rgb, (0.12, 0.08, 0.07), along < 0.030)


def _flowers(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    """Flowers of three sizes strewn over the cloth, placed in space so that they cross seams."""
    rgb = _flat(points, tones[0])
    rgb = _mix(rgb, tones[1], 0.7 * (noise(points, 11.0) > 0.62))
    for layer, (cell, petal, heart) in enumerate(((0.080, tones[2], tones[3]), (0.055, tones[4], tones[3]))):
        place = points / cell + 7.3 * layer
        home = np.floor(place).astype(int)
        jitter = np.stack([_TABLE[tuple((home + shift).T % 32)] for shift in (0, 5, 11)], axis=1)
        offset = place - home - (0.3 + 0.4 * jitter)
        radius = np.linalg.norm(offset, axis=1)
        angle = np.arctan2(offset[:, 1], offset[:, 0] + offset[:, 2])
        edge = 0.24 + 0.07 * np.cos(5 * angle + 6 * jitter[:, 0])
        rgb = _mix(rgb, petal, (edge - radius) * 30)
        rgb = _mix(rgb, heart, (0.09 - radius) * 40)
    if part.name == "skirt":
        along, _ = cloth_coordinates(points, part)
        rgb = _mix(rgb, tones[1], (along < 0.035) | (np.abs(along - 0.82) < 0.012))
    if part.name == "torso":
        x, y, z = points.T
        neckline = 1.415 - 0.055 * np.exp(-((x / 0.07) ** 2)) * (z > 0)
        rgb = _mix(rgb, tones[3], (y > neckline - 0.008).astype(float))
        rgb = _mix(rgb, tones[5], (y > neckline).astype(float))
    return rgb


def _coat(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    """A herringbone jacket, open over a striped shirt."""
    along, turn = cloth_coordinates(points, part)
    x, y, z = points.T
    trunk = part.name in ("torso", "skirt", "collar")
    across = turn * (60 if trunk else 24)
    zigzag = along / 0.012 + np.abs(across % 2 - 1) * 1.6
    rgb = _mix(_flat(points, tones[0]), tones[1], 0.8 * _stripe(zigzag, 1.0, 0.5))
    rgb = _mix(rgb, tones[2], 0.8 * _stripe(across, 6.0, 0.03))
    if not trunk:
        patch = _spot(z, y, (-0.05, 1.186), (0.034, 0.055)) * (z < -0.02)
        return _mix(rgb, tones[4], patch)
    front = z > 0.0
    opening = np.interp(y, (0.72, 0.95, 1.10, 1.42, 1.47), (0.075, 0.030, 0.016, 0.070, 0.080))
    shirt = _mix(_flat(points, tones[3]), tones[5], _stripe(x, 0.014, 0.22))
    shirt = _mix(shirt, tones[6], (y < 0.985).astype(float))
    shirt = _mix(shirt, tones[2], (np.abs(y - 0.99) < 0.018).astype(float))
    inside = front * np.clip((opening - np.abs(x)) / 0.003, 0, 1)
    lapel = front * np.clip(1 - np.abs(np.abs(x) - opening - 0.022) / 0.024, 0, 1) * (y > 1.08)
    rgb = _mix(rgb, tones[2], 0.75 * np.clip(4 * lapel, 0, 1))
    rgb = rgb * (1 - inside[:, None]) + shirt * inside[:, None]
    for height in (0.90, 1.00):
        rgb = _mix(rgb, (0.08, 0.06, 0.05), front * _spot(x, y, (0.052, height), (0.011, 0.011)))
    pocket = front * (np.abs(np.abs(x) - 0.125) < 0.05) * (np.abs(y - 0.895) < 0.010)
    return _mix(rgb, tones[2], pocket.astype(float))


def _checks(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    along, turn = cloth_coordinates(points, part)
    rgb = _mix(_flat(points, tones[0]), tones[1], 0.6 * _stripe(along, 0.045, 0.30))
    rgb = _mix(rgb, tones[1], 0.6 * _stripe(turn * 9, 1.0, 0.30))
    return _mix(rgb, tones[2], 0.7 * np.maximum(_stripe(along, 0.09, 0.05), _stripe(turn * 9, 2.0, 0.05)))


def _ribbed(points: np.ndarray, part: Part, tones: tuple[Rgb, ...]) -> np.ndarray:
    along, turn = cloth_coordinates(points, part)
    rgb = _mix(_flat(points, tones[0]), tones[1], 0.5 * _stripe(turn * 14, 1.0, 0.4))
    return _mix(rgb, tones[1], 0.8 * _stripe(along + 0.02 * np.sin(turn * 2 * np.pi * 4), 0.05, 0.12))


def _shoe(points: np.ndarray, tones: tuple[Rgb, ...]) -> np.ndarray:
    x, y, z = points.T
    rgb = _mix(_flat(points, tones[0]), tones[1], 1.2 * (noise(points, 35.0) - 0.45))
    rgb = _mix(rgb, tones[2], (y < 0.017).astype(float))
    laces = (np.abs(np.abs(x) - 0.127) < 0.020) & (z > 0.02) & (z < 0.10) & (y > 0.05) & (y < 0.105)
    rgb = _mix(rgb, tones[3], laces * _stripe(z, 0.016, 0.35))
    return _mix(rgb, tones[3], 0.9 * _stripe(y, 0.115, 0.05, 0.25) * (y > 0.12))
