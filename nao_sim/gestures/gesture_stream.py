"""Poses and movements of one vocabulary recognised together while a person moves.

Arms that keep still show a pose, arms that move a movement; one number tells
them apart, `HELD`.  Where no movements are known, poses are announced as
`PoseStream` does; where they are:

* A pose counts once the arms have kept still in it for `HELD` seconds, so that
  turning points of a movement, and arms that wait for its next part, are no
  poses.  It lasts until the arms leave it or a movement is announced.
* Then every movement has ended, and what the arms did before is forgotten: the
  way into a pose, its hold and the way out are not one movement.
* A movement counts as soon as it is announced.
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
        self._counts = NONE  # the pose that counts
        self._last = _nothing(-math.inf)

    def reset(self) -> None:
        """Forget the person."""
        for stream in (self._poses, self._movements):
            if stream:
                stream.reset()
        self._counts = NONE
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
        movement = self._movements.update(positions, time, confidence) if self._movements else _nothing(time)
        pose, still = self._pose(positions, time, confidence) if self._poses else (_nothing(time), False)
        found = pose if still or movement.label == NONE else movement
        since = self._last.since if found.label == self._last.label and np.isfinite(self._last.since) else time
        self._last = Decision(time, found.label, found.confidence, since)
        return self._last

    def _pose(self, positions: Array, time: float, confidence: Array | None) -> tuple[Decision, bool]:
        """The pose that counts, and whether the arms have ended all movements by keeping still in it."""
        assert self._poses is not None
        found = self._poses.update(positions, time, confidence)
        if self._movements is None:
            return found, True
        still = found.label != NONE and time - self._poses.still_since >= HELD
        if still:
            self._movements.reset()
            self._counts = found.label
        elif found.label != self._counts:
            self._counts = NONE
        return (found if found.label == self._counts else _nothing(time)), still


def _nothing(time: float) -> Decision:
    return Decision(time, NONE, 1.0, time)


def stream_gestures(vocabulary: Vocabulary, skeleton: Skeleton) -> tuple[Decision, ...]:
    """The decisions (T,) over a recording, frame after frame as in a stream."""
    stream = GestureStream(vocabulary, skeleton.joints, skeleton.planar)
    frames = zip(skeleton.positions, skeleton.times.tolist(), skeleton.confidence, strict=True)
    return tuple(stream.update(*frame) for frame in frames)
