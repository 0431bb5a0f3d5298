"""From frames that come when they come to requests at the robot's own rate."""

from __future__ import annotations

from collections import deque

import numpy as np

from nao_sim.robot import Array

HELD = 0.1  # s after the last frame, in which its request still stands; then the guard bridges its own gap
MISSED = 1.5  # usual intervals, in which it stands where frames come seldom
LONGEST_HELD = 0.4  # s, however seldom
BEHIND = 1.0  # usual intervals between frames, by which requests are behind the newest frame
_KEPT = 8  # frames


class Playout:
    """Requests between frames, linear as those of a recording; it has a state.

    Requests run one usual interval behind the newest frame.  Going straight to
    each frame as it comes is a staircase that the guard must smooth: measured
    on recordings, the robot is then no sooner where the person is, and the
    commands are twice as jerky (benchmarks/live.py).

    Args:
        behind: usual intervals.
    """

    def __init__(self, behind: float = BEHIND) -> None:
        self._behind = behind
        self.reset()

    def reset(self) -> None:
        """Forget all frames."""
        self._frames: deque[tuple[float, Array]] = deque(maxlen=_KEPT)
        self._received = -np.inf

    def add(self, time: float, positions: Array, now: float) -> None:
        """Take what a frame asks (26,) at a time (s, this clock, when it was made), at `now`."""
        while self._frames and self._frames[-1][0] >= time:  # the sender's clock was found to be another
            self._frames.pop()
        self._frames.append((time, positions))
        self._received = now

    def at(self, now: float, interval: float) -> Array | None:
        """What is asked (26,) now; None where nothing has come for too long.

        Args:
            now: s.
            interval: s from a frame to the next, usually.
        """
        held = min(max(HELD, MISSED * interval), LONGEST_HELD)
        if not self._frames or now - self._received > held:
            return None
        moment = now - self._behind * interval
        after = self._frames[-1]
        for before in reversed(self._frames):
            if before[0] <= moment:
                return _between(before, after, moment)
            after = before
        return self._frames[0][1]


def _between(before: tuple[float, Array], after: tuple[float, Array], moment: float) -> Array:
    if after[0] <= before[0]:
        return before[1]
    share = (moment - before[0]) / (after[0] - before[0])
    return np.asarray((1.0 - share) * before[1] + share * after[1])
