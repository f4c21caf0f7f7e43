"""The implicit parts of the virtual actor: a body, and one of three costumes over it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Literal

from reperform.nodes.kernels.implicit_body import Part

Costume = Literal["skirt", "jacket", "dress"]
TORSO_BONES = ("hips", "spine", "chest", "neck")
Point = tuple[float, float, float]


def _ellipsoid(
    name: str, material: str, bone: str, centre: Point, radii: Point, blend: float, up: Point = (0, 1, 0)
) -> Part:
    end = tuple(a + b for a, b in zip(centre, up, strict=True))
    return Part(name, material, (bone,), centre, end, radii=radii, blend=blend)  # type: ignore[arg-type]


def _torso(material: str, width: float, depth: float, girth: float) -> list[Part]:
    """Hips to neck. `girth` is the cloth's thickness over the skin."""
    heights = (0.79, 0.86, 0.93, 1.00, 1.08, 1.16, 1.25, 1.32, 1.375, 1.415, 1.45, 1.50)
    half_x = (0.105, 0.152, 0.166, 0.152, 0.130, 0.136, 0.149, 0.156, 0.150, 0.120, 0.078, 0.054)
    half_z = (0.085, 0.112, 0.119, 0.106, 0.092, 0.097, 0.106, 0.102, 0.088, 0.070, 0.058, 0.054)
    shift = (0.0, -0.004, -0.012, -0.006, 0.0, 0.003, 0.006, 0.0, -0.010, -0.015, -0.018, -0.016)
    t = tuple((y - heights[0]) / (heights[-1] - heights[0]) for y in heights)
    knots = tuple((y - heights[0]) / (heights[-1] - heights[0]) for y in (0.95, 1.12, 1.30, 1.47))
    return [
        Part(
            "torso", material, TORSO_BONES, (0, heights[0], 0), (0, heights[-1], 0), stations=t,
            half_u=tuple(x * width + girth for x in half_x), half_w=tuple(z * depth + girth for z in half_z),
            shift_w=shift, knots=knots, blend=0.03,
        )
    ]  # fmt: skip


def _head() -> list[Part]:
    skin = "skin"
    return [
        Part("neck", skin, ("neck", "head"), (0, 1.42, -0.022), (0, 1.57, 0.002), stations=(0, 0.4, 1),
             half_u=(0.062, 0.050, 0.048), half_w=(0.060, 0.053, 0.052), knots=(0.2, 0.9), blend=0.03),
        _ellipsoid("cranium", skin, "head", (0, 1.630, -0.006), (0.074, 0.088, 0.094), 0.02),
        _ellipsoid("face", skin, "head", (0, 1.588, 0.030), (0.062, 0.078, 0.066), 0.03),
        _ellipsoid("jaw", skin, "head", (0, 1.542, 0.048), (0.042, 0.034, 0.042), 0.03),
        _ellipsoid("chin", skin, "head", (0, 1.523, 0.078), (0.018, 0.014, 0.014), 0.02),
        _ellipsoid("brow", skin, "head", (0, 1.632, 0.080), (0.050, 0.012, 0.014), 0.02),
        Part("nose", skin, ("head",), (0, 1.624, 0.090), (0, 1.585, 0.107), stations=(0, 0.7, 1),
             half_u=(0.008, 0.012, 0.014), half_w=(0.010, 0.010, 0.008), blend=0.014),
        _ellipsoid("lips", skin, "head", (0, 1.556, 0.092), (0.022, 0.011, 0.009), 0.012),
        _ellipsoid("left_ear", skin, "head", (0.074, 1.600, 0.004), (0.009, 0.030, 0.018), 0.008),
        _ellipsoid("right_ear", skin, "head", (-0.074, 1.600, 0.004), (0.009, 0.030, 0.018), 0.008),
    ]  # fmt: skip


