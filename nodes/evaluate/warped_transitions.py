"""Warped transitions of variable length against the usual fixed linear ones, from and to the same poses."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.foot_contacts import FootContacts, foot_contacts
from reperform.nodes.kernels.foot_hold import hold_feet, leg_fields
from reperform.nodes.kernels.graph_moves import PlayedFrames, play_moves
from reperform.nodes.kernels.ground_plane import align
from reperform.nodes.kernels.join_acceleration import frame_accelerations
from reperform.nodes.kernels.mesh_geometry import volume
from reperform.nodes.kernels.path_contacts import path_contacts
from reperform.nodes.kernels.volume_keeping import with_volume
from reperform.nodes.product import Dataset, Pairs
from reperform.nodes.products.essential import PoseGraph
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Dissimilarity
from reperform.nodes.synthesis.play_walk import play_walk
from reperform.nodes.synthesis.pose_graph_walk import Graph, graph_of, walk_product

_WHO = "evaluate.warped_transitions"
# Captured frames played before and after each transition, so that its junctions can be seen.
_LEAD = 4


class _Played(NamedTuple):
    vertices: np.ndarray
    frames: PlayedFrames
    planted: np.ndarray


@node(over="dataset", memory=2.0)
def warped_transitions(
    graph: PoseGraph,
    similarity: Pairs[Dissimilarity],
    meshes: Dataset[MeshSequence],
    *,
    count: Annotated[int, Param("1", 1, 1000, "transitions drawn, at most as many as fit")] = 24,
    fixed: Annotated[float, Param("s", 0.04, 4.0, "length of the fixed transitions")] = 0.5,
    share: Annotated[
        float, Param("1", 0.5, 1.0, "weight of the sources in which a foot rests, for it to rest")
    ] = 1.0,
    seed: Annotated[int, Param("1", 0, 2**31 - 1, "of the draw")] = 0,
) -> Measures:
    """Skate, volume and acceleration of a graph's blended transitions and of fixed ones between the same poses.

    A row per drawn transition from pose i to pose j. `warped`: as synthesis.play_walk plays it, feet held and then
    volume kept, which leaves no error of volume by construction; `unheld`: the same without both; `fixed`: frames
    i .. i + n blended linearly with j - n .. j, n = fixed fps, weights even steps, one placement for the whole window.
    Of each: `skate`, the mean speed of resting soles (both sources rest on them) over the blended frames, m/s;
    `volume`, the greatest |V - V_mean| / V_mean, V_mean the sources' volumes in the blend's weights; `junction`, the
    99th percentile over vertices of the acceleration, greatest over the frames where captured and blended ones meet,
    over the capture's 99th percentile over frames. nan where no foot rests.

    Raises ValueError where the graph has no blended transition with room for a fixed one.
    Source: 002 figs 2-3 (Boukhayma and Boyer 2015, 3DV), which shows pictures only.
    """
    ready = graph_of(graph, similarity, meshes, _WHO)
    steps = max(2, round(fixed * float(ready.fps)))
    takes = [np.asarray(meshes[take].vertices) for take in ready.takes]
    drawn = _draw(ready, steps, count, seed)
    contacts = foot_contacts(takes, np.asarray(meshes[ready.takes[0]].faces), float(ready.fps))
    judge = _Judge(ready, takes, meshes, contacts, share)
    rows = []
    for e in drawn:
        before, after = _lead(ready, e)
        warped = judge.play(play_moves(ready.moves, [*before, e, *after]), "nonlinear")
        linear = judge.play(_fixed(ready, takes, e, steps, len(before), len(after)), "linear")
        rows.append([*judge.marks(judge.held(warped)), *judge.marks(warped)[:2], *judge.marks(linear)])
    names = [f"warped {what}" for what in ("skate", "volume", "junction")]
    names += ["unheld skate", "unheld volume"]
    names += [f"fixed {what}" for what in ("skate", "volume", "junction")]
    units = ["m/s", "1", "1", "m/s", "1", "m/s", "1", "1"]
    return Measures(np.array(rows), np.array(names), np.array(units))


def _draw(graph: Graph, steps: int, count: int, seed: int) -> list[int]:
    """Blended moves with room for a fixed transition on both sides."""
    begin = np.concatenate([[0], np.cumsum(graph.frames)])
    moves = graph.moves
    source, target = (np.searchsorted(begin, ends, "right") - 1 for ends in (moves.source, moves.target))
    room = (moves.source + steps < begin[source + 1]) & (moves.target - steps >= begin[target])
    fit = np.flatnonzero(room & (moves.weight[moves.first[1:] - 1] > 0.0))
    if not len(fit):
        raise ValueError(
            f"{_WHO}: no blended transition leaves {steps} frames on both sides: use longer takes"
        )
    return np.sort(np.random.default_rng(seed).permutation(fit)[:count]).tolist()


def _lead(graph: Graph, e: int) -> tuple[list[int], list[int]]:
    """Captured moves before and after a transition."""
    moves = graph.moves
    captured = moves.weight[moves.first[1:] - 1] == 0.0
    follows = {int(moves.source[k]): int(k) for k in np.flatnonzero(captured)}
    before = [follows[f] for f in range(int(moves.source[e]) - _LEAD, int(moves.source[e])) if f in follows]
    after = [follows[f] for f in range(int(moves.target[e]), int(moves.target[e]) + _LEAD) if f in follows]
    chain_before: list[int] = []
    for move in reversed(before):
        if moves.target[move] != (moves.source[chain_before[0]] if chain_before else moves.source[e]):
            break
        chain_before.insert(0, move)
    chain_after: list[int] = []
    for move in after:
        if moves.source[move] != (moves.target[chain_after[-1]] if chain_after else moves.target[e]):
            break
        chain_after.append(move)
    return chain_before, chain_after


def _fixed(
    graph: Graph, takes: list[np.ndarray], e: int, steps: int, before: int, after: int
) -> PlayedFrames:
    """The frames of the usual transition between the same poses."""
    begin = np.concatenate([[0], np.cumsum(graph.frames)])
    ends = int(graph.moves.source[e]), int(graph.moves.target[e])
    one, other = (int(np.searchsorted(begin, pose, "right")) - 1 for pose in ends)
    i, j = ends[0] - int(begin[one]), ends[1] - int(begin[other])
    k = np.arange(-before, steps + after + 1)
    time = np.column_stack(
        [np.clip(i + k, 0, i + steps), np.clip(j - steps + k, j - steps, len(takes[other]) - 1)]
    )
    weight = np.clip(k / steps, 0.0, 1.0)
    window = np.arange(steps + 1)
    sample = slice(None, None, max(1, takes[0].shape[1] // 300))
    place, _ = align(
        takes[one][i + window][:, sample].reshape(-1, 3),
        takes[other][j - steps + window][:, sample].reshape(-1, 3),
    )
    yaw = np.tile([0.0, place.yaw], (len(k), 1))
    offset = np.stack([np.zeros((len(k), 2)), np.tile(place.offset, (len(k), 1))], axis=1)
    middle = np.zeros((len(k), 3))
    return PlayedFrames(
        np.tile([one, other], (len(k), 1)),
        time.astype(np.float64),
        np.column_stack([1 - weight, weight]),
        yaw,
        offset,
        middle,
    )


class _Judge:
    """Plays transitions and tells their faults."""

    def __init__(
        self,
        graph: Graph,
        takes: list[np.ndarray],
        meshes: Dataset[MeshSequence],
        contacts: FootContacts,
        share: float,
    ) -> None:
        self.graph, self.meshes, self.contacts, self.share = graph, meshes, contacts, share
        self.faces, self.fps = np.asarray(meshes[graph.takes[0]].faces), float(graph.fps)
        self.fields = leg_fields(takes[0][0], self.faces, contacts.foot) if contacts.foot.max() >= 0 else None
        self.volumes = [volume(take, self.faces) for take in takes]
        own = np.concatenate([frame_accelerations(take, self.fps) for take in takes])
        self.captured = float(np.nanquantile(own, 0.99))

    def play(self, frames: PlayedFrames, blend: str) -> _Played:
        walk = walk_product(self.graph, frames, [0], cost=0.0, bound=0.0, expanded=0)
        vertices = play_walk(walk, self.meshes, blend=blend).mesh.vertices  # type: ignore[arg-type]
        planted = path_contacts(
            frames.take, np.rint(frames.time).astype(int), frames.weight, self.contacts.planted, self.share
        )
        return _Played(vertices, frames, planted)

    def held(self, played: _Played) -> _Played:
        """With feet held, then the volume of the sources."""
        vertices = played.vertices
        if self.fields is not None:
            vertices = hold_feet(vertices, self.contacts.foot, played.planted, self.fields, self.fps)
        wanted = self.wanted_volume(played)
        full = [
            with_volume(mesh, self.faces, float(size)) for mesh, size in zip(vertices, wanted, strict=True)
        ]
        return played._replace(vertices=np.stack(full))

    def wanted_volume(self, played: _Played) -> np.ndarray:
        """The sources' volumes in the weights of each frame, (F,)."""
        take, time = played.frames.take, np.rint(played.frames.time).astype(int)
        own = [
            [self.volumes[t][f] for t, f in zip(take[:, side], time[:, side], strict=True)]
            for side in range(2)
        ]
        return np.asarray((played.frames.weight * np.array(own).T).sum(axis=1))

    def marks(self, played: _Played) -> tuple[float, float, float]:
        """Skate (m/s), volume error and junction acceleration."""
        blended = np.flatnonzero(played.frames.weight.min(axis=1) > 0.0)
        first, last = int(blended[0]), int(blended[-1])
        skates = []
        for k in range(played.planted.shape[1]):
            sole = played.vertices[:, self.contacts.foot == k].astype(np.float64).mean(axis=1)
            speed = np.linalg.norm(np.diff(sole, axis=0), axis=1) * self.fps
            rests = played.planted[1:, k] & played.planted[:-1, k]
            rests[: first - 1], rests[last + 1 :] = False, False
            skates.append(speed[rests])
        speeds = np.concatenate(skates) if skates else np.zeros(0)
        expected = self.wanted_volume(played)
        off = np.abs(volume(played.vertices, self.faces) - expected) / expected
        peaks = frame_accelerations(played.vertices, self.fps)
        near = peaks[[k for k in (first - 1, first, last, last + 1) if 0 < k < len(peaks) - 1]]
        return (
            float(speeds.mean()) if len(speeds) else np.nan,
            float(off[blended].max()),
            float(near.max() / self.captured),
        )
