"""Balance along ways: whether the robot can stand at every pose of a motion, and whether the motion tips it."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array, Mask
from nao_sim.safety.balance import Balance
from nao_sim.safety.margins import Finding
from nao_sim.safety.posed import PosedRobot

WITHIN = 0.003  # m; what is farther inside is found when a way comes near it
SPACING = 4  # control steps between the poses that are looked at: on less, legs that stand go nearly straight


class Standing:
    """Looks along ways for poses that the robot cannot stand in, and for speeds that tip it.

    Args:
        balance: the rule on poses.
        posed: the robot that it looks at.
        legs: (26,) the joints of the legs.
        start: (26,) the posture in which it stands.
    """

    def __init__(self, balance: Balance, posed: PosedRobot, legs: Mask, start: Array) -> None:
        self._balance, self._posed, self._legs = balance, posed, legs
        self._position = start
        self._put(start)
        self._now, self._momentum = balance.look(), np.zeros(2)
        self._inside = balance.inside(self._now)
        self._next = self._now, start  # what was seen at the pose after this one, when a way was looked at

    def moved(self, position: Array, dt: float) -> None:
        """A command (26,) has been taken, `dt` (s) after the one before."""
        legs_stand = bool((position[self._legs] == self._position[self._legs]).all())
        self._position = position
        look, seen = self._next
        if not (legs_stand and (seen == position).all()):
            self._put(position)
            if not legs_stand:
                self._balance.moved()
            look = self._balance.look()
        self._momentum, self._now = self._balance.momentum(self._now, look, dt), look
        self._inside = self._balance.inside(look)

    def holds(self) -> bool:
        """Whether the robot can stand in the pose as put."""
        self._balance.update()
        return not self._balance.broken()

    def kept(self, line: Array, dt: float, rounding: float) -> bool:
        """Whether the robot stands at every pose of a line (N, 26), the first left out, and is not tipped on it."""
        legs_stand, before, momentum, at = self._legs_stand(line), self._now, self._momentum, 0
        for index in _chosen(line):
            self._put(line[index])
            if not legs_stand and self._balance.broken():
                return False
            look = self._balance.look()
            if index == 1:
                self._next = look, line[1]
            gone, last = self._balance.momentum(before, look, (index - at) * dt), momentum
            if self._balance.steady(self._inside, look, gone, (gone - last) / ((index - at) * dt)) < -rounding:
                return False
            before, momentum, at = look, gone, index
        return True

    def findings(self, line: Array, reach: Array, dt: float) -> list[Finding]:
        """What the next pose of a line and its last one come near to, and the speed with which the next one is reached.

        Args:
            line: (N, 26), from where the robot is.
            reach: (N, 26) s, derivatives of the poses by the speeds of the next step.
            dt: s.
        """
        found: list[Finding] = []
        if not self._legs_stand(line):
            for at in sorted({1, len(line) - 1}):
                self._put(line[at])
                found += [Finding(margin, margin.gradient * reach[at]) for margin in self._balance.margins(WITHIN)]
        self._put(line[1])
        margins = self._balance.steady_margins(self._now, self._balance.look(), dt, self._momentum, WITHIN)
        return found + [Finding(margin, margin.gradient * reach[1]) for margin in margins]

    def _legs_stand(self, line: Array) -> bool:
        return bool((line[1:, self._legs] == line[0, self._legs]).all())

    def _put(self, pose: Array) -> None:
        self._posed.put(self._posed.map.to_qpos(pose))
        self._balance.update()


def _chosen(line: Array) -> list[int]:
    """Indices of the next two poses of a line, every few after them, and the last."""
    last = len(line) - 1
    return [1, *range(2, last, SPACING), last] if last > 1 else [1]
