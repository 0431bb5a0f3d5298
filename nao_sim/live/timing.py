"""When a sender's frames were made, by the receiver's clock; and what is wrong with how they come.

A frame's delay is unknown, but frames that came quickest came without any to
speak of: the smallest difference of the two clocks, which leaks upwards a
little so that clocks may drift, tells them apart (as in NTP's minimum filter,
D. Mills, RFC 5905, clock filter algorithm).
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from statistics import median

LEAK = 5e-4  # s of offset a second, of two bad quartzes
RESTART = 1.0  # s back in time, from which on a sender has begun anew
_RECENT = 15  # intervals that say how often frames come
_USUAL = 1 / 30  # s, before anything is known
_GAP = 1.5  # usual intervals, from which on frames are missing


@dataclass
class Counts:
    """How frames came.

    Attributes:
        received: all that were frames.
        lost: that should have been between them.
        late: older than one that was there already.
        duplicate: of the same time as the one before.
        dropped: passed over because newer ones waited.
        refused: that were no frames of this layout.
    """

    received: int = 0
    lost: int = 0
    late: int = 0
    duplicate: int = 0
    dropped: int = 0
    refused: int = 0


class Arrivals:
    """Follows one sender's times; it has a state.

    Attributes:
        counts: how frames came.
        last: s, the sender's time of the newest frame; minus infinity before the first.
        received: s, when that came.
        delay: s, how much longer it took than the quickest.
    """

    def __init__(self) -> None:
        self.counts = Counts()
        self.reset()

    def reset(self) -> None:
        """Forget the sender."""
        self.last = self.received = -math.inf
        self.delay, self._offset, self._overtaken = 0.0, math.inf, 0
        self._intervals: deque[float] = deque(maxlen=_RECENT)

    @property
    def interval(self) -> float:
        """Seconds from a frame to the next, usually."""
        return median(self._intervals) if self._intervals else _USUAL

    @property
    def offset(self) -> float:
        """What to add to the sender's times."""
        return self._offset

    def take(self, time: float, now: float) -> bool:
        """Whether a frame is a newer one; a sender whose clock begins anew is forgotten first.

        Args:
            time: s, the sender's.
            now: s, the receiver's.
        """
        self.counts.received += 1
        if self.last - time > RESTART:
            self.reset()
        if time <= self.last:
            self.counts.duplicate += time == self.last
            self.counts.late += time < self.last
            return False
        self._note(time, now)
        return True

    def pass_over(self) -> None:
        """Count a frame that came, but that newer ones have overtaken."""
        self.counts.dropped += 1
        self._overtaken += 1

    def _note(self, time: float, now: float) -> None:
        step = time - self.last
        if math.isfinite(step):
            if len(self._intervals) == _RECENT and step > _GAP * self.interval:
                self.counts.lost += min(max(round(step / self.interval) - 1 - self._overtaken, 0), 1000)
            self._intervals.append(step / (1 + self._overtaken))
            self._offset += LEAK * max(now - self.received, 0.0)
        self._offset = min(self._offset, now - time)
        self.delay = now - time - self._offset
        self.last, self.received, self._overtaken = time, now, 0
