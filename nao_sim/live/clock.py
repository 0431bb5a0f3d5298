"""The time of this machine, and the beat to which a robot steps."""

from __future__ import annotations

import time
from typing import Protocol

from nao_sim.simulation.simulator import CONTROL_STEP

FORGIVEN = 0.1  # s behind, from which on a beat skips steps instead of making up for them
RECOVERED = 2.0  # s in which nothing was skipped


class Clock(Protocol):
    """Says what time it is; tests bring their own."""

    def __call__(self) -> float:
        """Seconds, from any instant on, that never go back."""


monotonic: Clock = time.monotonic  # the same in all processes of a machine


class Beat:
    """When each control step is due; it has a state.

    Args:
        now: s, of the first step.
        step: s between two.

    Attributes:
        skipped: steps that were never made because the machine was too slow.
    """

    def __init__(self, now: float, step: float = CONTROL_STEP) -> None:
        self._began, self._count, self._step = now, 0, step
        self.skipped, self._fell_behind = 0, float("-inf")

    @property
    def due(self) -> float:
        """When (s) the next step is; counted, not added up, so that it never drifts."""
        return self._began + self._count * self._step

    def take(self, now: float) -> bool:
        """Whether a step is due at `now` (s); if so, it counts as made."""
        if now < self.due:
            return False
        self._count += 1
        if now - self.due > FORGIVEN:
            steps = int((now - self.due) / self._step)
            self._count += steps
            self.skipped += steps
            self._fell_behind = now
        return True

    def slow(self, now: float) -> bool:
        """Whether steps were skipped lately."""
        return now - self._fell_behind < RECOVERED
