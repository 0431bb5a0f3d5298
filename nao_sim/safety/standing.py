"""Balance along ways: whether the robot can stand at every pose of a motion, and whether the motion tips it."""

from __future__ import annotations

import mujoco
import numpy as np

from nao_sim.robot import Array, Mask
from nao_sim.safety.balance import Balance, Look, Support
from nao_sim.safety.margins import Finding
from nao_sim.safety.posed import PosedRobot

SPACING = 3  # control steps between the poses that are looked at
WITHIN = 0.003  # m; what is farther inside is found when a way comes near it


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
        self._position, self._now = start, self._looked_at(start)
        self._support = balance.support(self._now)

    def moved(self, position: Array) -> None:
        """A command (26,) has been taken."""
        self._put(position)
        if self._support is not None and (position[self._legs] == self._position[self._legs]).all():
            self._now = self._balance.recentred(self._now)
            return
        self._position = position
        self._balance.moved()
        self._now = self._balance.look()
        self._support = self._balance.support(self._now)

    def holds(self) -> bool:
        """Whether the robot can stand in the pose as put."""
        return not self._balance.broken()

    def kept(self, line: Array, dt: float, rounding: float) -> bool:
        """Whether the robot stands at every pose of a line (N, 26), the first left out, and is not tipped on it."""
        if self._support is not None and self._legs_stand(line):
            return self._leans_alone(line, dt, self._support) >= -rounding
        before, at = self._now, 0
        for index in _chosen(line):
            self._put(line[index])
            if self._balance.broken():
                return False
            look = self._balance.look()
            if self._balance.leaning(before, look, (index - at) * dt) < -rounding:
                return False
            before, at = look, index
        return True

    def _leans_alone(self, line: Array, dt: float, support: Support) -> float:
        """The least leaning on a line (N, 26) on which the legs stand still, so that the support does, too.

        It is fastest in the first step, and farthest at the end.
        """
        chosen = sorted({0, 1, len(line) - 1})
        centres = np.array([self._centre(pose) for pose in line[chosen]])
        return support.leaning(centres, np.asarray(np.diff(chosen) * dt))

    def _legs_stand(self, line: Array) -> bool:
        return bool((line[1:, self._legs] == line[0, self._legs]).all())

    def _centre(self, pose: Array) -> Array:
        self._put(pose)
        mujoco.mj_comPos(self._posed.model, self._posed.data)
        return self._posed.data.subtree_com[0].copy()

    def findings(self, line: Array, reach: Array, dt: float) -> list[Finding]:
        """What the next pose of a line and its last one come near to, and the speed with which the next one is reached.

        Args:
            line: (N, 26), from where the robot is.
            reach: (N, 26) s, derivatives of the poses by the speeds of the next step.
            dt: s.
        """
        alone = self._support if self._legs_stand(line) else None
        if alone is not None and self._leans_alone(line, dt, alone) >= WITHIN:
            return []
        found: list[Finding] = []
        for at in sorted({1, len(line) - 1}):
            self._put(line[at])
            found += [Finding(margin, margin.gradient * reach[at]) for margin in self._balance.margins(WITHIN)]
        look = self._looked_at(line[1])
        leaning = self._balance.leaning_margins(self._now, look, dt, WITHIN)
        return found + [Finding(margin, margin.gradient * reach[1]) for margin in leaning]

    def _looked_at(self, pose: Array) -> Look:
        self._put(pose)
        self._balance.broken()
        return self._balance.look()

    def _put(self, pose: Array) -> None:
        self._posed.put(self._posed.map.to_qpos(pose))


def _chosen(line: Array) -> list[int]:
    """Indices of the next pose of a line, every few after it, and the last."""
    last = len(line) - 1
    return [*range(1, last, SPACING), last]