def _hair_bob() -> list[Part]:
    return [
        _ellipsoid("hair_top", "hair", "head", (0, 1.640, -0.018), (0.088, 0.098, 0.104), 0.006),
        Part("hair_back", "hair", ("head", "neck"), (0, 1.66, -0.042), (0, 1.44, -0.052),
             stations=(0, 0.35, 0.7, 0.9, 1), half_u=(0.07, 0.092, 0.100, 0.094, 0.07),
             half_w=(0.06, 0.066, 0.066, 0.056, 0.04), knots=(0.5, 1.6), blend=0.02),
    ]  # fmt: skip


def _hair_short() -> list[Part]:
    return [
        _ellipsoid("hair_top", "hair", "head", (0, 1.650, -0.016), (0.082, 0.090, 0.100), 0.008),
        _ellipsoid("hair_quiff", "hair", "head", (0.012, 1.706, 0.050), (0.050, 0.022, 0.036), 0.03),
        _ellipsoid("hair_nape", "hair", "head", (0, 1.600, -0.058), (0.066, 0.058, 0.048), 0.02),
    ]


def _hair_bun() -> list[Part]:
    return [
        _ellipsoid("hair_top", "hair", "head", (0, 1.642, -0.018), (0.083, 0.092, 0.099), 0.008),
        _ellipsoid("hair_nape", "hair", "head", (0, 1.595, -0.055), (0.062, 0.060, 0.048), 0.02),
        _ellipsoid("bun", "hair", "head", (0, 1.690, -0.108), (0.046, 0.044, 0.042), 0.012),
    ]


def _arm(sleeve: str, upper: float, lower: float, cuff: float) -> list[Part]:
    """Left arm; `upper`, `lower`: cloth over the skin; the sleeve ends at `cuff` of the forearm (0: at the
    elbow).
    """
    shoulder, elbow, wrist = (0.152, 1.408, -0.012), (0.343, 1.186, -0.012), (0.502, 0.999, 0.006)
    tip: Point = (0.566, 0.918, 0.018)
    side: Point = (0.766, 0.643, 0.0)
    end: Point = tuple(e + (cuff + 0.02) * (w - e) for e, w in zip(elbow, wrist, strict=True))  # type: ignore[assignment]
    parts = [
        _ellipsoid("left_shoulder", sleeve, "left_arm", (0.148, 1.372, -0.012),
                   (0.054 + upper, 0.050 + upper, 0.054 + upper), 0.05, up=(-0.5, 0.86, 0)),
        Part("left_upper_arm", sleeve, ("left_arm",), shoulder, elbow, side, (0, 0.15, 0.3, 0.6, 1),
             tuple(r + upper for r in (0.024, 0.044, 0.048, 0.043, 0.038)),
                  tuple(r + upper for r in (0.024, 0.046, 0.051, 0.045, 0.039)),
             blend=0.03),
        _ellipsoid("left_elbow", sleeve, "left_forearm", (0.343, 1.186, -0.013), (0.038 + upper,) * 3, 0.01),
        Part("left_forearm", "skin", ("left_forearm",), (0.338, 1.192, -0.012), wrist, side, (0, 0.25, 0.7, 1),
             (0.036, 0.040, 0.030, 0.024), (0.037, 0.042, 0.033, 0.029), blend=0.01),
        _ellipsoid("left_palm", "skin", "left_hand", (0.530, 0.963, 0.010), (0.019, 0.056, 0.043), 0.02, up=(0.62, -0.78, 0.1)),
        Part("left_fingers", "skin", ("left_hand",), (0.545, 0.945, 0.013), (0.592, 0.852, 0.030), side,
             (0, 0.4, 0.8, 1), (0.015, 0.014, 0.012, 0.006), (0.040, 0.039, 0.033, 0.022), blend=0.012),
        Part("left_thumb", "skin", ("left_hand",), (0.522, 0.975, 0.035), tip[:1] + (0.905, 0.072), side,
             (0, 0.5, 0.9, 1), (0.014, 0.012, 0.010, 0.005), (0.014, 0.012, 0.010, 0.005), blend=0.015),
    ]  # fmt: skip
    if cuff > 0:
        parts.append(
            Part("left_sleeve", sleeve, ("left_forearm",), elbow, end, side, (0, 0.5, 0.97, 1),
                 tuple(r + lower for r in (0.037, 0.036, 0.031, 0.030)), tuple(r + lower for r in (0.038, 0.038, 0.034, 0.033)),
                 blend=0.01)
        )  # fmt: skip
    return parts


