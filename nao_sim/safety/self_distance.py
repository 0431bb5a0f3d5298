"""How near the robot's parts are to each other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import mujoco

from nao_sim.mujoco_model import JointMap, robot_alone
from nao_sim.robot import Array, facts

HORIZON = 0.03


@dataclass(frozen=True)
class Nearest:
    """The closest two links of a pose.

    Attributes:
        distance: m between their collision shapes, negative where they overlap,
            the horizon where nothing is nearer than that.
        links: the two links' names, empty where nothing is near.
    """

    distance: float
    links: tuple[str, ...] = ()


class SelfDistance:
    """Distances between all pairs of links that are not neighbours by construction.

    Args:
        horizon: m; pairs farther apart are not looked at, which is what makes it quick.
    """

    def __init__(self, horizon: float = HORIZON) -> None:
        self._horizon = horizon
        self._model = robot_alone(horizon)
        self._data = mujoco.MjData(self._model)
        self._map = JointMap(self._model)
        bodies = (self._model.body(i).name for i in range(self._model.nbody))
        self._link = tuple(hand_of_finger(name) for name in bodies)

    def first_within(self, poses: Array, within: float) -> Nearest | None:
        """The closest pair in the first of poses (N, 26) with links nearer than `within` (m, at most the horizon)."""
        for qpos in self._map.to_qpos(poses):
            pairs = list(self._pairs(qpos, within))
            if pairs:
                return min(pairs, key=lambda pair: pair.distance)
        return None

    def pairs(self, positions: Array, within: float) -> Iterable[Nearest]:
        """All pairs of links nearer than `within` (m, at most the horizon) at a pose (26,)."""
        return self._pairs(self._map.to_qpos(positions), within)

    def _pairs(self, qpos: Array, within: float) -> Iterable[Nearest]:
        self._data.qpos[:] = qpos
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        if self._data.ncon == 0:
            return
        contact, bodies = self._data.contact, self._model.geom_bodyid
        distances = contact.dist
        for i in (distances < within).nonzero()[0]:
            first, second = bodies[contact.geom[i]]
            yield Nearest(float(distances[i]), (self._link[first], self._link[second]))

    def nearest(self, positions: Array) -> Nearest:
        """The closest pair at a pose (26,)."""
        nearest = Nearest(self._horizon)
        return min(self.pairs(positions, self._horizon), key=lambda pair: pair.distance, default=nearest)


def hand_of_finger(link: str) -> str:
    """Fingers count as part of their hand."""
    for finger in facts()["hand"]["finger_joints"]:
        if finger["child_link"] == link:
            return "l_wrist" if link[0] == "L" else "r_wrist"
    return link
