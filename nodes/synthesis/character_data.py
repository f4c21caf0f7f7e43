"""What all characters of one database share: spaces, parameter maps, transition tables, feet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.control_cells import Cells, framed
from reperform.nodes.kernels.foot_contacts import foot_contacts
from reperform.nodes.kernels.foot_hold import leg_fields
from reperform.nodes.kernels.ground_plane import rotate_ground
from reperform.nodes.kernels.hybrid_blend import HybridFields
from reperform.nodes.kernels.parameter_map import ParameterMap, controls_at
from reperform.nodes.kernels.parameter_values import values_at
from reperform.nodes.kernels.play_space import PlaySpace
from reperform.nodes.kernels.root_frame import travel
from reperform.nodes.kernels.transition_tables import EdgeTables
from reperform.nodes.motion_graph.edge_tables import edge_tables
from reperform.nodes.products.parametric import ParametricGraph, ParametricSpace
from reperform.nodes.products.space_corrections import SpaceCorrections
from reperform.nodes.synthesis.cell_corrections import Blending, cell_corrections

# what is done may miss what is asked by this share of the range before it counts as out of reach
_MISS = 0.02


class Feet(NamedTuple):
    """Soles as vertex lists (vertex[start[k] : start[k + 1]]), and how much each vertex follows each foot (K, V)."""

    start: np.ndarray
    vertex: np.ndarray
    fields: np.ndarray
    # vertices outside first .. last of a foot do not follow it
    first: np.ndarray
    last: np.ndarray


@dataclass(frozen=True)
class CharacterData:
    """Everything a character reads and never writes; shared by a crowd.

    takes: of all spaces, one after another; take_of[s][i] the index there of input i of space s.
    routes[s, t]: the edge to take in space s on the shortest way to space t; -1 where there is none.
    """

    names: tuple[str, ...]
    parameters: tuple[tuple[str, ...], ...]
    spaces: tuple[PlaySpace, ...]
    cells: tuple[Cells, ...]
    maps: tuple[ParameterMap, ...]
    refuse: tuple[bool, ...]
    edges: tuple[EdgeTables, ...]
    source: np.ndarray
    target: np.ndarray
    routes: np.ndarray
    search: tuple[int, float, float, float]
    feet: Feet
    faces: np.ndarray
    takes: tuple[str, ...]
    take_of: tuple[np.ndarray, ...]
    source_frame: tuple[np.ndarray, ...]
    # (N, P + cyclic) per space: how far the body is turned from the heading at each pose, rad
    sway: tuple[np.ndarray, ...]
    # per space what its blends do: controls (S, d) and values (S, d) of samples
    samples: tuple[tuple[np.ndarray, np.ndarray], ...]
    units: tuple[tuple[str, ...], ...]
    # the pose at which each space reaches; -1 where it does not
    reach: tuple[int, ...]
    # corrections of linear blending in every cell of a space; none where it is blended linearly
    corrections: tuple[tuple[HybridFields, ...], ...]

    @property
    def vertices(self) -> int:
        """Number of vertices V."""
        return self.spaces[0].inputs.shape[2] // 3

    @property
    def rest(self) -> int:
        """Where a motion that is over goes: the first space that repeats itself, else the first."""
        return next((s for s, space in enumerate(self.spaces) if space.cyclic), 0)

    def space(self, name: str) -> int:
        """The index of a space. Raises ValueError where there is none."""
        if name not in self.names:
            raise ValueError(f"there is no space {name!r}; there are {', '.join(self.names)}")
        return self.names.index(name)

    def values(self, space: int, given: Mapping[str, float]) -> np.ndarray:
        """Values of all parameters of a space (d,); those not given are in the middle of their range, or 0.

        Raises ValueError for a parameter that the space has not, and for a value out of reach where the space refuses.
        """
        names, table = self.parameters[space], self.maps[space]
        unknown = [name for name in given if name not in names]
        if unknown:
            raise ValueError(
                f"space {self.names[space]!r} has no parameter {unknown[0]!r}; it has {', '.join(names)}"
            )
        middle = np.where((table.lower < 0) & (table.upper > 0), 0.0, 0.5 * (table.lower + table.upper))
        values = np.array([given.get(name, float(rest)) for name, rest in zip(names, middle, strict=True)])
        if self.refuse[space]:
            self._require_reached(space, values)
        return values

    def _require_reached(self, space: int, values: np.ndarray) -> None:
        """Within the range of every parameter, and together what some blend does."""
        names, table, units = self.parameters[space], self.maps[space], self.units[space]
        cure = "ask for what is in reach, add takes, or give the space outside: clamp"
        for name, value, low, high, unit in zip(names, values, table.lower, table.upper, units, strict=True):
            if not low <= value <= high:
                raise ValueError(
                    f"space {self.names[space]!r}: {name} must be {low:.3f} .. {high:.3f} {unit}, got {value:.3f}: {cure}"
                )
        control = np.zeros(len(names))
        controls_at(values, table, control)
        nearest = values_at(control[None], *self.samples[space])[0]
        if (np.abs(nearest - values) > _MISS * (table.upper - table.lower)).any():
            asked, near = (
                ", ".join(f"{name} {v:.3f} {unit}" for name, v, unit in zip(names, row, units, strict=True))
                for row in (values, nearest)
            )
            raise ValueError(
                f"space {self.names[space]!r}: no blend does {asked} together; the nearest does {near}: {cure}"
            )


def character_data(
    graph: ParametricGraph,
    spaces: Mapping[str, ParametricSpace],
    corrections: Mapping[str, SpaceCorrections] | None = None,
    blending: Blending = "linear",
) -> CharacterData:
    """Gather what a graph and its spaces say.

    blending: hybrid corrects the linear blend in those spaces that `corrections` (of blend.correct_space) are for.
    Raises ValueError where a space of the graph is missing, or corrections are of no space of the graph or none.
    """
    names = tuple(str(name) for name in np.asarray(graph.spaces))
    missing = [name for name in names if name not in spaces]
    if missing:
        raise ValueError(
            f"the graph joins space {missing[0]!r}, which is not given; given are {', '.join(spaces)}"
        )
    graph = ParametricGraph(*map(np.asarray, graph))
    chosen = [ParametricSpace(*map(np.asarray, spaces[name])) for name in names]
    counts = np.cumsum([0, *(len(space.takes) for space in chosen)])
    source, target = np.asarray(graph.source), np.asarray(graph.target)
    faces = np.asarray(chosen[0].faces)
    return CharacterData(
        names=names,
        parameters=tuple(tuple(str(name) for name in np.asarray(space.parameters)) for space in chosen),
        spaces=tuple(_play(space) for space in chosen),
        cells=tuple(framed(np.asarray(space.control), np.asarray(space.cells)) for space in chosen),
        maps=tuple(_map(space) for space in chosen),
        refuse=tuple(bool(space.refuse) for space in chosen),
        edges=tuple(edge_tables(graph, edge) for edge in range(len(source))),
        source=source,
        target=target,
        routes=_routes(source, target, len(names)),
        search=(int(graph.depth), float(graph.step), float(graph.latency_weight), float(graph.threshold)),
        feet=find_feet(chosen, faces),
        faces=faces,
        takes=tuple(str(take) for space in chosen for take in np.asarray(space.takes)),
        take_of=tuple(np.arange(a, b) for a, b in pairwise(counts)),
        source_frame=tuple(np.asarray(space.source_frame, np.float64) for space in chosen),
        sway=tuple(_sway(space) for space in chosen),
        samples=tuple(
            (np.asarray(space.sample_weight) @ np.asarray(space.control), np.asarray(space.sample_value))
            for space in chosen
        ),
        units=tuple(tuple(str(unit) for unit in np.asarray(space.units)) for space in chosen),
        reach=tuple(int(space.reach[1]) for space in chosen),
        corrections=cell_corrections(chosen, corrections or {}, blending),
    )


def _play(space: ParametricSpace) -> PlaySpace:
    vertices, planted = np.asarray(space.vertices, np.float32), np.asarray(space.planted, np.float64)
    if bool(space.cyclic):
        vertices = np.concatenate([vertices, vertices[:, :1]], axis=1)
        planted = np.concatenate([planted, planted[:, :1]], axis=1)
    return PlaySpace(
        np.ascontiguousarray(vertices.reshape(*vertices.shape[:2], -1)),
        np.ascontiguousarray(space.motion, np.float64),
        np.ascontiguousarray(space.seconds, np.float64),
        np.ascontiguousarray(planted),
        bool(space.cyclic),
    )


def _sway(space: ParametricSpace) -> np.ndarray:
    """How far the body is turned from the heading at every pose (N, P + cyclic), rad; the heading turns evenly.

    Over a cycle the heading turns as much as the body, and goes along the chord in its middle. Nothing where a motion
    does not repeat itself.
    """
    motion, seconds = np.asarray(space.motion, np.float64), np.asarray(space.seconds, np.float64)
    if not bool(space.cyclic):
        return np.zeros(motion.shape[:2])
    track, yaw = travel(motion)
    turned, chord = yaw[:, -1:], np.arctan2(track[:, -1:, 0], track[:, -1:, 1])
    clock = np.concatenate([np.zeros((len(seconds), 1)), np.cumsum(seconds, axis=1)], axis=1)
    return np.asarray(yaw - (chord - 0.5 * turned + turned * clock / clock[:, -1:]))


def _map(space: ParametricSpace) -> ParameterMap:
    return ParameterMap(
        np.asarray(space.lower),
        np.asarray(space.upper),
        np.asarray(space.grid),
        np.ascontiguousarray(space.inverse),
    )


def find_feet(spaces: list[ParametricSpace], faces: np.ndarray) -> Feet:
    """The soles, told from all inputs, left and right as the spaces' contacts have them."""
    takes, labels, rates = [], [], []
    for space in spaces:
        vertices, motion = np.asarray(space.vertices), np.asarray(space.motion)
        for i in range(len(vertices)):
            takes.append(_in_place(vertices[i], motion[i]))
            labels.append(np.asarray(space.planted)[i])
            rates.append(float(np.median(np.asarray(space.seconds)[i, :-1])))
    found = foot_contacts(takes, faces, 1.0 / float(np.median(rates)))
    foot = found.foot
    if foot.max() < 0:
        empty = np.zeros(0, np.int64)
        return Feet(np.zeros(1, np.int64), empty, np.zeros((0, foot.size), np.float32), empty, empty)
    foot = np.where(foot < 2, foot, -1).astype(np.int8)
    fields = leg_fields(takes[0][0], faces, foot).astype(np.float32)
    vertex = [np.flatnonzero(foot == k) for k in range(len(fields))]
    used = [np.flatnonzero(row) for row in fields]
    return Feet(
        np.cumsum([0, *map(len, vertex)]),
        np.concatenate(vertex),
        fields,
        np.array([rows[0] for rows in used]),
        np.array([rows[-1] + 1 for rows in used]),
    )


def _in_place(vertices: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Poses (K, V, 3) laid on the ground along their travel."""
    track, yaw = travel(motion[:-1])
    out = vertices.astype(np.float32).copy()
    out[..., [0, 2]] = rotate_ground(vertices[..., [0, 2]], yaw[:, None]) + track[:, None]
    return out


def _routes(source: np.ndarray, target: np.ndarray, count: int) -> np.ndarray:
    """First edge of the way with the fewest transitions between any two spaces."""
    routes = np.full((count, count), -1)
    far = np.full((count, count), np.inf)
    np.fill_diagonal(far, 0)
    for _ in range(count):
        for edge, (a, b) in enumerate(zip(source, target, strict=True)):
            closer = far[b] + 1 < far[a]
            far[a][closer], routes[a][closer] = far[b][closer] + 1, edge
    return routes
