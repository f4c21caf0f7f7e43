import numpy as np
import pytest

from reperform.nodes.kernels.gltf_file import Gltf
from reperform.nodes.kernels.gltf_surface import CELL, rigged_surface


@pytest.fixture
def gltf() -> Gltf:
    """A quad whose two triangles do not share vertices in the file, hung on a node, and a skinned triangle."""
    quad = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "<f4")
    bones = np.array([[0, 1, 0, 0]] * 3, "u1")
    weights = np.array([[2, 2, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0]], "<f4")
    binds = np.stack([np.eye(4), np.eye(4)]).astype("<f4")
    binds[1, 3, :3] = (0, -1, 0)
    parts = [quad.tobytes(), quad[:3].tobytes(), bones.tobytes(), weights.tobytes(), binds.tobytes()]
    views, offset = [], 0
    for part in parts:
        views.append({"byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    description = {
        "nodes": [{"name": "board", "mesh": 0}, {"name": "flag", "mesh": 1, "skin": 0}, {}, {}],
        "skins": [{"joints": [2, 3], "inverseBindMatrices": 4}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
            {"primitives": [{"attributes": {"POSITION": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}, "material": 1}]},
        ],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}, {}],
        "bufferViews": views,
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 6},
            {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 3},
            {"bufferView": 2, "componentType": 5121, "type": "VEC4", "count": 3},
            {"bufferView": 3, "componentType": 5126, "type": "VEC4", "count": 3},
            {"bufferView": 4, "componentType": 5126, "type": "MAT4", "count": 2},
        ],
    }
    return Gltf("board.glb", description, b"".join(parts))


def test_vertices_that_coincide_and_move_alike_are_welded(gltf):
    surface = rigged_surface(gltf)
    assert len(surface.vertices) == 4 + 3
    assert surface.faces.shape == (3, 3) and len(np.unique(surface.faces)) == 7


def test_weights_are_normalised_and_slots_follow_their_nodes(gltf):
    surface = rigged_surface(gltf)
    np.testing.assert_allclose(surface.weight.sum(axis=1), 1)
    used = [set(surface.node[surface.slot[v][surface.weight[v] > 0]]) for v in surface.faces[2]]
    assert used == [{2, 3}, {2}, {2}]
    assert {int(surface.node[surface.slot[v, 0]]) for v in surface.faces[0]} == {0}
    np.testing.assert_allclose(surface.bind[2][:3, 3], [0, -1, 0])


def test_flat_colours_become_cells(gltf):
    surface = rigged_surface(gltf)
    assert surface.image.shape == (CELL, 2 * CELL, 3)
    for face, colour in ((0, [255, 0, 0]), (2, [255, 255, 255])):
        u, v = surface.uv[surface.faces_uv[face]].mean(axis=0)
        assert surface.image[int((1 - v) * CELL), int(u * 2 * CELL)].tolist() == colour


def test_leaving_out(gltf):
    assert len(rigged_surface(gltf, ["flag"]).faces) == 2
    with pytest.raises(ValueError, match="no mesh node 'sword' to leave out; it has: board, flag"):
        rigged_surface(gltf, ["sword"])
    with pytest.raises(ValueError, match="has no triangles"):
        rigged_surface(gltf, ["board", "flag"])
