"""The guard: whatever is asked, what it commands is safe to do.

Every command keeps a promise: a stop at full deceleration from here meets no
limit, no coupling and no other part of the robot.  A step that would break the
promise is not taken; the offending limb brakes along the way that was found
safe one step before, and may leave again in any direction that is safe.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array, Coupling, Robot, facts
from nao_sim.safety.limits import always_allowed, command_bounds, coupled_bounds, coupling_conflict
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.safety.speed import braking_path, next_speed, speed_limits, stopping_speed

Mask = NDArray[np.bool_]
CLEARANCE = 0.008  # m kept between links at the command: sag and lag take the rest
LEGS = ("LLeg", "RLeg")
NOTICEABLE = 1e-6
LATE = 1e-4  # rad behind its request, of a leg joint that the others wait for
SAMPLING = 0.06  # rad; between two looks along a stop no joint moves farther


@dataclass(frozen=True, eq=False)
class Change:
    """One reason why the command is not what was asked.

    Attributes:
        reason: name of the rule.
        size: (26,) how far it moved each joint, rad (hands 0..1); 0 where it did not.
        links: the two links that would have met, for self-collision.
    """

    reason: str
    size: Array
    links: tuple[str, ...] = ()


Intervention = tuple[Change, ...]


@dataclass(frozen=True, eq=False)
class _Conflict:
    """A rule that a step would break, and whose stopping could mend it."""

    reason: str
    culprits: tuple[Mask, ...]
    links: tuple[str, ...] = ()


class Guard:
    """Turns requests into safe commands, one step after the other.

    Args:
        robot: whose limits hold.
        start: (26,) the posture that the robot is in.
        legs_free: whether leg requests are followed; otherwise the legs keep
            the start posture, so that a free-standing robot stays on its feet.
        legs_together: whether both legs move as one: what slows or stops one
            joint of them slows or stops all, so that feet on the floor stay
            flat on it.
    """

    def __init__(self, robot: Robot, start: Array, legs_free: bool = False, legs_together: bool = False) -> None:
        self._robot = robot
        self._legs = np.zeros(len(start), bool)
        self._legs[np.concatenate([robot.limbs[leg] for leg in LEGS])] = True
        self._legs_free, self._legs_together = legs_free, legs_together
        self._shared_motor = np.array([robot.index["LHipYawPitch"], robot.index["RHipYawPitch"]])
        self._start = start.copy()
        self._position, self._speed = start.copy(), np.zeros_like(start)
        self._request, self._target = start.copy(), start.copy()
        self._top, self._acceleration = speed_limits(robot), robot.max_acceleration
        self._bounds = command_bounds(robot)
        self._distance = SelfDistance(CLEARANCE)
        self._clearance = self._distance.nearest(start).distance
        self._limb_of_link = _limb_of_link(robot)

    def step(self, requested: Array, dt: float) -> tuple[Array, Intervention]:
        """The command `dt` seconds after the previous one.

        Args:
            requested: (26,) what is asked for; what is not finite asks nothing new.
            dt: s, greater than 0.

        Returns:
            The command (26,) and what it changed, for which reasons.
        """
        changes: list[Change] = []
        target = self._possible(requested, changes)
        wanted = self._wanted_speed(target, dt)
        speed, conflicts = self._promised_speed(wanted, dt)
        self._note_motion(changes, target, wanted, speed, conflicts, dt)
        self._position = self._position + speed * dt
        self._speed, self._target = speed, target
        return self._position.copy(), tuple(changes)

    def _possible(self, requested: Array, changes: list[Change]) -> Array:
        """The nearest pose that the joints' own rules allow."""
        robot = self._robot
        finite = np.isfinite(requested)
        self._request = request = np.where(finite, requested, self._request)
        if not self._legs_free:
            request = _stage(changes, "legs_hold", request, np.where(self._legs, self._start, request))
        left, right = self._shared_motor
        shared = request.copy()
        shared[self._shared_motor] = request[left] if finite[left] or not finite[right] else request[right]
        request = _stage(changes, "one_motor", request, shared)
        documented = _stage(changes, "limit", request, np.clip(request, robot.lower, robot.upper))
        inside = _stage(changes, "margin", documented, np.clip(documented, *self._bounds))
        return _stage(changes, "coupling", inside, self._coupled(inside))

    def _coupled(self, target: Array) -> Array:
        """Move each coupled joint out of the way of the joint that limits it."""
        target = target.copy()
        for coupling in self._robot.couplings:
            if always_allowed(coupling, target[coupling.joint]):
                continue
            bounds = coupled_bounds(coupling, self._position[coupling.by], target[coupling.by])
            target[coupling.joint] = np.clip(target[coupling.joint], *bounds)
        return target

    def _wanted_speed(self, target: Array, dt: float) -> Array:
        limits = self._top, self._acceleration
        speed = next_speed(target, self._target, self._position, self._speed, limits, dt)
        lower, upper = self._bounds
        down = stopping_speed(self._position - lower, self._acceleration, dt)
        up = stopping_speed(upper - self._position, self._acceleration, dt)
        return np.clip(self._in_step(speed, target, dt), -down, up)

    def _in_step(self, speed: Array, target: Array, dt: float) -> Array:
        """Speeds (26,) at which every leg joint goes the same share of its way: that of the slowest."""
        way = np.where(self._legs, target - self._position, 0.0)
        late = np.abs(way - speed * dt) > LATE if self._legs_together else np.zeros(len(way), bool)
        if not (late & self._legs).any():
            return speed
        share = np.clip(speed * dt / np.where(way == 0.0, np.inf, way), 0.0, 1.0)[late & self._legs].min()
        change = self._acceleration * dt
        together = np.clip(share * way / dt, self._speed - change, self._speed + change)
        return np.where(self._legs, together, speed)

    def _promised_speed(self, wanted: Array, dt: float) -> tuple[Array, list[tuple[_Conflict, Mask]]]:
        """The wanted speeds, or braking where they would break the promise."""
        braking = np.sign(self._speed) * np.maximum(np.abs(self._speed) - self._acceleration * dt, 0.0)
        held = np.zeros(len(wanted), bool)
        found: list[tuple[_Conflict, Mask]] = []
        while (conflict := self._conflict(np.where(held, braking, wanted), dt)) is not None:
            culprits = self._culprits(conflict, held, wanted, braking, dt)
            if not (culprits & ~held).any():
                culprits = np.ones_like(held)  # a stop of everything was found safe in the step before
            held |= culprits
            found.append((conflict, culprits))
            if held.all():
                break
        return np.where(held, braking, wanted), found

    def _culprits(self, conflict: _Conflict, held: Mask, wanted: Array, braking: Array, dt: float) -> Mask:
        """Whom to stop: the one whose stop alone mends it, otherwise (or if either would do) all involved."""
        sufficient = []
        for culprit in conflict.culprits:
            remaining = self._conflict(np.where(held | culprit, braking, wanted), dt)
            if remaining is None or remaining.links != conflict.links or remaining.reason != conflict.reason:
                sufficient.append(culprit)
        return sufficient[0] if len(sufficient) == 1 else np.logical_or.reduce(conflict.culprits)

    def _conflict(self, speed: Array, dt: float) -> _Conflict | None:
        """The first rule that a stop after one step at `speed` would break."""
        path = braking_path(self._position + speed * dt, speed, self._acceleration, dt)
        way = np.concatenate([self._position[None], path])
        for coupling in self._robot.couplings:
            if not speed[[coupling.by, coupling.joint]].any():
                continue  # it stands
            excess = coupling_conflict(coupling, way)
            if excess > NOTICEABLE and excess > coupling_conflict(coupling, way[[0, 0]]) + NOTICEABLE:
                return _Conflict("coupling", self._coupled_culprits(coupling))
        pair = self._distance.first_within(_looks(way), self._clearance)
        if pair is None:
            return None
        culprits = tuple(self._limb(link) for link in pair.links if link in self._limb_of_link)
        return _Conflict("self_collision", culprits, pair.links)

    def _coupled_culprits(self, coupling: Coupling) -> tuple[Mask, ...]:
        limiting, limited = np.zeros((2, len(self._position)), bool)
        limiting[coupling.by], limited[coupling.joint] = True, True
        return self._with_legs(limiting), self._with_legs(limiting | limited)

    def _limb(self, link: str) -> Mask:
        """The joints that stop with the limb of a link: its own, and the other hip on the motor of its first one."""
        mask = np.zeros(len(self._position), bool)
        mask[self._robot.limbs[self._limb_of_link[link]]] = True
        mask[self._shared_motor] |= mask[self._shared_motor].any()
        return self._with_legs(mask)

    def _with_legs(self, mask: Mask) -> Mask:
        """All leg joints besides, if any of them is meant and they move together."""
        return mask | self._legs if self._legs_together and mask[self._legs].any() else mask

    def _note_motion(
        self,
        changes: list[Change],
        target: Array,
        wanted: Array,
        speed: Array,
        conflicts: list[tuple[_Conflict, Mask]],
        dt: float,
    ) -> None:
        reached = self._position + speed * dt
        stopped = np.zeros(len(target), bool)
        for conflict, culprits in conflicts:
            size = np.where(culprits, np.abs(target - reached), 0.0)
            stopped |= culprits
            if (size > NOTICEABLE).any():
                changes.append(Change(conflict.reason, size, conflict.links))
        slow = np.where(stopped, 0.0, np.abs(target - self._position - wanted * dt))
        if (slow > NOTICEABLE).any():
            changes.append(Change("speed", slow))