def _leg(cloth: str, thigh: float, shin: float, hem: float, boot: float, boot_top: float) -> list[Part]:
    """Left leg; `thigh`, `shin`: cloth over the skin, `hem`: extra width at the ankle, `boot`: leather over
    the shin.
    """
    hip, knee, ankle = (0.090, 0.93, -0.004), (0.105, 0.495, 0.008), (0.118, 0.088, -0.018)
    parts = [
        Part("left_thigh", cloth, ("left_thigh",), hip, (0.1057, 0.475, 0.008), stations=(0, 0.25, 0.6, 0.9, 1),
             half_u=tuple(r + thigh for r in (0.076, 0.079, 0.066, 0.054, 0.052)),
             half_w=tuple(r + thigh for r in (0.086, 0.088, 0.073, 0.060, 0.056)), blend=0.03),
        Part("left_shin", cloth, ("left_shin",), (0.105, 0.52, 0.008), (0.118, 0.07, -0.018),
                  stations=(0, 0.12, 0.3, 0.6, 0.85, 1),
             half_u=tuple(r + s for r, s in zip((0.050, 0.051, 0.054, 0.045, 0.036, 0.036),
                  (shin, shin, shin, shin, shin + hem, shin + hem), strict=True)),
             half_w=tuple(r + s for r, s in zip((0.054, 0.055, 0.060, 0.050, 0.040, 0.040),
                  (shin, shin, shin, shin, shin + hem, shin + hem), strict=True)),
             shift_w=(0.0, 0.004, 0.016, 0.008, 0.0, 0.0), blend=0.015),
        Part("left_shoe", "shoe", ("left_foot", "left_toe"), (0.112, 0.030, -0.088), (0.137, 0.022, 0.188),
             stations=(0, 0.06, 0.2, 0.4, 0.65, 0.85, 0.96, 1), half_u=(0.022, 0.034, 0.039, 0.040, 0.049, 0.045, 0.030, 0.012),
             half_w=(0.026, 0.052, 0.066, 0.064, 0.050, 0.038, 0.026, 0.010), knots=(0.55, 0.80), blend=0.012),
    ]  # fmt: skip
    if boot > 0:
        top: Point = tuple(a + boot_top * (k - a) for a, k in zip(ankle, knee, strict=True))  # type: ignore[assignment]
        parts.append(
            Part("left_boot", "shoe", ("left_foot", "left_shin"), (0.118, 0.06, -0.02), top, stations=(0, 0.3, 0.7, 1),
                 half_u=tuple(r + boot for r in (0.036, 0.036, 0.040, 0.046)),
                  half_w=tuple(r + boot for r in (0.042, 0.040, 0.046, 0.053)),
                 shift_w=(0.0, 0.0, -0.006, -0.012), knots=(0.02, 0.35), blend=0.012)
        )  # fmt: skip
    return parts


def _mirror_name(name: str) -> str:
    return name.replace("left_", "right_")


def _mirrored(parts: Iterable[Part]) -> list[Part]:
    """The right-hand twins of left parts: x -> -x."""
    twins = []
    for part in parts:
        (sx, sy, sz), (ex, ey, ez), (ux, uy, uz) = part.start, part.end, part.side
        bones = tuple(_mirror_name(bone) for bone in part.bones)
        twins.append(
            replace(
                part, name=_mirror_name(part.name), bones=bones, start=(-sx, sy, sz), end=(-ex, ey, ez),
                side=(ux, -uy, -uz), shift_w=tuple(-shift for shift in part.shift_w) if uy else part.shift_w,
            )
        )  # fmt: skip
    return twins


