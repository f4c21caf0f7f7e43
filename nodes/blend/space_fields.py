"""The compiled evaluation's view of a blend space, and a blend space from what was built."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reperform.nodes.kernels.hybrid_blend import HybridFields
from reperform.nodes.kernels.hybrid_build import Hybrid
from reperform.nodes.products.blend_space import BlendSpace

CODES = {8: np.int8, 16: np.int16}


def hybrid_fields(space: BlendSpace) -> HybridFields:
    """Plain arrays for `evaluate`, without copies where the product is in memory."""
    inputs = np.ascontiguousarray(space.vertices, np.float32)
    return HybridFields(
        inputs=inputs.reshape(*inputs.shape[:2], -1),
        split=np.ascontiguousarray(space.split),
        child=np.ascontiguousarray(space.child),
        start=np.ascontiguousarray(space.start),
        first=np.ascontiguousarray(space.first),
        begin=np.ascontiguousarray(space.begin),
        code=np.ascontiguousarray(space.code).view(CODES[int(space.bits)]),
        step=np.ascontiguousarray(space.step),
    )


def blend_space(
    built: Hybrid, takes: Sequence[str], faces: np.ndarray, fps: np.ndarray, epsilon: float
) -> BlendSpace:
    """The product of fields that were built."""
    fields = built.fields
    return BlendSpace(
        takes=np.array(list(takes)),
        vertices=fields.inputs.reshape(*fields.inputs.shape[:2], -1, 3),
        faces=np.asarray(faces, np.int32),
        fps=np.asarray(fps, np.float32),
        weights=built.weights,
        error=built.error,
        epsilon=np.asarray(epsilon, np.float64),
        bits=np.asarray(8 * fields.code.itemsize, np.int32),
        split=fields.split,
        child=fields.child,
        start=fields.start,
        first=fields.first,
        begin=fields.begin,
        code=fields.code.view(np.uint8),
        step=fields.step,
    )
