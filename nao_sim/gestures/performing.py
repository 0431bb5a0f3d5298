"""What the robot does for recognised gestures: their motions of the vocabulary, joined smoothly.

In a join the robot lets what it was doing come to a stop, and goes over to what
it shall do by a minimum-jerk share (T. Flash and N. Hogan, J. Neuroscience 5(7),
1985), so that it is always between two postures that it may take.  Anything can
be given up for the next gesture at any time, without waiting and without a
detour through the rest posture.

* A pose is gone to and held as long as it is announced, `SHOWN` seconds at least.
* A movement is played once for each announcement and then stays where it ended.
* Another gesture interrupts both at once; `none`, or a gesture for which there
  is no motion, only when they are done and it has lasted for `PATIENCE`: then the
  arms go to rest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import Decision
from nao_sim.gestures.vocabulary import Vocabulary
from nao_sim.motion import JointTrajectory
from nao_sim.robot import Array, Mask, Robot
from nao_sim.smooth_step import PEAK_ACCELERATION, PEAK_SPEED, minimum_jerk

STEP = 0.02  # s, the period of the robot's own motion controller
SHOWN = 0.5  # s for which a pose is held at least
PATIENCE = 0.8  # s without a gesture, after which the arms go to rest
SHORTEST_JOIN = 0.5  # s
BRAKE = 0.3  # s
SHARE = 0.45  # of the speed and acceleration that motors follow in every pose; the rest is the motion's own
ARMS = ("LArm", "RArm")


@dataclass(frozen=True, eq=False)
class Act:
    """One motion of the robot's, and how it is joined to what was before.

    Attributes:
        label: the gesture, `none` for the way to rest.
        motion: the robot's; a single frame is held.
        began: s, when it started.
        left: (26,) where the robot was then.
        speed: (26,) rad/s, how fast.
        joining: s, until it does nothing but this motion.
    """

    label: str
    motion: JointTrajectory
    began: float
    left: Array
    speed: Array
    joining: float

    @property
    def done(self) -> float:
        """When (s) it has been shown."""
        shown = self.motion.duration if len(self.motion) > 1 else self.joining + SHOWN
        return self.began + max(self.joining, shown)

    def at(self, time: float, rest: Array) -> Array:
        """Joint positions (26,) at a time (s); joints of which the motion says nothing are at `rest`."""
        after = time - self.began
        asked = _asked(self.motion, after, rest)
        if after >= self.joining:
            return asked
        share = minimum_jerk(after / self.joining)
        return np.asarray((1.0 - share) * self._stopping(after) + share * asked)

    def _stopping(self, after: float) -> Array:
        """(26,) where what was done before comes to a stop, `BRAKE` seconds after it was left."""
        u = min(after / BRAKE, 1.0)
        return np.asarray(self.left + self.speed * BRAKE * (u - u**3 + u**4 / 2.0))


class GesturePerformer:
    """Moves one robot; it has a state.

    Args:
        vocabulary: the motions.
        robot: whose speeds hold.
        rest: (26,) the posture between gestures, in which the robot is at first.
    """

    def __init__(self, vocabulary: Vocabulary, robot: Robot, rest: Array) -> None:
        self._robot, self._rest = robot, rest
        names = {*vocabulary.names, *vocabulary.motions}
        motions = {name: motion for name in names if (motion := vocabulary.motion_of(name)) is not None}
        held = set(vocabulary.pose_names)
        self._motions = {name: posture_of(each) if name in held else each for name, each in motions.items()}
        self._nothing = JointTrajectory(np.zeros(1), rest[None])
        self._now, self._speed = np.array(rest, float), np.zeros_like(rest)
        self._act = Act(NONE, self._nothing, -math.inf, self._now, self._speed, SHORTEST_JOIN)
        self._answered = self._heard = -math.inf  # since when what was announced is done, and was last announced

    @property
    def resting(self) -> bool:
        """Whether the robot is at rest, or on its way there."""
        return self._act.label == NONE

    def update(self, decision: Decision, time: float) -> Array:
        """Take what is recognised now; say where the joints (26,) shall be.

        Args:
            decision: the latest one.
            time: s, after that of the last call.
        """
        motion = self._motions.get(decision.label)
        if motion is not None:
            self._heard = time
            if decision.since != self._answered:
                if not (decision.label == self._act.label and time < self._act.done):
                    self._start(decision.label, motion, time)
                self._answered = decision.since
        elif not self.resting and time - self._heard >= PATIENCE and time >= self._act.done:
            self._start(NONE, self._nothing, time)
        positions = self._act.at(time, self._rest)
        self._speed = (positions - self._now) / STEP
        self._now = positions
        return positions

    def settled(self, time: float) -> bool:
        """Whether the robot has come to rest."""
        return self.resting and time >= self._act.began + self._act.joining

    def _start(self, label: str, motion: JointTrajectory, time: float) -> None:
        """Begin another act from the present position, which is that of a `STEP` ago, and velocity."""
        joining = _joining(motion, self._now, self._rest, self._robot)
        self._act = Act(label, motion, time - STEP, self._now, self._speed, joining)


def posture_of(motion: JointTrajectory) -> JointTrajectory:
    """The posture that a motion of a pose shows, as a single frame: where it is farthest from its start."""
    known = np.nan_to_num(motion.positions)
    farthest = int(np.linalg.norm(known - known[0], axis=1).argmax())
    return JointTrajectory(motion.times[:1], motion.positions[farthest : farthest + 1], motion.given)


def perform_gestures(
    vocabulary: Vocabulary, decisions: Sequence[Decision], robot: Robot, rest: Array
) -> JointTrajectory:
    """What the robot does for a recording's decisions, made as in a stream.

    Args:
        vocabulary: the motions.
        decisions: (T,) of the frames.
        robot: whose speeds hold.
        rest: (26,) the posture between gestures.

    Returns:
        Joint positions every `STEP` from the first decision on, until the last gesture is done and the robot at rest.
    """
    performer = GesturePerformer(vocabulary, robot, rest)
    starts, latest = [each.time for each in decisions], 0
    positions: list[Array] = []
    silence = Decision(starts[-1], NONE, 1.0, starts[-1])
    while True:
        time = starts[0] + STEP * len(positions)
        while latest + 1 < len(starts) and starts[latest + 1] <= time:
            latest += 1
        over = time > starts[-1]
        positions.append(performer.update(silence if over else decisions[latest], time))
        if over and performer.settled(time):
            break
    times = starts[0] + STEP * np.arange(float(len(positions)))
    return JointTrajectory(times, np.stack(positions), _given(vocabulary, robot))


def _given(vocabulary: Vocabulary, robot: Robot) -> Mask:
    """(26,) the joints of the arms, and those of which any motion says something."""
    return np.logical_or.reduce([robot.joints_of(*ARMS), *(motion.given for motion in vocabulary.motions.values())])


def _asked(motion: JointTrajectory, after: float, rest: Array) -> Array:
    """Joint positions (26,) so many seconds after a motion's start; it stays where it ends."""
    at = motion.times[0] + min(max(after, 0.0), motion.duration)
    positions = motion.sample(np.array([at]))[0]
    return np.where(np.isfinite(positions), positions, rest)


def _joining(motion: JointTrajectory, left: Array, rest: Array, robot: Robot) -> float:
    """Seconds in which no joint is too fast or jerky on its way to a motion, as far as that gets meanwhile."""
    lasts = SHORTEST_JOIN
    for _ in range(3):  # the longer it takes, the farther the motion gets
        asked = np.stack([_asked(motion, after, rest) for after in np.linspace(0.0, lasts, 11)])
        way = np.abs(asked - left).max(axis=0)
        fast = PEAK_SPEED * way / (SHARE * robot.max_speed)
        jerky = np.sqrt(PEAK_ACCELERATION * way / (SHARE * robot.max_acceleration))
        lasts = float(max(lasts, fast.max(), jerky.max()))
    return lasts
