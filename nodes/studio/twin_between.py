"""The true pose between two poses of a skinned human: half way in the angles of its joints."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np

from reperform.nodes.declaration import File, Param, node
from reperform.nodes.kernels.ground_plane import align, apply
from reperform.nodes.kernels.rotation import exp, slerp
from reperform.nodes.kernels.skinning import skin_linear
from reperform.nodes.products.mesh import MeshSequence

_WHO = "studio.twin_between"


@node(over="take")
def twin_between(
    *,
    folder: Annotated[str, File("folder with rest.npz, watertight.npz and one .npz per clip")],
    first: Annotated[str, Param("", about="CLIP:FRAME")],
    second: Annotated[str, Param("", about="CLIP:FRAME, laid on the first on the ground")],
    weight: Annotated[float, Param("1", 0.0, 1.0, "of the second pose")] = 0.5,
) -> MeshSequence:
    """One frame: the closed surface skinned with joint angles between those of two captured poses, m.

        R_j = R_parent slerp(R_parent^T R_j, R'_parent^T R'_j; w),   v = sum_j w_j (R_j v_rest + t_j)

    with the root between the roots. Weights 0 and 1 give the stored poses.

    Raises ValueError where a clip, frame or array is not there.
    Source: Shoemake 1985, SIGGRAPH (slerp); linear blend skinning as the twin was made with.
    """
    root = Path(folder)
    with np.load(root / "watertight.npz") as closed:
        rest, weights, faces = closed["rest_vertices"], closed["weights"], closed["faces"]
    with np.load(root / "rest.npz") as stored:
        heads = stored["bone_heads"].astype(np.float64)
    (turn, joints, parents, fps), (turn_b, joints_b, _, _) = (_pose(root, text) for text in (first, second))
    placement, _ = align(joints, joints_b)
    turn_b, joints_b = exp(np.array([0.0, placement.yaw, 0.0])) @ turn_b, apply(joints_b, placement)
    between, place = np.empty_like(turn), np.empty_like(joints)
    for j, parent in enumerate(parents.tolist()):
        if parent < 0:
            between[j] = slerp(turn[j], turn_b[j], weight)
            place[j] = (1.0 - weight) * joints[j] + weight * joints_b[j]
        else:
            local = slerp(turn[parent].T @ turn[j], turn_b[parent].T @ turn_b[j], weight)
            between[j] = between[parent] @ local
            place[j] = place[parent] + between[parent] @ (heads[j] - heads[parent])
    shift = place - np.einsum("jik,jk->ji", between, heads)
    vertices = skin_linear(rest, weights, between[None], shift[None])
    return MeshSequence(vertices, faces.astype(np.int32), np.asarray(fps, np.float32))


def _pose(root: Path, text: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Rotations (J, 3, 3) and joints (J, 3) of a pose, the joints' parents and the frame rate."""
    clip, _, frame = text.partition(":")
    path = root / f"{clip}.npz"
    if not clip or not path.is_file():
        raise ValueError(f"{_WHO}: a pose is CLIP:FRAME of a clip in {root.name}, got {text!r}")
    with np.load(path) as stored:
        transforms, joints = stored["transforms"], stored["joints"]
        if not frame.isdigit() or int(frame) >= len(joints):
            raise ValueError(f"{_WHO}: {clip} has frames 0 .. {len(joints) - 1}, got {text!r}")
        k = int(frame)
        turns = transforms[k, :, :, :3].astype(np.float64)
        return turns, joints[k].astype(np.float64), stored["joint_parents"], float(stored["fps"])
