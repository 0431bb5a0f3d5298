"""The guard: whatever is asked, what it commands is safe to do.

Every command keeps a promise: a full stop from here meets no limit, no
coupling, no other part of the robot, and leaves it on its feet.  What is asked
passes unchanged where it keeps the promise.  Where it would not, the nearest
speeds that do are taken, so that limbs slide along what is in their way; and
where none are found, the robot goes on with the stop that was found safe one
step before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nao_sim.robot import LEGS, STANDING_ACCELERATION, STANDING_SPEED, Array, Mask, Robot
from nao_sim.safety.change import Change, Intervention, note
from nao_sim.safety.margins import Finding
from nao_sim.safety.nearest import nearest
from nao_sim.safety.position import command_bounds
from nao_sim.safety.promise import AIM, Promise
from nao_sim.safety.rules import ALL, Rules
from nao_sim.safety.self_collision import Links, clearance
from nao_sim.safety.speed import EDGE, Pace, speed_limits, tracking_speed
from nao_sim.safety.stream import STALE, Stream
from nao_sim.safety.wayfinder import Wayfinder

BARRING = ("coupling", "self_collision", "balance")  # rules that may leave no way nearer to what is asked
LONGEST_STEP = 0.04  # s; a command must not lead farther than the servo goes in two control steps
SLOWLY = 0.5  # of the usual top speed, toward a request that jumped
LATE = 1e-4  # rad behind its request, of a leg joint that the others wait for
ROUNDING = 1e-7  # m or rad, by which a way may break a rule that was found to keep it a step before
OUTWARD = 0.1  # m/s at which parts leave each other that were too near from the start
RECOVERY = 0.2  # of what is missing to the aim, in a step: all of it at once would tremble
TRIES = 4  # at speeds that keep the promise, each better informed than the last
GENTLY = 0.6  # of the motors' acceleration: joints that lag unalike leave the commanded pose, and pushes rock the soles
SHARES = (0.6, 0.3, 0.1)  # of the way from braking to the last try, if none of them keeps it


@dataclass(frozen=True, eq=False)
class _Question:
    """How fast to go in one step.

    Attributes:
        target: (26,) where to be.
        wanted: (26,) the speeds at which the motors would go there.
        low: (26,) least speeds in reach.
        high: (26,) greatest ones.
        dt: s.
    """

    target: Array
    wanted: Array
    low: Array
    high: Array
    dt: float


@dataclass(frozen=True, eq=False)
class _Met:
    """What was met in a step, as lines that bound its speeds: `rows @ speed >= least`.

    Attributes:
        rows: (M, 26).
        least: (M,).
        of: M rules, with the links for self-collision.
    """

    rows: Array
    least: Array
    of: tuple[tuple[str, Links], ...]

    def and_more(self, more: _Met) -> _Met:
        """What was met before, and this."""
        rows, least = np.concatenate([self.rows, more.rows]), np.concatenate([self.least, more.least])
        return _Met(rows, least, self.of + more.of)

    @property
    def involved(self) -> Mask:
        """(26,) who has to do with it."""
        return np.asarray((self.rows != 0.0).any(axis=0))


NOTHING = _Met(np.zeros((0, 26)), np.zeros(0), ())


class Guard:
    """Turns requests into safe commands, one step after the other.

    Args:
        robot: whose limits hold.
        start: (26,) the posture that the robot is in.
        standing: whether it stands free on its feet, which it must not leave;
            otherwise its torso is held.
        rules: which rules hold; position limits always do.
    """

    def __init__(self, robot: Robot, start: Array, *, standing: bool, rules: Rules = ALL) -> None:
        self._robot = robot
        self._bounds = command_bounds(robot)
        self._pace = _pace(robot, rules, standing)
        self._promise = Promise(robot, start, standing, rules)
        self._stream = Stream(robot, start, rules.holds("stream"))
        self._shared_motor = np.array([robot.index["LHipYawPitch"], robot.index["RHipYawPitch"]])
        self._position, self._speed, self._target = start.copy(), np.zeros_like(start), start.copy()
        self._too_near = self._promise.distances(start)
        self._barred: list[Change] = []
        self._wayfinder = Wayfinder(robot, self._promise, self._bounds, self._pace)

    def step(self, requested: Array, dt: float) -> tuple[Array, Intervention]:
        """The command `dt` seconds after the previous one.

        Args:
            requested: (26,) what is asked for; what is not finite asks nothing new.
            dt: s, greater than 0.

        Returns:
            The command (26,) and what it changed, for which reasons.

        Raises:
            ValueError: not 26 values, or no time.
        """
        if np.shape(requested) != self._position.shape or not 0.0 < dt < np.inf:
            raise ValueError(
                f"request {np.shape(requested)}, dt {dt:g} s; expected {self._position.shape} and more than 0 s"
            )
        if dt > STALE:  # nobody asked for so long that the robot stands where it was last commanded
            self._speed = np.zeros_like(self._speed)
            self._promise.moved(self._position, dt)
        changes: list[Change] = []
        target, slow = self._possible(requested, dt, changes)
        dt = min(dt, LONGEST_STEP)
        target = self._way_round(target, dt, changes)
        speed = (target - self._position) / dt
        if not self._passes(speed, slow, dt):
            question = self._question(target, slow, dt)
            speed, met = self._search(question)
            self._note_motion(changes, question, speed, slow, met)
        if not self._wayfinder.rests:
            self._barred = [change for change in changes if change.reason in BARRING]
        self._move(target, speed, dt)
        return self._position.copy(), tuple(changes)

    def _possible(self, requested: Array, dt: float, changes: list[Change]) -> tuple[Array, Mask]:
        """The nearest pose that the joints' own rules allow, and who must approach it slowly."""
        robot, (left, right) = self._robot, self._shared_motor
        request, forgone, slow = self._stream.step(requested, dt, self._position, lambda: self._stop(dt))
        note(changes, "stale", forgone)
        target = request
        if slow[left] != slow[right]:
            slow = slow.copy()
            slow[self._shared_motor] = True
        if request[left] != request[right]:
            target = request.copy()
            target[self._shared_motor] = (request[left] + request[right]) / 2.0  # the smallest change of both
            note(changes, "one_motor", target - request)
        inside = np.minimum(np.maximum(target, self._bounds[0]), self._bounds[1])
        coupled = self._promise.coupled(inside)
        if (coupled != target).any():
            documented = np.clip(target, robot.lower, robot.upper)
            note(changes, "limit", documented - target)
            note(changes, "margin", inside - documented)
            note(changes, "coupling", coupled - inside)
        return coupled, slow

    def _way_round(self, target: Array, dt: float, changes: list[Change]) -> Array:
        """Where to go instead of the target, if something on the straight way bars it."""
        led = self._wayfinder.step(target, self._position, dt)
        if led is None:
            return target
        if not self._wayfinder.rests:
            note(changes, "detour", led - target)
        for change in self._barred if self._wayfinder.rests else ():
            note(changes, change.reason, np.where(change.size > 0.0, led - target, 0.0), change.links)
        return led

    def _stop(self, dt: float) -> Array:
        """Where (26,) a full stop would end."""
        return self._pace.stop(self._position, self._pace.braking(self._speed, dt), dt)[-1]

    def _passes(self, asked: Array, slow: Mask, dt: float) -> bool:
        """Whether what is asked can be done as it is."""
        if self._too_near or not self._slowed(slow).in_reach(asked, self._position, self._speed, self._bounds, dt):
            return False
        stops = np.abs(asked - self._pace.braking(self._speed, dt)).max() * dt < ROUNDING  # which nothing forbids
        return bool(stops) or self._kept(asked, dt, ROUNDING)

    def _slowed(self, slow: Mask) -> Pace:
        if not slow.any():
            return self._pace
        return replace(self._pace, top=np.where(slow, SLOWLY, 1.0) * self._pace.top)

    def _question(self, target: Array, slow: Mask, dt: float) -> _Question:
        pace = self._slowed(slow)
        low, high = pace.range(self._position, self._speed, self._bounds, dt)
        wanted = tracking_speed(target, self._target, self._position, pace, dt)
        return _Question(target, np.clip(self._in_step(wanted, target, dt), low, high), low, high, dt)

    def _in_step(self, speed: Array, target: Array, dt: float) -> Array:
        """Speeds (26,) at which joints that brake together go the same share of their ways: that of the slowest."""
        if self._pace.together is None:
            return speed
        way = np.where(self._pace.together, target - self._position, 0.0)
        late = np.abs(way - speed * dt) > LATE
        if not (late & self._pace.together).any():
            return speed
        share = np.clip(speed * dt / np.where(way == 0.0, np.inf, way), 0.0, 1.0)[late & self._pace.together].min()
        return np.where(self._pace.together, share * way / dt, speed)

    def _search(self, question: _Question) -> tuple[Array, _Met]:
        """Speeds that keep the promise; where none are found for all joints, legs stop and the others go on."""
        speed, met, kept = self._tried(question)
        if not kept and self._pace.together is not None:
            speed, more, kept = self._tried(self._legs_stopping(question, self._pace.together))
            met = met.and_more(more)
        return speed if kept else self._slower(question, speed, met), met

    def _legs_stopping(self, question: _Question, legs: Mask) -> _Question:
        braking = self._pace.braking(self._speed, question.dt)
        wanted, low, high = (np.where(legs, braking, x) for x in (question.wanted, question.low, question.high))
        return replace(question, wanted=wanted, low=low, high=high)

    def _tried(self, question: _Question) -> tuple[Array, _Met, bool]:
        """Look where the wanted speeds lead, take the nearest that avoid what is there, and look again."""
        speed = question.wanted
        met = NOTHING
        for _ in range(TRIES):
            reach, line = self._pace.reach(speed, question.dt), self._line(speed, question.dt)
            reach = np.concatenate([np.zeros_like(reach[:1]), reach])
            found = self._promise.findings(line, reach, question.dt, AIM, self._too_near)
            broken = any(finding.margin.value < 0.0 for finding in found)
            if not broken and not self._too_near and self._inside(line):
                return speed, met, True
            if not found:
                break
            met = met.and_more(self._met(found, speed, question.dt))
            speed = self._avoiding(question, met)
            if self._kept(speed, question.dt, 0.0):
                return speed, met, True
        return speed, met, False

    def _met(self, found: list[Finding], speed: Array, dt: float) -> _Met:
        """Findings at some speeds as lines that bound them."""
        rows, legs = np.array([finding.row for finding in found]), self._pace.together
        if legs is not None:  # arms give way to legs that the robot stands on
            between_parts = np.array([bool(finding.margin.links) for finding in found])
            rows[np.ix_(between_parts & rows[:, ~legs].any(axis=1), legs)] = 0.0
        rows[:, self._shared_motor] = rows[:, self._shared_motor].mean(axis=1, keepdims=True)
        standing = np.array([finding.margin.value for finding in found]) - rows @ speed  # margins of who stands still
        inside = np.maximum(standing, 0.0)
        least = np.where(standing > AIM, AIM, inside + RECOVERY * (AIM - inside)) - standing
        for i, finding in enumerate(found) if self._too_near else ():
            if (too_near := self._too_near.get(finding.margin.links)) is not None:
                least[i] = min(clearance(finding.margin.links) + AIM - too_near, OUTWARD * dt) - standing[i]
        return _Met(rows, least, tuple((finding.margin.rule, finding.margin.links) for finding in found))

    def _avoiding(self, question: _Question, met: _Met) -> Array:
        """The speeds nearest to the wanted ones that keep clear of what was met, as far as its slopes tell."""
        involved = met.involved
        if not involved.any():
            return question.wanted
        gap = np.abs(question.target - self._position)
        # weighed so that who stands still stands at the pose nearest to the target
        weight = np.clip(gap / np.maximum(np.abs(question.wanted), 1e-9), question.dt, 10.0)
        speed = question.wanted.copy()
        limits = question.low[involved], question.high[involved]
        speed[involved] = nearest(question.wanted[involved], weight[involved], limits, met.rows[:, involved], met.least)
        speed[self._shared_motor] = speed[
            self._shared_motor
        ].mean()  # to the last bit: what is rounded apart would grow
        return speed

    def _slower(self, question: _Question, speed: Array, met: _Met) -> Array:
        """Between a full stop, which keeps the promise, and speeds that do not."""
        braking = self._pace.braking(self._speed, question.dt)
        involved = met.involved
        if self._pace.together is not None and (not met.of or involved[self._pace.together].any()):
            involved = involved | self._pace.together
        for joints in (involved, np.ones_like(involved)):
            for share in (*SHARES, 0.0):
                slower = np.where(joints, braking + share * (speed - braking), speed)
                if self._kept(slower, question.dt, 0.0):
                    return slower
        return braking

    def _kept(self, speed: Array, dt: float, rounding: float) -> bool:
        line = self._line(speed, dt)
        return self._inside(line) and self._promise.kept(line, dt, rounding, self._too_near)

    def _inside(self, line: Array) -> bool:
        """Whether joints that brake in step, and so perhaps longer than each alone, stop inside their bounds."""
        legs = self._pace.together
        if legs is None:
            return True
        low, high = self._bounds[0][legs] - EDGE, self._bounds[1][legs] + EDGE
        return bool(((line[-1, legs] >= low) & (line[-1, legs] <= high)).all())

    def _line(self, speed: Array, dt: float) -> Array:
        """Where (N, 26) the robot is, and would be in one step at `speed` and the full stop after it."""
        return np.concatenate([self._position[None], self._pace.stop(self._position, speed, dt)])

    def _move(self, target: Array, speed: Array, dt: float) -> None:
        self._position = np.clip(self._position + speed * dt, *self._bounds)
        self._speed, self._target = speed, target
        self._promise.moved(self._position, dt)
        if self._too_near:
            self._too_near = self._promise.distances(self._position)

    def _note_motion(self, changes: list[Change], question: _Question, speed: Array, slow: Mask, met: _Met) -> None:
        behind = question.target - self._position - speed * question.dt
        kept = np.abs(speed - question.wanted) * question.dt < ROUNDING
        blamed = np.zeros(len(speed), bool)
        for rule, links in sorted(set(met.of)):
            its = [i for i, of in enumerate(met.of) if of == (rule, links)]
            culprits = (met.rows[its] != 0.0).any(axis=0) & ~kept
            note(changes, rule, np.where(culprits, behind, 0.0), links)
            blamed |= culprits
        note(changes, "ramp", np.where(slow & ~blamed, behind, 0.0))
        note(changes, "speed", np.where(slow | blamed, 0.0, behind))


def _pace(robot: Robot, rules: Rules, standing: bool) -> Pace:
    """How fast the joints may be; legs that stand brake in step."""
    legs = robot.joints_of(*LEGS)
    together = legs if standing else None
    if not rules.holds("speed"):
        return Pace(np.full(len(legs), np.inf), np.full(len(legs), np.inf), together)
    top, acceleration = speed_limits(robot, rules.speed_fraction), GENTLY * robot.max_acceleration
    if standing:
        top = np.where(legs, np.minimum(top, STANDING_SPEED), top)
        acceleration = np.where(legs, np.minimum(acceleration, STANDING_ACCELERATION), acceleration)
    return Pace(top, acceleration, together)
