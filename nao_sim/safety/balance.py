"""Balance: in which poses a free robot stands, and how fast it may move there, told from joint angles alone.

On a flat floor a robot stands on its left sole, on its right sole or on both.
It stands where its centre of mass is over what it stands on; where the other
sole is off the floor, or flat on it where it was put down; where nothing else
touches the floor; and where its motors can carry it.

A robot that moves does not fall as long as its extrapolated centre of mass,
where the centre of mass goes within the pendulum's time, is over what it
stands on: even if an edge of a sole lifts for a moment, it comes back (Hof,
Gazendam and Sinke 2005; the same point is Pratt's capture point, 2006).

The margins are measured in the simulator, where joints sag and lag.  Put down
gently on one leg, with the centre of mass 10 mm inside the sole and less than
0.8 of every motor's torque, none of 140 random poses fell; at 0.8 to 1 of it
3 of 17 did.  In motion, falls came from soles that slid on the floor, from
motors without a reserve for moving what they carry, and from a leg swung
against the torso.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import mujoco
import numpy as np

from nao_sim.robot import Array, Robot, gains
from nao_sim.safety.margins import Margin
from nao_sim.safety.posed import PosedRobot
from nao_sim.safety.support import Edge, Ground, Point, hull, inside, leftward

RULE = "balance"
MARGIN = 0.03  # m, of the centre of mass inside the support
LEANING_MARGIN = 0.03  # m, of the extrapolated centre of mass
FLATNESS = 0.002  # m; a sole's corner nearer to the floor than this stands on it
SLIP = 0.002  # m that a sole may be off its place while both carry
CREEP = 0.0004  # m a command that its place follows it
STRENGTH = (0.95, 0.95, 0.75, 0.65, 0.65, 0.65)  # of a leg's torques, hip first, for the robot's weight
FLOOR = 0.01  # m between the floor and all but the soles
SHIN_FLOOR = 0.002  # m; a shin comes as near as 5 mm in the vendor's Crouch
NEAR = 0.02  # m; shapes higher than this above the floor are not looked at
GRAVITY = 9.81  # m/s^2
ROUNDING = 1e-9  # m
SOLE_EDGES: tuple[Edge, ...] = ((0, 1), (1, 2), (2, 3), (3, 0))
OPPOSITE = ((0, 2), (1, 3))  # corners of the right and of the left sole that keep their places
PITCH = (2, 3, 4)  # rows of HipPitch, KneePitch and AnklePitch in a leg
FEET = ("l_ankle", "r_ankle", "LAnklePitch", "RAnklePitch")
SHINS = ("LTibia", "RTibia")

Constraint = tuple[float, Callable[[], Array]]  # m, and its derivative (26,) by the joint vector
Corners = list[list[float]]


@dataclass(frozen=True)
class Stance:
    """What a robot stands on.

    Attributes:
        side: the sole whose plane is the floor: 0 left, 1 right.
        both: whether the other sole stands on it, too.
    """

    side: int
    both: bool


STANCES = tuple(Stance(side, both) for both in (True, False) for side in (0, 1))


@dataclass(frozen=True, eq=False)
class Look:
    """A pose as `Balance.leaning` sees it.

    Attributes:
        stance: what it stands on.
        corners: (4 or 8, 2) m, of the soles that it stands on.
        centres: two (3,) m, the centre of mass seen from the left sole, and from the right one.
        places: two (bodies, 3) m, the centres of mass of all bodies, likewise.
    """

    stance: Stance
    corners: Sequence[Point]
    centres: tuple[list[float], list[float]]
    places: tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class Support:
    """The edges of what a robot stands on, in its torso's frame.

    Attributes:
        normals: (E, 3) inward.
        offsets: (E,) m; a point is `normals @ point - offsets` inside.
        height: m of the centre of mass above it.
    """

    normals: Array
    offsets: Array
    height: float

    def leaning(self, centres: Array, steps: Array) -> float:
        """`Balance.leaning` at least (m), through centres of mass (N, 3) that are `steps` (N - 1,) s apart."""
        time = (self.height / GRAVITY) ** 0.5
        points = centres[1:] + np.diff(centres, axis=0) * (time / steps)[:, None]
        return float((points @ self.normals.T - self.offsets).min()) - LEANING_MARGIN


class Balance:
    """The balance rule of one robot.

    It looks at the pose that was put last: `posed.put`, then `broken`,
    `margins`, `look`.  All that it remembers is what the last commanded pose
    stands on, where the soles were put down, and how far outside the rule it
    was, if the start was: from there every pose is allowed that is no worse.
    `moved` brings that up to date; nothing else changes it.

    Args:
        robot: whose motors carry.
        posed: the robot in the same version.
        start: (26,) the posture in which it stands.
        lifts: whether it may lift a foot and stand on the other one.
    """

    def __init__(self, robot: Robot, posed: PosedRobot, start: Array, lifts: bool = True) -> None:
        self._posed, model = posed, posed.model
        posed.put(posed.map.to_qpos(start))
        self._grounds = Ground(posed, 0), Ground(posed, 1)
        self._own = [[(x, y) for x, y, _ in ground.corners.tolist()] for ground in self._grounds]
        self._strength = [_strength(robot, ground, float(model.body_subtreemass[0])) for ground in self._grounds]
        self._borne = [_borne(ground, robot, float(model.body_subtreemass[0])) for ground in self._grounds]
        self._clear = np.array([_clear(model.body(body).name) for body in model.geom_bodyid])
        self._mass = model.body_mass / model.body_mass.sum()
        self._possible = STANCES if lifts else STANCES[:1]  # on both it does not matter from which one they are seen
        self._stances = self._possible
        self._least = 0.0
        self._update()
        self._placed = self._others()
        self.moved()

    def moved(self) -> None:
        """The pose as put has been commanded."""
        self._update()
        margins = {stance: self._margin(stance) for stance in self._reachable()}
        self._least = min(max(margins.values()), 0.0)
        self._stances = tuple(stance for stance, margin in margins.items() if margin >= self._least)
        way = np.subtract(self._others(), self._placed)
        if all(stance.both for stance in self._stances):
            way = np.clip(way, -CREEP, CREEP)  # otherwise one sole carries all, and the other may go
        self._placed = (self._placed + way).tolist()

    def broken(self) -> bool:
        """Whether the robot cannot stand in the pose as put, nor stand there as well as in the last command."""
        return self._standing() is None

    def margins(self, within: float = NEAR) -> list[Margin]:
        """What the pose as put comes near to or breaks, of the stance that it is nearest to.

        Args:
            within: m; what is farther inside than this is left out.
        """
        self._update()
        stance = max(self._reachable(), key=self._margin)
        near = ((value - self._least, gradient) for value, gradient in self._constraints(stance))
        return [Margin(RULE, value, gradient()) for value, gradient in near if value < within]

    def look(self) -> Look:
        """The pose as put."""
        stance = self._standing() or self._stances[0]
        other = self._grounds[stance.side].other_corners().tolist()
        corners = self._corners(stance, other) if stance.both else self._borne[stance.side]
        return Look(stance, corners, *self._seen())

    def recentred(self, look: Look) -> Look:
        """A look at the pose as put, whose legs are those of another look."""
        self._update()
        centres, places = self._seen()
        return replace(look, centres=centres, places=places)

    def _seen(self) -> tuple[tuple[list[float], list[float]], tuple[Array, Array]]:
        left, right = self._grounds
        bodies = self._posed.data.xipos
        return (left.centre().tolist(), right.centre().tolist()), (left.seen(bodies), right.seen(bodies))

    def leaning(self, before: Look, look: Look, dt: float) -> float:
        """How far (m) inside the support the extrapolated centre of mass is, less a margin.

        Args:
            before: where it was.
            look: where it is.
            dt: s between them.
        """
        point = self._extrapolated(before, look, dt)
        return min(inside(point, look.corners[i], look.corners[j]) for i, j in _edges(look)) - LEANING_MARGIN

    def leaning_margins(self, before: Look, look: Look, dt: float, within: float = NEAR) -> list[Margin]:
        """`leaning` over each edge of the support, by the pose as put, which is that of `look`."""
        self._update()
        ground, point = self._grounds[look.stance.side], self._extrapolated(before, look, dt)
        values = ((edge, inside(point, *(look.corners[i] for i in edge)) - LEANING_MARGIN) for edge in _edges(look))
        near = [(edge, value) for edge, value in values if value < within]
        moves = self._extrapolated_moves(before, look, dt) if near else np.zeros((2, 0))
        return [Margin(RULE, value, ground.edge_moves(point, moves, look.corners, edge)) for edge, value in near]

    def support(self, look: Look) -> Support | None:
        """What the robot stands on, as lines in the torso's frame, which hold while the legs stand still.

        None on one sole: there the motors' strength counts, too, and not only where the centre of mass is.
        """
        if not look.stance.both:
            return None
        turn, origin = self._grounds[look.stance.side].frame()
        left = np.array([leftward(np.array(look.corners[i]), np.array(look.corners[j])) for i, j in _edges(look)])
        starts = np.array([look.corners[i] for i, _ in _edges(look)])
        normals = left @ turn[:, :2].T
        return Support(normals, normals @ origin + (left * starts).sum(axis=1), look.centres[look.stance.side][2])

    def _extrapolated(self, before: Look, look: Look, dt: float) -> Point:
        """The extrapolated centre of mass, m in the frame of the sole that is stood on: x + v sqrt(z / g).

        On one sole v is the speed at which a pendulum of the robot's mass and
        height would have its angular momentum about the sole: a leg swung one
        way and the torso the other tip it, although the centre of mass stands.
        """
        side = look.stance.side
        (x, y, z), (x0, y0, _) = look.centres[side], before.centres[side]
        time = (z / GRAVITY) ** 0.5 / dt
        if look.stance.both:
            return x + (x - x0) * time, y + (y - y0) * time
        places = look.places[side]
        moved = self._mass @ (places[:, [2]] * (places - before.places[side]))
        moved -= self._mass @ ((places - look.centres[side]) * (places - before.places[side])[:, [2]])
        return float(x + moved[0] * time / z), float(y + moved[1] * time / z)

    def _extrapolated_moves(self, before: Look, look: Look, dt: float) -> Array:
        """How the extrapolated centre of mass moves (2, 26) m/rad with the pose that it is reached in."""
        side = look.stance.side
        now, then = np.array(look.centres[side]), np.array(before.centres[side])
        moves, time = self._grounds[side].centre_moves(), np.sqrt(now[2] / GRAVITY)
        if not look.stance.both:
            return np.asarray(moves[:2] + self._swing_moves(look) * time / (dt * now[2]))
        slower = np.outer(now[:2] - then[:2], moves[2]) / (dt * 2.0 * GRAVITY * time)
        return np.asarray(moves[:2] * (1.0 + time / dt) + slower)

    def _swing_moves(self, look: Look) -> Array:
        """Angular momentum (2, 26) m^2 about the sole, per kg and rad/s of each joint, from the pose as put."""
        ground, places = self._grounds[look.stance.side], look.places[look.stance.side]
        offsets = places - np.array(look.centres[look.stance.side])
        swing = np.zeros((2, 26))
        for body in self._mass.nonzero()[0].tolist():
            moves = ground.moves(body, self._posed.data.xipos[body])
            swing += self._mass[body] * (places[body, 2] * moves[:2] - np.outer(offsets[body, :2], moves[2]))
        return swing

    def _update(self) -> None:
        mujoco.mj_comPos(self._posed.model, self._posed.data)

    def _others(self) -> list[Corners]:
        return [ground.other_corners().tolist() for ground in self._grounds]

    def _reachable(self) -> tuple[Stance, ...]:
        """From one sole to the other it goes through both; those of the last command come first."""
        first = self._stances[0]
        near = [s for s in self._possible if s.both or first.both or s.side == first.side]
        return tuple(sorted(near, key=lambda stance: stance.side != first.side))

    def _standing(self) -> Stance | None:
        """The first stance in which the pose as put holds."""
        self._update()
        return next((stance for stance in self._reachable() if self._holds(stance)), None)

    def _holds(self, stance: Stance) -> bool:
        least = self._least - ROUNDING
        return all(value >= least for value, _ in self._constraints(stance))

    def _margin(self, stance: Stance) -> float:
        return min(value for value, _ in self._constraints(stance))

    def _constraints(self, stance: Stance) -> Iterator[Constraint]:
        """What must not be negative (m): the quickest and likeliest to break come first."""
        ground = self._grounds[stance.side]
        other = ground.other_corners().tolist()
        yield from self._flat(ground, other, stance.both)
        if stance.both:
            yield from self._kept(stance.side, other)
        yield from self._centred(ground, self._corners(stance, other))
        heights = ground.heights() - self._clear
        for shape in (heights < NEAR).nonzero()[0].tolist():
            yield float(heights[shape]), partial(ground.height_moves, shape)
        for side in (0, 1) if stance.both else (stance.side,):
            yield from self._carried(side, stance.both)

    def _flat(self, ground: Ground, other: Corners, both: bool) -> Iterator[Constraint]:
        """The other sole is not below the floor, and not above it where it stands there."""
        for corner, (_, _, height) in enumerate(other):
            yield height + FLATNESS, partial(_along, ground, corner, 2, 1.0)
            if both:
                yield FLATNESS - height, partial(_along, ground, corner, 2, -1.0)

    def _kept(self, side: int, other: Corners) -> Iterator[Constraint]:
        """Soles that both carry stay where they are: those that slide drag the robot down."""
        ground, placed = self._grounds[side], self._placed[side]
        for corner in OPPOSITE[side]:
            for axis in (0, 1):
                slid = other[corner][axis] - placed[corner][axis]
                yield SLIP + slid, partial(_along, ground, corner, axis, 1.0)
                yield SLIP - slid, partial(_along, ground, corner, axis, -1.0)

    def _centred(self, ground: Ground, corners: Sequence[Point]) -> Iterator[Constraint]:
        """The centre of mass is over what the robot stands on."""
        x, y, _ = ground.centre().tolist()
        for edge in SOLE_EDGES if corners is self._own[0] or corners is self._own[1] else hull(corners):
            value = inside((x, y), corners[edge[0]], corners[edge[1]]) - MARGIN
            yield value, partial(_centre_parts, ground, (x, y), corners, edge)

    def _carried(self, side: int, both: bool) -> Iterator[Constraint]:
        """A leg's motors carry their share; how two legs share what goes sideways, angles do not tell."""
        ground, strength = self._grounds[side], self._strength[side]
        share = ground.share() if both else 1.0
        for row, lever in enumerate(ground.levers().tolist()):
            if row in PITCH or not both:
                yield strength[row] - share * abs(lever), partial(_eased, ground, row, both)

    def _corners(self, stance: Stance, other: Corners) -> list[Point]:
        own = self._own[stance.side]
        return own + [(x, y) for x, y, _ in other] if stance.both else own


