"""Movements recognised while a person makes them.

Looks, a few times a second, at what has been done since the arms last hung (at
most `LONGEST`), and announces what several looks agree on.
"""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from nao_sim.gestures.movements import MovementRecogniser
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.reader import FrameReader
from nao_sim.gestures.streaming import PAUSE, Decision
from nao_sim.gestures.windows import window_of
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

SHORTEST, LONGEST = 0.8, 3.0  # s of movement that is looked at
EVERY = 0.2  # s between looks
AGREE = 3  # looks in a row that must say the same
RESTS = 0.3  # s, arms that hang for so long have ended a movement
_HANGS = -math.cos(math.radians(35.0))


class MovementStream:
    """Follows one person; it has a state.

    Args:
        recogniser: the movements to tell.
        joints: (J,) names of the rows of the frames.
        planar: whether one camera sees the person and x is 0 throughout.
    """

    def __init__(self, recogniser: MovementRecogniser, joints: tuple[str, ...], planar: bool = False) -> None:
        self._recogniser, self._joints, self._planar = recogniser, joints, planar
        self._reader = FrameReader(joints, planar)
        self.reset()

    def reset(self) -> None:
        """Forget the person."""
        self._frames: deque[tuple[float, Array, Array]] = deque()  # time, positions, confidence
        self._said: deque[tuple[str, float]] = deque(maxlen=AGREE)
        self._time = self._hung_since = self._looked = -math.inf
        self._decision = Decision(-math.inf, NONE, 1.0, -math.inf)

    def update(self, positions: Array, time: float, confidence: Array | None = None) -> Decision:
        """Take one frame.

        Args:
            positions: (J, 3) m, x forward, y left, z up; nan where missing.
            time: s, after the last frame's.
            confidence: (J,) from 0 to 1; 1 throughout where None.

        Raises:
            ValueError: time does not go on, or the frame has other joints.
        """
        if not (math.isfinite(time) and time > self._time):
            raise ValueError(f"time {time} s after {self._time} s; expected times that increase")
        if time - self._time > PAUSE:
            self.reset()
        sure = np.ones(len(self._joints)) if confidence is None else np.asarray(confidence, float)
        directions, _, _ = self._reader.read(positions, sure)
        self._time = time
        self._follow(time, bool((directions[..., 2] < _HANGS).all()))
        if not self._rests(time):
            self._frames.append((time, np.array(positions, float), sure))
            while time - self._frames[0][0] > LONGEST:
                self._frames.popleft()
            self._look(time)
        label, shown = self._agreed()
        since = self._decision.since if label == self._decision.label and self._decision.time > -math.inf else time
        self._decision = Decision(time, label, shown, since)
        return self._decision

    def _follow(self, time: float, hangs: bool) -> None:
        """Note since when the arms hang; forget the movement when they have for long enough."""
        self._hung_since = (time if math.isinf(self._hung_since) else self._hung_since) if hangs else -math.inf
        if self._rests(time):
            self._frames.clear()
            self._said.clear()

    def _rests(self, time: float) -> bool:
        return math.isfinite(self._hung_since) and time - self._hung_since >= RESTS

    def _look(self, time: float) -> None:
        if time - self._looked < EVERY - 1e-3 or time - self._frames[0][0] < SHORTEST:
            return
        self._looked = time
        times, positions, sure = (np.stack(parts) for parts in zip(*self._frames, strict=True))
        window = window_of(Skeleton(times, positions, self._joints, sure, self._planar))
        found = self._recogniser.decide(window)
        self._said.append((found.label, found.confidence))

    def _agreed(self) -> tuple[str, float]:
        labels = {label for label, _ in self._said}
        if len(self._said) < AGREE or len(labels) > 1:
            return NONE, 1.0
        return labels.pop(), float(np.mean([confidence for _, confidence in self._said]))


def stream_movements(recogniser: MovementRecogniser, skeleton: Skeleton) -> tuple[Decision, ...]:
    """The decisions (T,) over a recording, frame after frame as in a stream."""
    stream = MovementStream(recogniser, skeleton.joints, skeleton.planar)
    frames = zip(skeleton.positions, skeleton.times.tolist(), skeleton.confidence, strict=True)
    return tuple(stream.update(*frame) for frame in frames)
