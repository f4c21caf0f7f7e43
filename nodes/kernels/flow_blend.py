"""Blending two renders of one shape along the optical flow between them, instead of on top of each other."""

from __future__ import annotations

from typing import Literal

import cv2
import numpy as np

Flow = Literal["dis", "farneback", "none"]


def flow_blend(
    first: np.ndarray,
    second: np.ndarray,
    weight: float,
    inside: np.ndarray,
    confidence: np.ndarray | None = None,
    *,
    method: Flow = "dis",
    tolerance: float = 1.5,
    reach: float = 24.0,
) -> np.ndarray:
    """The picture (H, W, 3) float32 that shows `weight` of the first and 1 - weight of the second.

    first, second (H, W, 3) float32, 0..255, of the same proxy from the same viewpoint; inside (H, W) bool:
    where they show it; confidence (2, H, W): how far each is to be trusted (default: alike). With
    s = 1 - weight and a the flow (px) from first to second, defined on the blended picture:
    out(x) = (1 - q) first(x - s a(x)) + q second(x + (1 - s) a(x)), where q = s, or with confidences c1, c2
    q = s c2 / ((1 - s) c1 + s c2), so that what only one of them knows comes from that one. So s = 0 and
    s = 1 return the inputs exactly. a(x) is found from the two-way flows F12, F21 by a(x) <- (1 - s) F12(x -
    s a) - s F21(x + (1 - s) a), iterated, and damped by exp(-(e / tolerance)^2), e the forward-backward
    error |F12(x) + F21(x + F12)| px, and where it exceeds `reach` px: there the blend falls back to a
    cross-fade.

    Source: 004 eqs 5.2-5.3 (after Eisemann et al. 2008, "Floating textures"); DIS: Kroeger et al. 2016, ECCV;
    Farneback 2003, SCIA. Departure: as printed the flow is defined on an end point and both weights are on
    the wrong picture, which warps the end points away; here it is defined on the blended picture.
    """
    share = 1.0 - float(weight)
    if share <= 0:
        return first.astype(np.float32, copy=True)
    if share >= 1:
        return second.astype(np.float32, copy=True)
    mix = np.full((*inside.shape, 1), share, np.float32)
    if confidence is not None:
        one, two = weight * (confidence[0] + 1e-3), share * (confidence[1] + 1e-3)
        mix[..., 0] = two / (one + two)
    if method == "none" or min(inside.shape) < 16:
        return ((1 - mix) * first + mix * second).astype(np.float32)
    first, second = _extend(first, inside), _extend(second, inside)
    one, two = _guide(first), _guide(second)
    there, back = _flow(one, two, method), _flow(two, one, method)
    forward = _damped(there, back, inside, tolerance, reach)
    backward = _damped(back, there, inside, tolerance, reach)
    middle = (1 - share) * forward - share * backward
    for _ in range(3):
        middle = (1 - share) * _at(forward, -share * middle) - share * _at(backward, (1 - share) * middle)
    blended: np.ndarray = (1 - mix) * _at(first, -share * middle) + mix * _at(second, (1 - share) * middle)
    return blended


def _extend(picture: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Outside takes the colour of the nearest pixel inside, so that a warp never pulls in the background."""
    _, label = cv2.distanceTransformWithLabels(
        (~inside).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    colours = np.zeros((label.max() + 1, 3), np.float32)
    colours[label[inside]] = picture[inside]
    return colours[label]


def _guide(picture: np.ndarray) -> np.ndarray:
    """Grey bytes."""
    grey = picture @ np.array([0.299, 0.587, 0.114], np.float32)
    return np.rint(grey).clip(0, 255).astype(np.uint8)


def _damped(
    flow: np.ndarray, opposite: np.ndarray, inside: np.ndarray, tolerance: float, reach: float
) -> np.ndarray:
    """The flow where going there and back ends near the start, fading to zero where it does not."""
    error = np.linalg.norm(flow + _at(opposite, flow), axis=-1)
    size = np.linalg.norm(flow, axis=-1)
    trust = np.exp(-np.square(error / tolerance)) * np.clip(2 - 2 * size / reach, 0, 1) * inside
    soft = cv2.GaussianBlur(trust.astype(np.float32), (0, 0), 1.5)
    return np.asarray(flow * soft[..., None], np.float32)


def _flow(first: np.ndarray, second: np.ndarray, method: Flow) -> np.ndarray:
    """Flow (H, W, 2) float32 px: first(x) shows what second(x + flow(x)) shows."""
    if method == "farneback":
        start = np.zeros((*first.shape, 2), np.float32)
        flow = cv2.calcOpticalFlowFarneback(first, second, start, 0.5, 4, 15, 3, 5, 1.1, 0)
    else:
        flow = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM).calc(first, second, None)
    return np.asarray(flow, np.float32)


def _at(field: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """field(x + offset(x)), bilinear, clamped at the borders."""
    height, width = offset.shape[:2]
    y, x = np.mgrid[:height, :width].astype(np.float32)
    return cv2.remap(
        np.ascontiguousarray(field, np.float32),
        (x + offset[..., 0]).astype(np.float32),
        (y + offset[..., 1]).astype(np.float32),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )
