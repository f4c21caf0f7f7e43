import cv2
import numpy as np

from reperform.nodes.kernels.texture_shade import shade_samples


def test_against_opencv_and_numpy():
    random = np.random.default_rng(0)
    faces = random.integers(0, 6, (4, 3)).astype(np.int32)
    faces_uv = random.integers(0, 8, (4, 3)).astype(np.int32)
    uv = random.random((8, 2)).astype(np.float32)
    image = random.integers(0, 256, (20, 30, 3)).astype(np.uint8)
    light, veil = random.random((2, 6)).astype(np.float32)
    tone = np.array([10, 60, 200], np.float32)
    ids = random.integers(-1, 4, (9, 12)).astype(np.int32)
    barycentric = random.dirichlet((1, 1, 1), ids.shape).astype(np.float32)
    colour, alpha = shade_samples(ids, barycentric, faces, faces_uv, uv, image, light, veil, tone, 3)

    hit = ids >= 0
    at = np.einsum("nkc,nk->nc", uv[faces_uv[ids[hit]]], barycentric[hit])
    where = np.column_stack([at[:, 0] * 30 - 0.5, (1 - at[:, 1]) * 20 - 0.5]).astype(np.float32)
    texture = cv2.remap(
        image.astype(np.float32), where[None], None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )[0]
    bright = (light[faces[ids[hit]]] * barycentric[hit]).sum(1)[:, None]
    haze = (veil[faces[ids[hit]]] * barycentric[hit]).sum(1)[:, None]
    fine = np.zeros((9, 12, 3))
    fine[hit] = texture * bright * (1 - haze) + haze * tone
    # OpenCV rounds positions to 1/32 of a texel
    np.testing.assert_allclose(colour, fine.reshape(3, 3, 4, 3, 3).mean(axis=(1, 3)), atol=3.0)
    np.testing.assert_allclose(alpha, hit.reshape(3, 3, 4, 3).mean(axis=(1, 3)), atol=1e-6)
