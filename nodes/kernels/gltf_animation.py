"""A glTF animation clip sampled in time."""

from __future__ import annotations

import difflib

import numpy as np
from scipy.spatial.transform import Rotation

from reperform.nodes.kernels.gltf_file import Gltf, local_transforms


def clip_names(gltf: Gltf) -> list[str]:
    """Names of the clips; unnamed ones are called by their place, such as `clip 3`."""
    return [clip.get("name", f"clip {index}") for index, clip in enumerate(gltf.entries("animations"))]


def find_clip(gltf: Gltf, name: str) -> int:
    """Index of a clip. Raises ValueError with the nearest names where there is none."""
    names = clip_names(gltf)
    if name in names:
        return names.index(name)
    lowered = [known for known in names if known.lower() == name.lower()]
    if len(lowered) == 1:
        return names.index(lowered[0])
    if not names:
        raise ValueError(f"{gltf.name}: has no animation clips: use a file with at least one")
    near = difflib.get_close_matches(name, names, n=3, cutoff=0.3)
    hint = f"did you mean {' or '.join(map(repr, near))}? " if near else ""
    listed = ", ".join(names[:12]) + (f" and {len(names) - 12} more" if len(names) > 12 else "")
    raise ValueError(f"{gltf.name}: has no clip {name!r}; {hint}it has: {listed}")


def clip_seconds(gltf: Gltf, clip: int) -> float:
    """Length of a clip: its latest key."""
    samplers = gltf.entries("animations")[clip]["samplers"]
    return max((float(gltf.array(sampler["input"]).max()) for sampler in samplers), default=0.0)


def sample_clip(gltf: Gltf, clip: int, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Local translation (T, N, 3), rotation (T, N, 4) x y z w and scale (T, N, 3) of all nodes at times (T,) in s.

    Keys are interpolated as the file says: STEP, LINEAR (spherical for rotations) or CUBICSPLINE; times before the
    first and after the last key hold that key. Nodes without keys stay at rest.
    """
    rest = local_transforms(gltf)
    translation, rotation, scale = (np.repeat(values[None], len(times), axis=0) for values in rest)
    targets = {"translation": translation, "rotation": rotation, "scale": scale}
    animation = gltf.entries("animations")[clip]
    for channel in animation["channels"]:
        target = channel["target"]
        if target.get("path") not in targets or "node" not in target:
            continue
        sampler = animation["samplers"][channel["sampler"]]
        keys = gltf.array(sampler["input"])[:, 0].astype(float)
        values = np.asarray(gltf.array(sampler["output"]), float)
        kind = sampler.get("interpolation", "LINEAR")
        path = target["path"]
        targets[path][:, target["node"]] = interpolate_keys(keys, values, times, kind, path == "rotation")
    return translation, rotation, scale


def interpolate_keys(
    keys: np.ndarray, values: np.ndarray, times: np.ndarray, kind: str, spherical: bool
) -> np.ndarray:
    """Values (T, D) at times (T,) of keys (K,); values (K, D), or (3 K, D) in tangent-value-tangent order for CUBICSPLINE."""
    times = np.clip(times, keys[0], keys[-1])
    at = np.clip(np.searchsorted(keys, times, side="right") - 1, 0, max(len(keys) - 2, 0))
    after = np.minimum(at + 1, len(keys) - 1)
    span = np.where(after > at, keys[after] - keys[at], 1.0)
    s = np.clip((times - keys[at]) / np.where(span > 0, span, 1.0), 0, 1)[:, None]
    if kind == "STEP":
        latest = np.searchsorted(keys, times, side="right") - 1
        return values[np.clip(latest, 0, len(keys) - 1)]
    if kind == "CUBICSPLINE":
        tangent_in, point, tangent_out = values.reshape(len(keys), 3, -1).transpose(1, 0, 2)
        step = span[:, None]
        found = (
            (2 * s**3 - 3 * s**2 + 1) * point[at]
            + step * (s**3 - 2 * s**2 + s) * tangent_out[at]
            + (3 * s**2 - 2 * s**3) * point[after]
            + step * (s**3 - s**2) * tangent_in[after]
        )
        return found / np.linalg.norm(found, axis=1, keepdims=True) if spherical else found
    if not spherical:
        return (1 - s) * values[at] + s * values[after]
    first, second = Rotation.from_quat(values[at]), Rotation.from_quat(values[after])
    step_between = (first.inv() * second).as_rotvec()
    return np.asarray((first * Rotation.from_rotvec(s * step_between)).as_quat())
