"""Footage of a textured mesh sequence in front of a keying backdrop."""

from __future__ import annotations

import hashlib
from typing import Annotated, Literal

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.antialiased_view import sample_view
from reperform.nodes.kernels.camera import centre
from reperform.nodes.kernels.film_noise import expose
from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.stage_light import cyclorama, lambert, shadow_map
from reperform.nodes.kernels.texture_shade import shade_samples
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Footage
from reperform.nodes.products.mesh import MeshSequence, TextureAtlas

Backdrop = Literal["blue", "green", "grey"]
BACKDROPS: dict[str, tuple[float, float, float]] = {
    "blue": (36.0, 74.0, 178.0),
    "green": (52.0, 168.0, 72.0),
    "grey": (128.0, 128.0, 126.0),
}


@node(over="view")
def film(
    mesh: MeshSequence,
    texture: TextureAtlas,
    cameras: Cameras,
    *,
    backdrop: Annotated[Backdrop, Param("", about="colour of floor and wall")] = "blue",
    unevenness: Annotated[
        float, Param("1", 0.0, 0.5, "relative change of the backdrop's light over the set")
    ] = 0.12,
    spill: Annotated[float, Param("1", 0.0, 1.0, "share of backdrop colour at the silhouettes")] = 0.18,
    shadow: Annotated[float, Param("1", 0.0, 1.0, "how dark the contact shadow is")] = 0.7,
    noise: Annotated[
        float, Param("1/255", 0.0, 30.0, "standard deviation of the sensor noise in the highlights")
    ] = 2.0,
    colour_cast: Annotated[
        float, Param("1", 0.0, 0.3, "standard deviation of each camera's channel gains")
    ] = 0.0,
    exposure: Annotated[float, Param("1", 0.2, 3.0, "gain of the light on the performer")] = 1.0,
    supersampling: Annotated[int, Param("samples", 1, 8, "samples along a pixel's edge")] = 3,
    seed: Annotated[int, Param("", 0, 2**31 - 1, "of noise and colour cast")] = 0,
) -> Footage:
    """What one camera records of a textured mesh on a keying stage, one picture per frame.

    mesh: vertices (V, 3) m, faces (F, 3); texture: its atlas; cameras: one camera. Returns images (height,
    width, 3) uint8. Each pixel is alpha * mean of the samples that hit the surface + (1 - alpha) *
    backdrop, where a sample is texture * (sum_k s_k max(0, n . l_k) + ambient) with a share spill (0.15 +
    0.85 (1 - |n . v|)^3) of the backdrop's colour, and the backdrop is its colour times an uneven light
    times the contact shadow. Then each camera's gains and noise of deviation noise * sqrt(0.2 + 0.8 I /
    255) are applied. The noise depends on the surface, the camera and the seed, and on nothing else.

    Raises ValueError where the atlas does not belong to the mesh.
    Source: 004 section 2.2 (blue-screen studio); Foi et al. 2008, IEEE TIP 17(10) (signal-dependent noise).
    Departure: lamps are soft and unshadowed except on the floor; exposure time is not modelled (one view
    has no neighbouring frames).
    """
    if len(texture.faces_uv) != len(mesh.faces):
        raise ValueError(
            f"studio.film: the texture must have one uv triangle per face of the mesh ({len(mesh.faces)}), "
            f"got {len(texture.faces_uv)}: wire mesh and texture of the same performance"
        )
    colour = np.array(BACKDROPS[backdrop], np.float32)
    samples = sample_view(mesh.vertices, mesh.faces, *cameras[:5], supersampling)
    fallen = shadow_map(mesh.vertices, mesh.faces) if shadow > 0 else None
    set_light = cyclorama(*cameras[:3], cameras.image_size, unevenness, fallen, shadow)
    picture = set_light[..., None] * colour
    if samples.ids.size:
        light, veil = _light(mesh, centre(cameras.rotation, cameras.translation), spill, exposure)
        surface, alpha = shade_samples(
            samples.ids, samples.barycentric, mesh.faces, texture.faces_uv, texture.uv, texture.image,
            light, veil, colour, supersampling,
        )  # fmt: skip
        picture[samples.block] = surface + (1 - alpha[..., None]) * picture[samples.block]
    pose = np.concatenate([cameras.rotation.ravel(), cameras.translation.ravel()])
    gains = 1 + colour_cast * np.random.default_rng(_digest(seed, pose)).standard_normal(3)
    return Footage(
        expose(picture, gains.astype(np.float32), noise, _digest(seed, pose, mesh.vertices)), mesh.fps
    )


def _light(
    mesh: MeshSequence, eye: np.ndarray, spill: float, exposure: float
) -> tuple[np.ndarray, np.ndarray]:
    """At every vertex: the light on it, and the share of the backdrop that it mirrors; float32 (V,)."""
    vertices = np.asarray(mesh.vertices, np.float32)
    normals = vertex_normals(vertices, mesh.faces)
    view = eye.astype(np.float32) - vertices
    view /= np.linalg.norm(view, axis=1, keepdims=True)
    grazing = (1 - np.abs((normals * view).sum(axis=1))) ** 3
    return np.float32(exposure) * lambert(normals), np.float32(spill) * (0.15 + 0.85 * grazing)


def _digest(seed: int, *arrays: np.ndarray) -> int:
    """A 62-bit number that stands for the seed and the arrays' content."""
    digest = hashlib.blake2b(str(seed).encode(), digest_size=8)
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    return int.from_bytes(digest.digest(), "little") >> 2
