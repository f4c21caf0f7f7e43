import numpy as np
import pytest
import trimesh

from reperform.nodes.align.register import register
from reperform.nodes.kernels.turn_search import turn_matrix
from reperform.nodes.products.mesh import Surfaces
from reperform.nodes.products.motion import ShapeTree
from reperform.nodes.ragged import Ragged

QUICK = {"patches": 12, "levels": 3, "iterations": 4}
ANGLES = {"nod": [0.0, 0.12, 0.24, 0.36], "turned": [0.3, 0.18, 0.06]}
PLACE = {"nod": (0.0, np.zeros(3)), "turned": (1.3, np.array([1.5, 0, -0.6]))}


def _rest(seed):
    """Points of one solid, tessellated anew for every seed: a sausage with an arm on one side and a nose."""
    mesh = trimesh.creation.icosphere(3)
    mesh.apply_transform(
        trimesh.transformations.random_rotation_matrix(np.random.default_rng(seed).random(3))
    )
    rest = mesh.vertices * (0.16, 0.6, 0.12)
    rest[:, 0] += 0.25 * np.exp(-30 * ((mesh.vertices - (0.8, 0.6, 0)) ** 2).sum(1))
    rest[:, 2] += 0.12 * np.exp(-30 * ((mesh.vertices - (-0.3, -0.3, 0.9)) ** 2).sum(1))
    return rest, mesh.faces.astype(np.int32)


def _posed(rest, take, frame):
    turn = ANGLES[take][frame] * np.clip(rest[:, 1] / 0.6, 0, 1)
    x = rest[:, 0] * np.cos(turn) + rest[:, 1] * np.sin(turn)
    y = rest[:, 1] * np.cos(turn) - rest[:, 0] * np.sin(turn)
    yaw, offset = PLACE[take]
    return np.column_stack([x, y + 0.7, rest[:, 2]]) @ turn_matrix(yaw).T + offset


@pytest.fixture(scope="module")
def surfaces():
    takes, seed = {}, 0
    for take, angles in ANGLES.items():
        vertices, faces = [], []
        for frame in range(len(angles)):
            rest, triangles = _rest(seed)
            seed += 1
            vertices.append(_posed(rest, take, frame).astype(np.float32))
            faces.append(triangles)
        takes[take] = Surfaces(Ragged(vertices), Ragged(faces), np.float32(25))
    return takes


@pytest.fixture(scope="module")
def tree():
    # rows 0..3 nod, 4..6 turned; the root is nod frame 1; turned hangs from nod frame 3 by its frame 0
    parent = np.array([1, 1, 1, 2, 3, 4, 5], np.int32)
    take, frame = np.array([0] * 4 + [1] * 3, np.int32), np.array([0, 1, 2, 3, 0, 1, 2], np.int32)
    order = np.array([1, 0, 2, 3, 4, 5, 6], np.int32)
    return ShapeTree(np.array(list(ANGLES)), take, frame, parent, np.ones(7, np.float32), order)


@pytest.fixture(scope="module")
def aligned(surfaces, tree):
    return register(surfaces, tree, root="tree", **QUICK)


def test_one_topology_that_follows_the_true_points(aligned, surfaces):
    rest, faces = _rest(1)
    for take, sequence in aligned.items():
        np.testing.assert_array_equal(sequence.mesh.faces, faces)
        truth = np.stack([_posed(rest, take, k) for k in range(len(ANGLES[take]))])
        error = np.linalg.norm(sequence.mesh.vertices - truth, axis=2)
        assert error.mean() < 0.008, take
        assert np.percentile(error, 95) < 0.02, take
        assert sequence.mesh.vertices.dtype == np.float32
        assert sequence.mesh.fps == 25


def test_root_is_kept_and_named_and_figures_are_plausible(aligned, surfaces):
    nod = aligned["nod"]
    np.testing.assert_array_equal(nod.mesh.vertices[1], surfaces["nod"].vertices[1])
    assert (str(nod.root_take), int(nod.root_frame)) == ("nod", 1)
    assert nod.residual[1] == nod.stretch[1] == 0
    assert 0 < nod.residual[3] < 0.006
    assert all(sequence.trusted.all() for sequence in aligned.values())


def test_gates_mistrust(surfaces, tree):
    strict = register(surfaces, tree, root="tree", residual_gate=1e-5, patches=8, levels=1, iterations=1)
    np.testing.assert_array_equal(strict["nod"].trusted, [False, True, False, False])


