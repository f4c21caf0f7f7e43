"""Footage of a textured mesh sequence in front of a keying backdrop."""

from __future__ import annotations

import hashlib
from typing import Annotated, Literal

import cv2
import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.antialiased_view import Samples, coverage, pixel_mean, sample_view
from reperform.nodes.kernels.camera import centre
from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.stage_light import cyclorama, lambert, shadow_map
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

    mesh: vertices (V, 3) m, faces (F, 3); texture: its atlas; cameras: one camera. Returns images (height, width, 3)
    uint8. Each pixel is alpha * mean of the samples that hit the surface + (1 - alpha) * backdrop, where a sample is
    texture * (sum_k s_k max(0, n . l_k) + ambient) with a share spill (0.15 + 0.85 (1 - |n . v|)^3) of the
    backdrop's colour, and the backdrop is its colour times an uneven light times the contact shadow. Then each
    camera's gains and noise of deviation noise * sqrt(0.2 + 0.8 I / 255) are applied. The noise depends on the
    surface, the camera and the seed, and on nothing else.

    Raises ValueError where the atlas does not belong to the mesh.
    Source: 004 section 2.2 (blue-screen studio); Foi et al. 2008, IEEE TIP 17(10) (signal-dependent noise).
    Departure: lamps are soft and unshadowed except on the floor; exposure time is not modelled (one view has no
    neighbouring frames).
    """
    if len(texture.faces_uv) != len(mesh.faces):
        raise ValueError(
            f"studio.film: the texture must have one uv triangle per face of the mesh ({len(mesh.faces)}), "
            f"got {len(texture.faces_uv)}: wire mesh and texture of the same performance"
        )
    colour = np.array(BACKDROPS[backdrop], np.float32)
    samples = sample_view(mesh.vertices, mesh.faces, *cameras[:5], supersampling)
    fallen = shadow_map(mesh.vertices, mesh.faces) if shadow > 0 else None
    light = cyclorama(*cameras[:3], cameras.image_size, unevenness, fallen, shadow)
    picture = light[..., None] * colour
    if (samples.ids >= 0).any():
        alpha = coverage(samples, cameras.image_size)[samples.block][..., None]
        surface = _shade(
            samples, mesh, texture, centre(cameras.rotation, cameras.translation), colour, spill, exposure
        )
        picture[samples.block] = surface + (1 - alpha) * picture[samples.block]
    return Footage(_record(picture, mesh, cameras, noise, colour_cast, seed), mesh.fps)


def _shade(
    samples: Samples, mesh: MeshSequence, texture: TextureAtlas, eye: np.ndarray, colour: np.ndarray, spill: float,
    exposure: float,
) -> np.ndarray:  # fmt: skip
    """Colour of the surface summed over each pixel's samples (h, w, 3): premultiplied by its coverage."""
    normals = vertex_normals(np.asarray(mesh.vertices, np.float32), mesh.faces)
    view = eye - mesh.vertices
    view /= np.linalg.norm(view, axis=1, keepdims=True)
    grazing = (1 - np.abs((normals * view).sum(axis=1))) ** 3
    at_vertex = np.column_stack([exposure * lambert(normals), spill * (0.15 + 0.85 * grazing)]).astype(
        np.float32
    )
    hit = samples.ids >= 0
    ids, barycentric = samples.ids[hit], samples.barycentric[hit]
    b = barycentric[:, :, None]
    corners, corners_uv = mesh.faces[ids], texture.faces_uv[ids]
    lit = sum(at_vertex[corners[:, k]] * b[:, k] for k in range(3))
    uv = sum(texture.uv[corners_uv[:, k]] * b[:, k] for k in range(3))
    albedo = _look_up(texture.image, uv)
    shaded = albedo * lit[:, :1] * (1 - lit[:, 1:]) + lit[:, 1:] * colour
    fine = np.zeros((*samples.ids.shape, 3), np.float32)
    fine[hit] = shaded
    return pixel_mean(fine, samples.per_edge)


def _look_up(image: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Bilinear colours (N, 3) float32 of an atlas at uv (N, 2)."""
    height, width = image.shape[:2]
    # OpenCV remaps pictures, not lists: the list is folded into rows
    rows = -(-len(uv) // 1024)
    at = np.zeros((rows * 1024, 2), np.float32)
    at[: len(uv), 0] = uv[:, 0] * width - 0.5
    at[: len(uv), 1] = (1 - uv[:, 1]) * height - 0.5
    found = cv2.remap(
        image, at.reshape(rows, 1024, 2), None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    return found.reshape(-1, 3)[: len(uv)].astype(np.float32)


def _record(
    picture: np.ndarray, mesh: MeshSequence, cameras: Cameras, noise: float, colour_cast: float, seed: int
) -> np.ndarray:
    camera = np.concatenate([cameras.rotation.ravel(), cameras.translation.ravel()])
    if colour_cast > 0:
        gains = _generator(seed, camera).normal(1.0, colour_cast, 3)
        picture = picture * gains.astype(np.float32)
    if noise > 0:
        random = _generator(seed, camera, mesh.vertices).standard_normal(picture.shape, np.float32)
        random *= np.float32(noise) * np.sqrt(0.2 + 0.8 / 255 * np.clip(picture, 0, 255))
        picture = picture + random
    return np.rint(np.clip(picture, 0, 255)).astype(np.uint8)


def _generator(seed: int, *arrays: np.ndarray) -> np.random.Generator:
    digest = hashlib.blake2b(str(seed).encode(), digest_size=8)
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    return np.random.Generator(np.random.SFC64(int.from_bytes(digest.digest(), "little")))
