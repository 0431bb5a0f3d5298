"""Poses and movements of one vocabulary recognised together while a person moves.

Arms that hold still show a pose, arms that move a movement; the two are told
apart by one number, `HELD`:

* Where movements are known, a pose counts once it has been announced for `HELD`
  seconds, so that the turning points of a movement and arms that wait for its
  next part are no poses.  Where none are, it counts at once.
* A pose that counts goes before a movement: arms that keep still have ended it.
  What they did before is forgotten, so that the way into a pose, its hold and
  the way out are not taken together for a movement.
* Else a movement counts as soon as it is announced.
"""

from __future__ import annotations

import math

import numpy as np

from nao_sim.gestures.movement_stream import MovementStream
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import Decision, PoseStream
from nao_sim.gestures.vocabulary import Vocabulary
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

HELD = 0.5  # s


class GestureStream:
    """Follows one person; it has a state.

    Args:
        vocabulary: the gestures to tell.
        joints: (J,) names of the rows of the frames.
        planar: whether one camera sees the person and x is 0 throughout.
    """

    def __init__(self, vocabulary: Vocabulary, joints: tuple[str, ...], planar: bool = False) -> None:
        poses, movements = vocabulary.poses, vocabulary.movements
        self._poses = PoseStream(poses, joints, planar) if poses else None
        self._movements = MovementStream(movements, joints, planar) if movements else None
        self._held = HELD if movements else 0.0
        self._last = _nothing(-math.inf)

    def reset(self) -> None:
        """Forget the person."""
        for stream in (self._poses, self._movements):
            if stream:
                stream.reset()
        self._last = _nothing(-math.inf)

    def update(self, positions: Array, time: float, confidence: Array | None = None) -> Decision:
        """Take one frame.

        Args:
            positions: (J, 3) m, x forward, y left, z up; nan where missing.
            time: s, after the last frame's.
            confidence: (J,) from 0 to 1; 1 throughout where None.

        Raises:
            ValueError: time does not go on, or the frame has other joints.
        """
        pose = self._poses.update(positions, time, confidence) if self._poses else _nothing(time)
        movement = self._movements.update(positions, time, confidence) if self._movements else _nothing(time)
        found = self._choose(pose, movement)
        since = self._last.since if found.label == self._last.label and np.isfinite(self._last.since) else time
        self._last = Decision(time, found.label, found.confidence, since)
        return self._last

    def _choose(self, pose: Decision, movement: Decision) -> Decision:
        if pose.label != NONE and pose.time - pose.since >= self._held:
            if self._movements:
                self._movements.reset()
            return pose
        if movement.label != NONE:
            return movement
        return _nothing(pose.time) if pose.label != NONE else pose


def _nothing(time: float) -> Decision:
    return Decision(time, NONE, 1.0, time)


def stream_gestures(vocabulary: Vocabulary, skeleton: Skeleton) -> tuple[Decision, ...]:
    """The decisions (T,) over a recording, frame after frame as in a stream."""
    stream = GestureStream(vocabulary, skeleton.joints, skeleton.planar)
    frames = zip(skeleton.positions, skeleton.times.tolist(), skeleton.confidence, strict=True)
    return tuple(stream.update(*frame) for frame in frames)
