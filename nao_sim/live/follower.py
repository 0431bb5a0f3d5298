"""What the robot is asked, from a person's frames: each imitated, or the gestures in them recognised and played.

The objects are those that a recording passes through, too: `ImitationStream`,
`GestureStream`, `GesturePerformer`.
"""

from __future__ import annotations

import math

import numpy as np

from nao_sim.gestures.gesture_stream import GestureStream
from nao_sim.gestures.performing import GesturePerformer
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import PAUSE, Decision
from nao_sim.gestures.vocabulary import Vocabulary
from nao_sim.imitation.person import arm_directions
from nao_sim.imitation.stream import ImitationStream
from nao_sim.live.playout import Playout
from nao_sim.live.protocol import Mode
from nao_sim.robot import Array, Robot

_UNKNOWN = np.full((2, 2, 3), np.nan)


class Follower:
    """Follows one person whose joints do not change; it has a state.

    Args:
        joints: (J,) names of the rows of the frames.
        robot: who is asked.
        rest: (26,) the posture between gestures.
        vocabulary: the gestures to recognise.
        mode: what the robot does.
        planar: whether one camera sees the person.

    Attributes:
        decision: the gesture that the last frame showed.
    """

    def __init__(  # the parts of a session
        self,
        joints: tuple[str, ...],
        robot: Robot,
        rest: Array,
        vocabulary: Vocabulary,
        mode: Mode = "one-to-one",
        planar: bool = False,
    ) -> None:
        self._robot, self._rest, self._vocabulary = robot, rest, vocabulary
        self._imitation = ImitationStream(joints, robot, planar)
        self._gestures = GestureStream(vocabulary, joints, planar)
        self._playout = Playout()
        self._last = -math.inf
        self.use(mode)
        self.reset()

    def use(self, mode: Mode) -> None:
        """Imitate every frame from now on, or play gestures."""
        self._performer = GesturePerformer(self._vocabulary, self._robot, self._rest) if mode == "gestures" else None

    def reset(self) -> None:
        """Forget the person."""
        self._imitation.reset()
        self._gestures.reset()
        self._playout.reset()
        self._last = -math.inf
        self.decision = Decision(-math.inf, NONE, 1.0, -math.inf)

    @property
    def arms(self) -> Array:
        """Where the person's arms point (2, 2, 3) in the last frame, nan where not known."""
        person = self._imitation.person
        return _UNKNOWN if person is None else arm_directions(person)[0]

    def take(self, positions: Array, time: float, confidence: Array, now: float) -> None:
        """Take one frame.

        Args:
            positions: (J, 3) m.
            time: s, after the last frame's, by this clock.
            confidence: (J,).
            now: s, when it came.
        """
        if time <= self._last:  # the clocks were found to differ otherwise than before
            time = self._last + 1e-6
        self._last = time
        self.decision = self._gestures.update(positions, time, confidence)
        asked = self._imitation.update(positions, time, confidence)
        self._playout.add(time, asked, now)

    def asked(self, now: float, interval: float) -> Array | None:
        """What the robot is asked (26,) now, nan where nothing; None where no frame has come for too long."""
        if self._performer is None:
            return self._playout.at(now, interval)
        silent = now - self.decision.time > PAUSE
        return self._performer.update(Decision(now, NONE, 1.0, now) if silent else self.decision, now)


class AngleFollower:
    """Does a robot's joint angles as they come; it has a state, and the same ways as `Follower`."""

    def __init__(self) -> None:
        self._playout = Playout()
        self.decision, self.arms = None, _UNKNOWN

    def reset(self) -> None:
        """Forget what came."""
        self._playout.reset()

    def take(self, positions: Array, time: float, now: float) -> None:
        """Take joint positions (26,) of a time (s, this clock) that came at `now`."""
        self._playout.add(time, positions, now)

    def asked(self, now: float, interval: float) -> Array | None:
        """What the robot is asked (26,) now; None where nothing has come for too long."""
        return self._playout.at(now, interval)