def test_spread_chooses_the_surface_with_clear_limbs(surfaces, tree):
    closed = dict(surfaces)
    # shrink the arm of all frames but one: it then shows most
    thick = [np.asarray(v) * np.float32(1) for v in surfaces["nod"].vertices]
    for k in (0, 1, 2):
        thick[k] = thick[k] * np.float32([1.5, 1, 1.5])
    closed["nod"] = surfaces["nod"]._replace(vertices=Ragged(thick))
    closed["turned"] = surfaces["turned"]._replace(
        vertices=Ragged([v * np.float32([1.5, 1, 1.5]) for v in surfaces["turned"].vertices])
    )
    found = register(closed, tree, root="spread", patches=8, levels=1, iterations=1)
    assert (str(found["nod"].root_take), int(found["nod"].root_frame)) == ("nod", 3)


def _lumps(*lumps):
    """One closed surface: a ball with bumps (direction, height, sharpness)."""
    ball = trimesh.creation.icosphere(3)
    radius = np.full(len(ball.vertices), 0.3)
    for direction, height, sharpness in lumps:
        away = ((ball.vertices - np.array(direction) / np.linalg.norm(direction)) ** 2).sum(axis=1)
        radius += height * np.exp(-sharpness * away)
    return (ball.vertices * radius[:, None] + (0, 1, 0)).astype(np.float32), ball.faces.astype(np.int32)


def _still(shapes):
    vertices, faces = zip(*shapes, strict=True)
    take, frame = np.zeros(len(shapes), np.int32), np.arange(len(shapes), dtype=np.int32)
    tree = ShapeTree(np.array(["still"]), take, frame, np.maximum(frame - 1, 0), np.ones(len(shapes)), frame)
    return {"still": Surfaces(Ragged(vertices), Ragged(faces), np.float32(25))}, tree


def test_limbs_chooses_the_frame_whose_least_free_limb_is_freest():
    arm, leg, head = ((1, 0, 0), 0.5, 12), ((-0.2, -1, 0.1), 0.6, 12), ((0.1, 1, 0.3), 0.3, 12)
    cape = ((1, 0.1, 0.2), 0.5, 1.5)
    surfaces, tree = _still(
        [
            # one limb longer, another shorter
            _lumps((leg[0], 1.0, 12), head, (arm[0], 0.1, 12)),
            _lumps(leg, head, arm, cape),
            _lumps(leg, head, arm),
            # most surface for its volume, since something stands out that is no limb
            _lumps(leg, head, arm, ((0, 0, -1), 0.3, 12)),
        ]
    )
    quick = {"patches": 8, "levels": 1, "iterations": 1}
    found = {
        root: int(register(surfaces, tree, root=root, limbs=3, **quick)["still"].root_frame)
        for root in ("limbs", "spread", "tree")
    }
    assert found == {"limbs": 2, "spread": 3, "tree": 0}


def _rod():
    ball = trimesh.creation.icosphere(2)
    lean = np.column_stack([0 * ball.vertices[:, 0], 0.1 * ball.vertices[:, 0], 0 * ball.vertices[:, 0]])
    return ball.vertices * (0.05, 0.3, 0.07) + lean + (0, 0.5, 0), ball.faces.astype(np.int32)


def _follow_rod(places, root, **options):
    """How far each vertex of a rod comes to lie from where it is, (frame, V), m."""
    rod, faces = _rod()
    true = np.stack([rod + (x, 0, 0) for x in places]).astype(np.float32)
    surfaces, tree = _still([(vertices, faces) for vertices in true])
    frame = tree.frame_index
    parent = np.where(frame < root, frame + 1, np.maximum(frame - 1, root)).astype(np.int32)
    order = np.argsort(np.abs(frame - root), kind="stable").astype(np.int32)
    tree = tree._replace(parent=parent, order=order)
    found = register(surfaces, tree, root="tree", patches=8, reach=0.08, **options)
    return np.linalg.norm(found["still"].mesh.vertices - true, axis=2)


def test_the_way_on_which_less_moves_tells_the_motion_of_the_other():
    # the way back is 0.16 m; the way on is farther than any closest point pulls
    away = _follow_rod((-0.16, 0, 0.37), 1, levels=1, iterations=10)
    assert away.mean(axis=1).max() < 0.02


def test_the_second_step_tells_where_the_first_leads():
    away = _follow_rod((0, 0.22, 0.44), 0, levels=2)
    assert away.mean(axis=1).max() < 0.004


def test_refuses_a_tree_of_other_surfaces(surfaces, tree):
    with pytest.raises(ValueError, match="3 frames of take turned, the surfaces have no such take"):
        register({"nod": surfaces["nod"]}, tree)
    fewer = surfaces["nod"]._replace(vertices=surfaces["nod"].vertices[:3], faces=surfaces["nod"].faces[:3])
    with pytest.raises(ValueError, match="4 frames of take nod, the surfaces have 3 frames"):
        register(surfaces | {"nod": fewer}, tree)


def test_footage_without_cameras_is_refused(surfaces, tree):
    with pytest.raises(ValueError, match="register: footage and cameras go together, got footage only"):
        register(surfaces, tree, {})
