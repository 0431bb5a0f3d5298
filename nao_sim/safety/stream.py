"""The health of a source: gaps, silence and jumps in what it asks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nao_sim.robot import Array, Mask, Robot

STALE = 0.2  # s without a number; then a joint no longer moves to where it was last asked
JUMP = 0.5  # rad between two requests; the first one is seen from where the robot is
CAUGHT_UP = 0.02  # rad


class Stream:
    """Makes every request whole: a number for each joint, and who must take his time.

    Args:
        robot: whose joints they are.
        start: (26,) the posture that the robot is in.
        watched: whether silence and jumps count; otherwise gaps are filled for ever and nobody is slow.
    """

    def __init__(self, robot: Robot, start: Array, watched: bool = True) -> None:
        self._robot, self._watched = robot, watched
        self._request, self._silent = start.copy(), np.full(len(start), np.inf)
        self._slow, self._forgone = np.zeros(len(start), bool), np.zeros(len(start))
        self._finite, self._steady = np.zeros(len(start), bool), False

    def step(
        self, requested: Array, dt: float, position: Array, stop: Callable[[], Array]
    ) -> tuple[Array, Array, Mask]:
        """What is asked at this step.

        Args:
            requested: (26,) as it came; what is not finite asks nothing new.
            dt: s since the last one.
            position: (26,) the previous command.
            stop: tells where (26,) a full stop from there would end.

        Returns:
            The request (26,), all finite; how far (26,) that is from what was asked
            last, where a source fell silent; and who must approach his slowly,
            because it jumped.
        """
        finite = np.isfinite(requested)
        request = np.where(finite, requested, self._request)
        if self._steady and (finite == self._finite).all() and (np.abs(request - self._request) < JUMP).all():
            self._request = request
            return request, self._forgone, self._slow
        return self._unsteady(request, finite, dt, position, stop())

    def _unsteady(
        self, request: Array, finite: Mask, dt: float, position: Array, stop: Array
    ) -> tuple[Array, Array, Mask]:
        since = np.where(np.isinf(self._silent), 0.0, self._silent) + dt
        jump = np.abs(self._possible(request) - self._possible(self._request))
        jumped = jump > JUMP + self._robot.no_load_speed * since
        falls_silent = (self._silent <= STALE) & (self._silent + dt > STALE) & ~finite
        self._silent = np.where(finite, 0.0, self._silent + dt)
        self._finite, self._request = finite, request
        if self._watched:
            elsewhere = np.abs(self._possible(request) - position) > CAUGHT_UP
            self._request = np.where(falls_silent & elsewhere, stop, request)
            self._forgone = np.where(finite, 0.0, self._forgone + self._request - request)
            self._slow = (self._slow | jumped) & elsewhere & ~self._robot.is_hand
        self._steady = bool((finite | (self._silent > STALE)).all() and not self._slow.any())
        return self._request, self._forgone, self._slow

    def _possible(self, request: Array) -> Array:
        """A request (26,) as far as the joints can go."""
        return np.clip(request, self._robot.lower, self._robot.upper)