def _skirt(
    top: float,
    hem: float,
    waist: tuple[float, float],
    wide: tuple[float, float],
    folds: int,
    depth: float,
    material: str,
) -> list[Part]:
    """A flared garment from `top` to `hem` (heights), with the hollow under its hem."""
    stations = (0.0, 0.12, 0.3, 0.6, 1.0)
    grow = (0.0, 0.34, 0.55, 0.78, 1.0)
    outer = Part(
        "skirt", material, ("hips", "left_thigh", "right_thigh"), (0, top, -0.004), (0, hem, -0.004), stations=stations,
        half_u=tuple(waist[0] + (wide[0] - waist[0]) * g for g in grow),
        half_w=tuple(waist[1] + (wide[1] - waist[1]) * g for g in grow),
        folds=folds, fold_depth=tuple(depth * d for d in (0.0, 0.1, 0.35, 0.7, 1.0)), fold_phase=0.7, blend=0.03,
        looseness=(0.0, 0.05, 0.25, 0.62, 1.0),
    )  # fmt: skip
    rise = min(0.16, 0.45 * (top - hem))
    at = 1 - rise / (top - hem)
    mid = tuple(waist[d] + (wide[d] - waist[d]) * (at * 0.9 + 0.08) - 0.03 for d in range(2))
    hollow = Part(
        "skirt_hollow", material, ("hips",), (0, hem + rise, -0.004), (0, hem - 0.03, -0.004),
        half_u=(mid[0], wide[0] - 0.016), half_w=(mid[1], wide[1] - 0.016), folds=folds,
        fold_depth=(depth * at, depth * 1.02), fold_phase=0.7, blend=0.02, carve=True,
    )  # fmt: skip
    return [outer, hollow]


def costume_parts(costume: Costume) -> tuple[Part, ...]:
    """All parts of the dressed actor, in the order in which they are joined."""
    if costume == "skirt":
        garment = _skirt(1.075, 0.525, (0.140, 0.102), (0.275, 0.245), 10, 0.075, "skirt")
        arm, leg = _arm("top", 0.005, 0.006, 0.86), _leg("tights", 0.0, 0.0, 0.0, 0.012, 0.62)
        bust = [_ellipsoid(f"{side}_bust", "top", "chest", (x, 1.268, 0.074), (0.066, 0.064, 0.052), 0.04)
                for side, x in (("left", 0.066), ("right", -0.066))]  # fmt: skip
        body = [*_torso("top", 0.97, 1.0, 0.004), *bust]
        head, hair = [part for part in _head() if not part.name.endswith("ear")], _hair_bob()
    elif costume == "dress":
        garment = _skirt(1.110, 0.235, (0.130, 0.094), (0.335, 0.305), 12, 0.085, "skirt")
        arm, leg = _arm("bodice", 0.010, 0.004, 0.0), _leg("skin", 0.0, 0.0, 0.0, 0.0, 0.0)
        bust = [_ellipsoid(f"{side}_bust", "bodice", "chest", (x, 1.268, 0.074), (0.068, 0.066, 0.054), 0.04)
                for side, x in (("left", 0.067), ("right", -0.067))]  # fmt: skip
        body = [*_torso("bodice", 0.95, 0.98, 0.003), *bust]
        head, hair = _head(), _hair_bun()
    else:
        garment = _skirt(1.150, 0.735, (0.158, 0.122), (0.225, 0.188), 7, 0.055, "coat")
        arm, leg = _arm("coat", 0.015, 0.017, 0.93), _leg("trousers", 0.012, 0.014, 0.012, 0.0, 0.0)
        body = [*_torso("coat", 1.03, 1.06, 0.016),
                _ellipsoid("collar", "coat", "chest", (0, 1.432, -0.022), (0.090, 0.036, 0.078), 0.02)]  # fmt: skip
        head, hair = _head(), _hair_short()
    limbs = [*leg, *_mirrored(leg)]
    arms = [*arm, *_mirrored(arm)]
    return (*body, *garment, *limbs, *arms, *head, *hair)
