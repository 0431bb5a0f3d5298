"""Balance: in which poses a free robot stands on both soles, and how fast it may move there, told from joint angles.

It stands where both soles are flat on the floor and where they were put down;
where its centre of mass is over them; where nothing else touches the floor;
and where its motors can carry it.

A robot that moves does not fall as long as the point where its momentum takes
its centre of mass is over what it stands on: even if an edge of a sole lifts
for a moment, it comes back.  For a mass on a leg that is the extrapolated centre of
mass (Hof, Gazendam and Sinke 2005; Pratt's capture point, 2006).  Here it is
that of a mass with the robot's whole angular momentum about the floor below it:
arms that fly and then stop hand theirs on to the body.  And the floor must be
able to give that momentum and take it: who is thrown to and fro rocks on the
edges of his soles, until he falls.

The margins are measured in the simulator, where joints sag and lag.  Falls
came from soles that slid on the floor, from motors without a reserve for
moving what they carry, from arms and torso that were stopped, and from arms
that swung in time with the soles' rocking.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from nao_sim.robot import Array, Robot
from nao_sim.safety.bearing import GRAVITY, Bearing
from nao_sim.safety.floor import Floor
from nao_sim.safety.margins import Margin
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import Support

RULE = "balance"
MARGIN = 0.03  # m, of the centre of mass inside the support
LEANING_MARGIN = 0.03  # m, of where its momentum takes it
PUSH_MARGIN = 0.025  # m, of where the floor must push to change its momentum
PUSH = 0.005  # m, of that point from a centre of mass that is too far out, to bring it back
FLATNESS = 0.002  # m that a sole's end may be off the other one's plane
SLIP = 0.002  # m that a sole may be off its place
CREEP = 0.0002  # m a command that its place follows it
CLEAR = 0.01  # m between the floor and all but the soles
SHIN_CLEAR = 0.002  # m; a shin comes as near as 5 mm in the vendor's Crouch
NEAR = 0.02  # m; shapes higher than this above the floor are not looked at
ROUNDING = 1e-9  # m
PLACE = (0, 1, 5)  # of a sole's placement: x, y and heading
FEET = ("l_ankle", "r_ankle", "LAnklePitch", "RAnklePitch")
SHINS = ("LTibia", "RTibia")

Slopes = Callable[[NDArray[np.int_]], Array]  # the derivatives (N, 26) of N of several values


@dataclass(frozen=True, eq=False)
class Look:
    """A pose as `Balance.steady` sees it, from the floor.

    Attributes:
        centre: (3,) m, the centre of mass.
        places: (bodies, 3) m, the centres of mass of all bodies.
    """

    centre: Array
    places: Array


class Balance:
    """Looks at poses of a robot that stands on both soles.

    Args:
        robot: whose motors carry it.
        posed: the robot that it looks at, which has been put into the posture from which it starts;
            `update` must follow each `put`.
    """

    def __init__(self, robot: Robot, posed: PosedRobot) -> None:
        self._posed, model = posed, posed.model
        self._floor = Floor(posed)
        self._bearing = Bearing(robot, posed, self._floor)
        self._scale = np.array([1.0, 1.0, 1.0, *3 * (self._floor.half_length,)])
        self._tolerance = np.array([SLIP, SLIP, FLATNESS, FLATNESS, FLATNESS, SLIP])
        self._ends = np.where(model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE, model.geom_size[:, 1], 0.0)
        clear = np.array([_clear(model.body(body).name) for body in model.geom_bodyid])
        self._radii_and_clear = model.geom_size[:, 0] + clear
        self._mass = model.body_mass / model.body_mass.sum()
        self._bodies = np.flatnonzero(self._mass)
        self._placed, self._least = np.zeros(6), 0.0
        self.update()
        self._placed[[*PLACE]] = self._floor.placement()[[*PLACE]]
        self._support = Support.of(self._floor.corners()[:, :2])
        self.moved()

    def update(self) -> None:
        """Take the pose as put."""
        self._floor.update()

    def moved(self) -> None:
        """The pose as put has been commanded: soles stay where it leaves them."""
        self._least = min(self._worst(), 0.0)
        way = np.clip(self._off() / self._scale, -CREEP / self._scale, CREEP / self._scale)[[*PLACE]]
        if np.abs(way).max() > ROUNDING:
            self._placed[[*PLACE]] += way
            self._support = Support.of(self._floor.corners()[:, :2])

    def broken(self) -> bool:
        """Whether the robot cannot stand in the pose as put, nor stand there as well as in the last command."""
        return self._worst() < self._least - ROUNDING

    def margins(self, within: float = NEAR) -> list[Margin]:
        """What the pose as put comes near to or breaks.

        Args:
            within: m; what is farther inside than this is left out.
        """
        found = []
        for values, slopes in self._rules():
            near = np.flatnonzero(values - self._least < within)
            if len(near):
                inside = (values[near] - self._least).tolist()
                found += [Margin(RULE, value, slope) for value, slope in zip(inside, slopes(near), strict=True)]
        return found

    def look(self) -> Look:
        """The pose as put."""
        return Look(self._floor.centre, self._floor.seen(self._posed.data.xipos))

    def momentum(self, before: Look, look: Look, dt: float) -> Array:
        """Angular momentum (2,) m^2/s per kg about the floor below the centre of mass, of the way to a look.

        Args:
            before: where it was.
            look: where it is.
            dt: s between them.
        """
        moved = look.places - before.places
        momentum = (self._mass * look.places[:, 2]) @ moved[:, :2]
        momentum -= (self._mass * moved[:, 2]) @ (look.places[:, :2] - look.centre[:2])
        return np.asarray(momentum / dt)

    def inside(self, look: Look) -> float:
        """How far (m) inside the support the centre of mass of a look is."""
        return float(self._support.inside(look.centre[:2]).min())

    def steady(self, inside: float, look: Look, momentum: Array, change: Array) -> float:
        """How far (m) inside the support a motion's two points are, less their margins.

        One is where its momentum takes the centre of mass; the other one, the
        zero-moment point, is where the floor must push to change the momentum
        (Vukobratovic and Borovac 2004).

        Args:
            inside: m, of the centre of mass at the last command; who leans too far there may come back.
            look: where the robot is.
            momentum: (2,) m^2/s per kg, with which it came there.
            change: (2,) m^2/s^2 per kg, of the momentum.
        """
        return float(self._steadiness(inside, look, momentum, change).min())

    def steady_margins(
        self, now: Look, look: Look, dt: float, momentum_now: Array, within: float = NEAR
    ) -> list[Margin]:
        """`steady` over each edge of the support, by the pose as put, which is that of `look`, `dt` (s) after `now`."""
        momentum = self.momentum(now, look, dt)
        steadiness = self._steadiness(self.inside(now), look, momentum, (momentum - momentum_now) / dt)
        if steadiness.min() >= within:
            return []
        centre, turned = self._floor.centre_moves()[:2], self._momentum_moves(look) / dt
        moves = centre + turned / (GRAVITY * look.centre[2]) ** 0.5, centre - turned / (dt * GRAVITY)
        return [
            Margin(RULE, float(values[edge]), self._support.normals[edge] @ moving)
            for values, moving in zip(steadiness, moves, strict=True)
            for edge in np.flatnonzero(values < within)
        ]

    def _steadiness(self, inside: float, look: Look, momentum: Array, change: Array) -> Array:
        """Of both points, over each edge of the support (2, E) m."""
        x, y, z = look.centre.tolist()
        (ahead, aside), (gained_ahead, gained_aside) = momentum.tolist(), change.tolist()
        time = (GRAVITY * z) ** 0.5
        led = x + ahead / time, y + aside / time
        pushed = x - gained_ahead / GRAVITY, y - gained_aside / GRAVITY
        margins = np.array([[min(LEANING_MARGIN, inside)], [min(PUSH_MARGIN, inside - PUSH)]])
        return np.asarray(self._support.inside(np.array([led, pushed])) - margins)

    def _momentum_moves(self, look: Look) -> Array:
        """Momentum (2, 26) m^2 about the floor, per kg and rad/s of each joint, of the pose as put."""
        places, mass = look.places[self._bodies], self._mass[self._bodies]
        moves = self._floor.moves(self._bodies, self._posed.data.xipos[self._bodies])
        upright, aside = mass * places[:, 2], mass * (places[:, :2] - look.centre[:2]).T
        return np.asarray(np.tensordot(upright, moves[:, :2], 1) - aside @ moves[:, 2])

    def _worst(self) -> float:
        return min(float(values.min()) for values, _ in self._rules())

    def _rules(self) -> list[tuple[Array, Slopes]]:
        """What must not be negative (m), with its slopes."""
        off = self._off()
        return [
            (np.concatenate([self._tolerance - off, self._tolerance + off]), self._off_slopes),
            (self._support.inside(self._floor.centre[:2]) - MARGIN, self._centre_slopes),
            (self._heights(), self._height_slopes),
            (self._bearing.margins(), self._bearing.gradients),
        ]

    def _off(self) -> Array:
        """How far (6,) m the ends of the soles are off where they stand, along and about the floor's axes."""
        return np.asarray((self._floor.placement() - self._placed) * self._scale)

    def _off_slopes(self, rows: NDArray[np.int_]) -> Array:
        moves = self._scale[:, None] * self._floor.placement_moves()
        return np.concatenate([-moves, moves])[rows]

    def _centre_slopes(self, edges: NDArray[np.int_]) -> Array:
        return np.asarray(self._support.normals[edges] @ self._floor.centre_moves()[:2])

    def _heights(self) -> Array:
        """How much higher (shapes,) m than they must the lowest points of spheres and capsules are; NEAR at most."""
        data, up = self._posed.data, self._floor.turn[:, 2]
        height = data.geom_xpos @ up - np.abs(data.geom_xmat[:, 2::3] @ up) * self._ends
        return np.asarray(np.minimum(height - (self._radii_and_clear + self._floor.origin @ up), NEAR))

    def _height_slopes(self, shapes: NDArray[np.int_]) -> Array:
        axes, up = self._posed.data.geom_xmat[shapes, 2::3], self._floor.turn[:, 2]
        ends = self._posed.data.geom_xpos[shapes] - np.copysign(self._ends[shapes], axes @ up)[:, None] * axes
        return self._floor.moves(self._posed.model.geom_bodyid[shapes], ends)[:, 2]


def _clear(link: str) -> float:
    """How high (m) above the floor a link stays."""
    if link in FEET:
        return -np.inf  # its sole tells
    return SHIN_CLEAR if link in SHINS else CLEAR