def _stage(changes: list[Change], reason: str, before: Array, after: Array) -> Array:
    size = np.abs(after - before)
    if (size > NOTICEABLE).any():
        changes.append(Change(reason, np.where(size > NOTICEABLE, size, 0.0)))
    return after


def _looks(way: Array) -> Array:
    """Poses (M, 26) after the first along a way (N, 26), between which no joint moves farther than `SAMPLING`."""
    strides = np.abs(np.diff(way, axis=0)).max(axis=1)
    if strides.max() <= SAMPLING:
        return way[1:]
    pieces = np.maximum(np.ceil(strides / SAMPLING).astype(int), 1)
    starts = np.concatenate([np.linspace(0, 1, n, endpoint=False) + i for i, n in enumerate(pieces)])
    places = np.append(starts[1:], float(len(way) - 1))
    before = np.minimum(places.astype(int), len(way) - 2)
    share = (places - before)[:, None]
    return way[before] * (1.0 - share) + way[before + 1] * share


def _limb_of_link(robot: Robot) -> dict[str, str]:
    """The limb that moves each link; the torso belongs to none."""
    limb_of_joint = {joint: limb for limb, joints in robot.limbs.items() for joint in joints}
    return {joint["child"]: limb_of_joint[robot.index[joint["name"]]] for joint in facts()["joints"]}
