"""Whether two takes can be compared vertex by vertex and frame by frame."""

from __future__ import annotations

import hashlib

import numpy as np


def require_one_topology(who: str, faces: tuple[np.ndarray, np.ndarray], vertices: tuple[int, int]) -> None:
    """Raise ValueError, in the name of `who`, where two takes differ in faces or number of vertices."""
    digests = [hashlib.blake2b(np.ascontiguousarray(f).tobytes(), digest_size=6).hexdigest() for f in faces]
    if digests[0] != digests[1] or vertices[0] != vertices[1]:
        raise ValueError(
            f"{who}: both takes must share one topology, got {vertices[0]} vertices with faces {digests[0]} "
            f"and {vertices[1]} vertices with faces {digests[1]}: align the takes first (align.register)"
        )


def require_one_rate(who: str, a: np.ndarray, b: np.ndarray) -> None:
    """Raise ValueError, in the name of `who`, where two frame rates (Hz) differ."""
    if not np.isclose(a, b, rtol=1e-4):
        raise ValueError(
            f"{who}: both takes must have one frame rate, got {float(a):g} and {float(b):g} Hz: "
            "resample one of them"
        )
