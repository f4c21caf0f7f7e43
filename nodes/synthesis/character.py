"""A character under control: state, and a step in time."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from reperform.nodes.kernels.control_cells import blend_weights
from reperform.nodes.kernels.foot_lock import lock_feet, new_lock
from reperform.nodes.kernels.parameter_map import controls_at
from reperform.nodes.kernels.play_space import (
    advance,
    place_into,
    planted_share,
    pose_into,
    seconds_between,
    soles_of,
)  # fmt: skip
from reperform.nodes.kernels.transition_search import best_transition, new_found
from reperform.nodes.synthesis.cell_corrections import add_corrections
from reperform.nodes.synthesis.character_data import CharacterData

# Share of a motion that is not cyclic within which it is entered, and from which it is left once it is served.
_ENTER, _LEAVE = 0.12, 0.7
# Seconds in which controls follow what is asked, and in which a search that found nothing is tried again.
_FOLLOW, _RETRY = 0.25, 0.08
# Sources of one frame that are told of.
SOURCES = 8


class Command(NamedTuple):
    """What is asked: a space and values of its parameters. A new number is a new request.

    hold: seconds that a motion rests where it reaches, unless something else is asked; less in a later command of the
    same number ends it.
    """

    space: int
    values: np.ndarray
    number: int = 0
    hold: float = 0.0


class Layer(NamedTuple):
    """A motion being played: buffers that are written in place."""

    # space, and pose (in poses), as arrays of one
    space: np.ndarray
    pose: np.ndarray
    control: np.ndarray
    rate: np.ndarray
    weights: np.ndarray
    step: np.ndarray


class Character:
    """One performer: `step(dt, command)` plays on; what it then shows is in its fields.

    vertices (V, 3) float32 in the world, root (3,) x, z (m), yaw (rad), planted (feet,) feet that
    are held, resting (feet,) those that what is blended rests on, soles (feet, 3), m;
    source: takes (SOURCES,), captured frames and weights of what is blended.

    A command for the space that plays moves its controls; for another, a transition is searched from the state of now
    (004 eq 4.2), waited for, and blended over `blend` s with weights flat at both ends. A motion that is not cyclic is
    performed once per request; then the last cyclic motion goes on. Root motion is the blend of the roots' velocities,
    and planted feet are held where they touch the ground.

    Where `corrected`, spaces that have corrections are blended with them; they fade in and out in `blend` s.
    space, values: what it begins with; place: x, z (m) and heading (rad, 0 along +z, left positive) where it begins.

    Source: 004 chapter 4. Departure: blended transitions, held feet, and motions entered within their first part
    instead of at one frame.
    """

    def __init__(
        self, data: CharacterData, space: int | None = None, place: tuple[float, float, float] = (0.0, 0.0, 0.0),
        values: np.ndarray | None = None,
        blend: float = 0.3, ease: float = 0.2,
    ) -> None:  # fmt: skip
        self.data, self.blend, self.ease = data, blend, ease
        self.vertices = np.zeros((data.vertices, 3), np.float32)
        self.root = np.array(place, np.float64)
        feet = len(data.feet.fields)
        self.planted, self.resting = np.zeros(feet, np.bool_), np.zeros(feet, np.bool_)
        self.soles = np.zeros((feet, 3))
        self.time, self.asked, self.latency, self.cost = 0.0, 0.0, math.nan, math.nan
        self.mix, self.blending, self.stuck = 1.0, False, 0.0
        self.corrected, self._correction = True, 1.0
        self._flat = np.zeros(3 * data.vertices, np.float32)
        self._share, self._natural, self._slid = np.zeros(feet), np.zeros((feet, 3)), np.zeros((feet, 2))
        self._touch = np.zeros((len(data.feet.vertex), 3))
        self._lock, self._move = new_lock(feet), np.zeros(3)
        self._layers = [self._layer(s) for s in range(len(data.spaces))]
        self._old_layers = [self._layer(s) for s in range(len(data.spaces))]
        self._scratch = [np.empty(cells.corners.shape[1]) for cells in data.cells]
        self._halved = [np.empty_like(scratch) for scratch in self._scratch]
        self._wanted = [np.zeros(len(names)) for names in data.parameters]
        depth, step, *_ = data.search
        self._found = [new_found(edge, depth, step) for edge in data.edges]
        start = data.rest if space is None else space
        self.now = self._layers[start]
        self.old = self._old_layers[start]
        self._rest = Command(data.rest, data.values(data.rest, {}), -1)
        self._goal = Command(start, data.values(start, {}) if values is None else values, -2)
        self.served, self._seen = -2, -2
        self._plan, self._edge, self._retry = -1.0, -1, 0.0
        self._hold = 0.0
        self._set_control(start, self._goal.values)
        self.root[2] += self._sway(self.now)
        self._place(1e-3)

    def _layer(self, s: int) -> Layer:
        d, n = len(self.data.parameters[s]), len(self.data.spaces[s].inputs)
        layer = Layer(np.array([s]), np.zeros(1), np.zeros(d), np.zeros(d), np.zeros(n), np.zeros(3))
        layer.weights[0] = 1.0
        return layer

    @property
    def space(self) -> int:
        """The space that plays; during a transition the one it goes to."""
        return int(self.now.space[0])

    @property
    def pose(self) -> float:
        """Where in the space the motion is, in poses."""
        return float(self.now.pose[0])

    @property
    def control(self) -> np.ndarray:
        """The controls (d,) of the space that plays."""
        return self.now.control

    @property
    def heading(self) -> float:
        """Where the motion goes, rad; the body sways about it."""
        sway = self._sway(self.now)
        if self.blending:
            share = _ease(self.mix)
            sway = share * sway + (1.0 - share) * self._sway(self.old)
        return float(self.root[2]) - sway

    def _sway(self, layer: Layer) -> float:
        sway, pose = self.data.sway[layer.space[0]], float(layer.pose[0])
        before = min(int(pose), sway.shape[1] - 2)
        part, out = pose - before, 0.0
        for i, weight in enumerate(layer.weights):
            out += weight * ((1.0 - part) * sway[i, before] + part * sway[i, before + 1])
        return float(out)

    @property
    def waiting(self) -> bool:
        """Whether a transition has been asked for and not begun."""
        return self._seen != self.served and self.space != self._goal.space

    @property
    def over(self) -> bool:
        """Whether a motion that is not cyclic has come to its end."""
        space = self.data.spaces[self.space]
        return not space.cyclic and self.pose >= space.poses - 1

    def step(self, dt: float, command: Command) -> np.ndarray:
        """Play `dt` s on towards a command; the mesh then (V, 3), which the next step overwrites."""
        self.time += dt
        self._hear(command)
        if not self.blending:
            self._seek(dt)
        self._play(dt)
        self._place(dt)
        self.stuck = self.stuck + dt if self.over and not self.blending else 0.0
        return self.vertices

    def perform(self, dt: float) -> np.ndarray:
        """Play `dt` s on as it is, under no command."""
        self.time += dt
        self._play(dt)
        self._place(dt)
        return self.vertices

    def _hear(self, command: Command) -> None:
        """Note a new request; a served one that is over gives way to the last cyclic one."""
        if command.number != self._seen:
            self._seen, self.asked, self._plan = command.number, self.time, -1.0
            self._retry = self._hold = 0.0
        if self.data.spaces[command.space].cyclic:
            self._rest, self._goal = command, command
        elif self.served != command.number:
            self._goal = command
        else:
            # a hold that is taken back ends
            self._hold = min(self._hold, command.hold)
            late = self.pose >= _LEAVE * self.data.spaces[self.space].poses and self._hold <= 0.0
            done = late or self.space != command.space
            self._goal = self._rest if done else command

    def _seek(self, dt: float) -> None:
        """Steer the controls, and plan and begin transitions."""
        goal, now = self._goal, self.now
        again = not self.data.spaces[goal.space].cyclic and self.served != goal.number
        if goal.space == self.space and not again:
            self._serve()
            self._follow(goal.values, dt)
            return
        self._retry -= dt
        if self._plan < 0.0 and self._retry <= 0.0:
            self._search()
            self._retry = _RETRY
        if self._plan < 0.0:
            return
        found = self._found[self._edge]
        self._plan -= dt
        # controls arrive where the transition wants them when it begins
        share = min(1.0, dt / max(self._plan + dt, dt))
        now.control[:] += share * (found.source_control - now.control)
        self._weigh(now)
        if self._plan <= 0.0:
            self._begin()

    def _search(self) -> None:
        """Find when to leave for the goal, or for the next space on the way to it."""
        data, now, goal = self.data, self.now, self._goal
        edge = int(data.routes[self.space, goal.space])
        if goal.space == self.space:
            # once more: by an edge to itself, else by way of rest
            loop = np.flatnonzero((data.source == goal.space) & (data.target == goal.space))
            edge = int(loop[0] if len(loop) else data.routes[self.space, data.rest])
        if edge < 0:
            return
        tables, found = data.edges[edge], self._found[edge]
        depth, step, latency_weight, threshold = data.search
        to = int(data.target[edge])
        if to == goal.space:
            wanted = self._wanted[to]
            controls_at(goal.values, data.maps[to], wanted)
        else:
            wanted = self._wanted[to]
            wanted[:] = 0.5
        # a motion that is not cyclic is entered near its beginning
        enter = -1.0 if data.spaces[to].cyclic else round(_ENTER * data.spaces[to].poses)
        ok = best_transition(
            tables, now.pose[0], now.control, enter, wanted, depth, step, latency_weight, threshold, found
        )  # fmt: skip
        if ok:
            space = data.spaces[self.space]
            self._edge, self.cost = edge, float(found.cost[0])
            leave = float(found.source_pose[0])
            wait = seconds_between(space.seconds, space.cyclic, now.weights, now.pose[0], leave)
            # the pose of now is rounded by the search: it may lie just behind
            self._plan = 0.0 if wait > 0.5 * self._round() and leave < now.pose[0] else wait

    def _round(self) -> float:
        space = self.data.spaces[self.space]
        return float(self.now.weights @ space.seconds.sum(axis=1))

    def _begin(self) -> None:
        """Start blending into the target of the planned transition."""
        found, to = self._found[self._edge], int(self.data.target[self._edge])
        self.old, self._layers[self.space] = self.now, self._old_layers[self.space]
        self._old_layers[self.space] = self.old
        self.now = self._layers[to]
        self.now.pose[0] = found.target_pose[0]
        self.now.control[:] = found.target_control
        self.now.rate[:] = 0.0
        self._weigh(self.now)
        self.mix, self.blending, self._plan = 0.0, True, -1.0
        if to == self._goal.space:
            self._serve()

    def _serve(self) -> None:
        """Note that the last request has begun."""
        if self._goal.number == self._seen and self.served != self._seen:
            self.served, self.latency = self._seen, self.time - self.asked
            self._hold = self._goal.hold

    def _follow(self, values: np.ndarray, dt: float) -> None:
        """Draw the controls to what gives these values, critically damped."""
        now, s = self.now, self.space
        wanted = self._wanted[s]
        controls_at(values, self.data.maps[s], wanted)
        w = 2.0 / _FOLLOW
        fall = math.exp(-w * dt)
        for k in range(len(wanted)):
            gap = now.control[k] - wanted[k]
            b = now.rate[k] + w * gap
            now.control[k] = wanted[k] + (gap + b * dt) * fall
            now.rate[k] = (now.rate[k] - w * b * dt) * fall
        self._weigh(now)

    def _set_control(self, s: int, values: np.ndarray) -> None:
        layer = self._layers[s]
        controls_at(values, self.data.maps[s], layer.control)
        layer.rate[:] = 0.0
        self._weigh(layer)

    def _weigh(self, layer: Layer) -> None:
        s = int(layer.space[0])
        blend_weights(layer.control, self.data.cells[s], self._scratch[s], layer.weights)

    def _play(self, dt: float) -> None:
        """Advance what plays, and the root by the blend of its velocities."""
        self._advance(self.now, self._unheld(dt))
        self._move[:] = self.now.step
        if self.blending:
            self._advance(self.old, dt)
            # velocities are mixed as positions are, at the middle of the step
            middle = _ease(self.mix + 0.5 * dt / self.blend)
            self._move *= middle
            self._move += (1.0 - middle) * self.old.step
            before, self.mix = _ease(self.mix), self.mix + dt / self.blend
            # the heading stays where the two motions' bodies are turned from it differently
            self._move[2] += (_ease(self.mix) - before) * (self._sway(self.now) - self._sway(self.old))
            self.blending = self.mix < 1.0
        c, s = math.cos(self.root[2]), math.sin(self.root[2])
        self.root[0] += c * self._move[0] + s * self._move[1]
        self.root[1] += -s * self._move[0] + c * self._move[1]
        self.root[2] += self._move[2]

    def _unheld(self, dt: float) -> float:
        """How many of `dt` s the motion goes on: none while it rests where it reaches."""
        stop, layer, space = self.data.reach[self.space], self.now, self.data.spaces[self.space]
        if self._hold <= 0.0 or layer.pose[0] > stop + 1e-6:
            return dt
        go = min(
            dt,
            seconds_between(
                space.seconds, space.cyclic, layer.weights, layer.pose[0], max(stop, layer.pose[0])
            ),
        )
        self._hold -= dt - go
        return go + max(0.0, -self._hold)

    def _advance(self, layer: Layer, dt: float) -> None:
        space = self.data.spaces[layer.space[0]]
        layer.pose[0] = advance(
            space.motion, space.seconds, space.cyclic, layer.weights, layer.pose[0], dt, layer.step
        )

    def _place(self, dt: float) -> None:
        """Blend the mesh, hold the feet, and put it in the world."""
        fade = dt / self.blend if self.corrected else -dt / self.blend
        self._correction = min(max(self._correction + fade, 0.0), 1.0)
        share = _ease(self.mix) if self.blending else 1.0
        self._blend(self.now, share, False)
        if self.blending:
            self._blend(self.old, 1.0 - share, True)
        feet, (x, z, yaw) = self.data.feet, self.root
        soles_of(self._flat, x, z, yaw, feet.start, feet.vertex, self._touch, self._natural, self._slid)
        lock_feet(self._slid, self._share, self._lock, dt, self.ease, 0.3, self.root)
        np.add(self._natural, self._lock.shift, out=self.soles)
        self.planted[:] = self._lock.held
        np.greater_equal(self._share, 0.95, out=self.resting)
        place_into(self._flat, x, z, yaw, feet.fields, feet.first, feet.last, self._lock.shift, self.vertices)

    def _blend(self, layer: Layer, share: float, add: bool) -> None:
        space = self.data.spaces[layer.space[0]]
        pose_into(space.inputs, layer.weights, layer.pose[0], share, add, self._flat)
        planted_share(space.planted, layer.weights, layer.pose[0], share, add, self._share)
        s = layer.space[0]
        if self.data.corrections[s] and self._correction > 0.0:
            add_corrections(
                self.data.corrections[s], self.data.cells[s], layer.control, layer.pose[0],
                share * self._correction,
                self._scratch[s], self._halved[s], self._flat,
            )  # fmt: skip

    def sources(self, take: np.ndarray, frame: np.ndarray, weight: np.ndarray) -> None:
        """Write what the frame is blended of, strongest first: takes, captured frames, weights (SOURCES,) of sum 1."""
        share = _ease(self.mix) if self.blending else 1.0
        found = self._told(self.now, share)
        if self.blending:
            found += self._told(self.old, 1.0 - share)
        found = sorted(found, key=lambda row: -row[2])[: len(take)]
        take[:], frame[:], weight[:] = found[0][0], found[0][1], 0.0
        for k, row in enumerate(found):
            take[k], frame[k], weight[k] = row
        weight /= weight.sum()

    def _told(self, layer: Layer, share: float) -> list[tuple[int, float, float]]:
        s = int(layer.space[0])
        moments, space = self.data.source_frame[s], self.data.spaces[s]
        before = min(int(layer.pose[0]), moments.shape[1] - 1)
        after = min(before + 1, moments.shape[1] - 1)
        part = float(layer.pose[0]) - before
        return [
            (int(self.data.take_of[s][i]), float(moments[i, before] + part * (moments[i, after] - moments[i, before])),
             share * float(layer.weights[i]))
            for i in range(len(space.inputs))
            if layer.weights[i] > 1e-6
        ]  # fmt: skip


def _ease(u: float) -> float:
    """3 u^2 - 2 u^3 within 0 .. 1: flat at both ends."""
    u = min(max(u, 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)
