"""Balance along ways: whether the robot can stand at every pose of a motion, and whether the motion tips it."""

from __future__ import annotations

from nao_sim.robot import Array, Mask
from nao_sim.safety.balance import Balance
from nao_sim.safety.margins import Finding
from nao_sim.safety.posed import PosedRobot

WITHIN = 0.003  # m; what is farther inside is found when a way comes near it
SPACING = 8  # control steps between the poses that are looked at: on less, legs that stand go nearly straight


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
        self._now = balance.look()

    def moved(self, position: Array) -> None:
        """A command (26,) has been taken."""
        legs_stand = bool((position[self._legs] == self._position[self._legs]).all())
        self._position = position
        self._put(position)
        if not legs_stand:
            self._balance.moved()
        self._now = self._balance.look(legs_stand)

    def holds(self) -> bool:
        """Whether the robot can stand in the pose as put."""
        return not self._balance.broken()

    def kept(self, line: Array, dt: float, rounding: float) -> bool:
        """Whether the robot stands at every pose of a line (N, 26), the first left out, and is not tipped on it."""
        legs_stand, before, at = self._legs_stand(line), self._now, 0
        for index in _chosen(line):
            self._put(line[index])
            if not legs_stand and self._balance.broken():
                return False
            look = self._balance.look(legs_stand=True)
            if self._balance.leaning(before, look, (index - at) * dt) < -rounding:
                return False
            before, at = look, index
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
        leaning = self._balance.leaning_margins(self._now, self._balance.look(), dt, WITHIN)
        return found + [Finding(margin, margin.gradient * reach[1]) for margin in leaning]

    def _legs_stand(self, line: Array) -> bool:
        return bool((line[1:, self._legs] == line[0, self._legs]).all())

    def _put(self, pose: Array) -> None:
        self._posed.put(self._posed.map.to_qpos(pose))


def _chosen(line: Array) -> list[int]:
    """Indices of the next pose of a line, every few after it, and the last."""
    last = len(line) - 1
    return [*range(1, last, SPACING), last]