def _along(ground: Ground, corner: int, axis: int, sign: float) -> Array:
    return np.asarray(sign * ground.corner_moves(corner)[axis])


def _centre_parts(ground: Ground, centre: Point, corners: Sequence[Point], edge: Edge) -> Array:
    return ground.edge_moves(centre, ground.centre_moves()[:2], corners, edge)


def _eased(ground: Ground, row: int, both: bool) -> Array:
    """How what is left of a motor's strength changes (26,) m/rad."""
    lever = float(ground.levers()[row])
    eased = -np.sign(lever) * ground.lever_moves(row)
    return eased * ground.share() - abs(lever) * ground.share_moves() if both else eased


def _edges(look: Look) -> Sequence[Edge]:
    return hull(look.corners) if look.stance.both else SOLE_EDGES


def _strength(robot: Robot, ground: Ground, mass: float) -> list[float]:
    """Levers (6,) m at which the robot's weight takes a leg's motors to what they may bear."""
    torques = (gains(robot.version)[robot.joint_names[joint]]["force"] for joint in ground.joints)
    return [part * torque / (mass * GRAVITY) for part, torque in zip(STRENGTH, torques, strict=True)]


def _borne(ground: Ground, robot: Robot, mass: float) -> list[Point]:
    """The corners of a sole, as far from the ankle as its motor can stand on it alone."""
    ankle = float(ground.ankle()[0])
    far = gains(robot.version)[robot.joint_names[ground.joints[4]]]["force"] / (mass * GRAVITY)
    return [(min(max(x, ankle - far), ankle + far), y) for x, y, _ in ground.corners.tolist()]


def _clear(link: str) -> float:
    """How high (m) above the floor a link stays."""
    if link in FEET:
        return -np.inf  # its sole tells
    return SHIN_FLOOR if link in SHINS else FLOOR
