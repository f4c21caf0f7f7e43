import numpy as np
import trimesh

from reperform.nodes.kernels.chart_atlas import chart_atlas, fill_gutters, texel_hits
from reperform.nodes.kernels.mesh_geometry import face_areas, face_normals


def bumpy() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(4)
    direction = mesh.vertices
    radius = 0.4 + 0.08 * np.sin(3 * direction[:, 0] + 1) * np.cos(4 * direction[:, 1])
    return (direction * radius[:, None] * (1.0, 1.6, 0.7)).astype(np.float32), mesh.faces.astype(np.int32)


def signed_areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (points[faces[:, k]].astype(float) for k in range(3))
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def test_charts_fit_do_not_overlap_and_are_not_mirrored():
    vertices, faces = bumpy()
    uv, faces_uv = chart_atlas(vertices, faces, 512)
    assert uv.min() >= 0 and uv.max() <= 1
    areas = signed_areas(uv, faces_uv) * 512**2
    assert (areas > -1e-3).all()
    ids, _ = texel_hits(uv, faces_uv, 512, 512)
    shown = np.bincount(ids[ids >= 0], minlength=len(faces))
    assert abs(shown.sum() - areas.sum()) < 0.01 * areas.sum()
    assert areas.sum() > 0.3 * 512**2


def test_stretch_is_bounded_and_scale_is_one():
    vertices, faces = bumpy()
    uv, faces_uv = chart_atlas(vertices, faces, 512)
    flat = np.linalg.norm(uv[faces_uv] - np.roll(uv[faces_uv], 1, axis=1), axis=2)
    solid = np.linalg.norm(vertices[faces] - np.roll(vertices[faces], 1, axis=1), axis=2)
    ratio = flat / solid
    assert ratio.max() / np.quantile(ratio, 0.9) < 1.2
    # a face turned to its direction by its neighbours may lean a little further than the 55 degrees of a cube's corner
    assert np.quantile(ratio, 0.001) > 0.2 * ratio.max()


def test_corners_of_a_face_come_from_its_own_vertices():
    vertices, faces = bumpy()
    uv, faces_uv = chart_atlas(vertices, faces, 256)
    owner = np.full(len(uv), -1)
    owner[faces_uv.reshape(-1)] = faces.reshape(-1)
    assert (owner[faces_uv] == faces).all()


def test_denser_charts_get_more_texels():
    vertices, faces = bumpy()
    up = face_normals(vertices, faces)[:, 1]
    uv, faces_uv = chart_atlas(vertices, faces, 512, np.where(up > 0, 2.0, 1.0))
    scale = signed_areas(uv, faces_uv) / face_areas(vertices, faces)
    assert np.isclose(scale[up > 0.95].mean(), 4 * scale[up < -0.95].mean(), rtol=0.15)


def test_gutters_take_the_nearest_colour():
    image = np.zeros((5, 7, 3), np.uint8)
    painted = np.zeros((5, 7), bool)
    image[2, 1], image[2, 5] = (10, 20, 30), (200, 100, 50)
    painted[2, 1] = painted[2, 5] = True
    filled = fill_gutters(image, painted)
    assert filled[0, 0].tolist() == [10, 20, 30] and filled[4, 6].tolist() == [200, 100, 50]
