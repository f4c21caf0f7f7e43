import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from reperform.nodes.export.bvh import write_bvh
from reperform.nodes.products.performance import SkeletonSequence

PARENTS = np.array([-1, 0, 1, 2, 1, 4, 0], np.int32)
NAMES = np.array(["hips", "spine", "left arm", "left_hand", "right_arm", "right_hand", "leg"])


def read(path) -> tuple[np.ndarray, float]:
    """Joint positions of a BVH, by its own definition."""
    words = path.read_text().split()
    offsets, parents, channels, stack, skip = [], [], [], [], False
    k = 0
    while words[k] != "MOTION":
        if words[k] in ("ROOT", "JOINT"):
            parents.append(stack[-1] if stack else -1)
        elif words[k] == "End":
            skip = True
        elif words[k] == "{":
            stack.append(len(parents) - 1)
        elif words[k] == "}":
            stack.pop()
            skip = False
        elif words[k] == "OFFSET" and not skip:
            offsets.append([float(w) for w in words[k + 1 : k + 4]])
        elif words[k] == "CHANNELS":
            channels.append(words[k + 2 : k + 2 + int(words[k + 1])])
        k += 1
    frames, dt = int(words[k + 2]), float(words[k + 5])
    values = np.array(words[k + 6 :], float).reshape(frames, -1)
    positions = np.zeros((frames, len(parents), 3))
    for f in range(frames):
        at, turns = 0, []
        for joint, names in enumerate(channels):
            row = dict(zip(names, values[f, at : at + len(names)], strict=True))
            at += len(names)
            order = [name[0] for name in names if name.endswith("rotation")]
            local = Rotation.from_euler("".join(order), [row[a + "rotation"] for a in order], degrees=True)
            if joint == 0:
                positions[f, 0] = [row[a + "position"] for a in "XYZ"]
                turns.append(local)
            else:
                up = turns[parents[joint]]
                positions[f, joint] = positions[f, parents[joint]] + up.apply(offsets[joint])
                turns.append(up * local)
    return positions, dt


def depth_first() -> list[int]:
    return [0, 1, 2, 3, 4, 5, 6]


def skeleton(frames: int = 9) -> SkeletonSequence:
    """Bones of constant length, turning at random."""
    random = np.random.default_rng(4)
    offsets = random.normal(size=(7, 3)) * 0.3
    positions = np.zeros((frames, 7, 3))
    for f in range(frames):
        turns = [Rotation.random(random_state=random.integers(1 << 30)) for _ in range(7)]
        positions[f, 0] = random.normal(size=3)
        for joint in range(1, 7):
            positions[f, joint] = positions[f, PARENTS[joint]] + turns[PARENTS[joint]].apply(offsets[joint])
    return SkeletonSequence(positions.astype(np.float32), PARENTS, NAMES, np.float32(25))


def test_positions_come_back(tmp_path):
    made = skeleton()
    write_bvh(tmp_path / "a.bvh", made)
    positions, dt = read(tmp_path / "a.bvh")
    np.testing.assert_allclose(positions[:, depth_first()], made.joints, atol=2e-5)
    assert dt == pytest.approx(0.04)


def test_refuses_children_before_parents(tmp_path):
    made = skeleton()
    with pytest.raises(ValueError, match="parents before children"):
        write_bvh(tmp_path / "a.bvh", made._replace(parents=np.array([-1, 2, 0, 2, 1, 4, 0], np.int32)))
    assert not (tmp_path / "a.bvh").exists()


def test_real_walk_keeps_its_joints(tmp_path, data_folder):
    clip = np.load(data_folder / "twin" / "walk.npz")
    made = SkeletonSequence(
        clip["joints"][::6], clip["joint_parents"], clip["joint_names"], np.float32(25 / 6)
    )
    write_bvh(tmp_path / "walk.bvh", made)
    positions, _ = read(tmp_path / "walk.bvh")
    order = list(_order(made.parents))
    assert np.abs(positions - made.joints[:, order]).max() < 0.02


def _order(parents: np.ndarray, joint: int = 0):
    yield joint
    for child in np.flatnonzero(parents == joint):
        yield from _order(parents, child)
