"""How near the robot's parts are to each other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import mujoco
import numpy as np

from nao_sim.robot import Array
from nao_sim.safety.posed import PosedRobot

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

    Attributes:
        robot: the robot that is put into the poses.
    """

    def __init__(self, horizon: float = HORIZON) -> None:
        self._horizon = horizon
        self.robot = PosedRobot(horizon)

    def pairs(self, positions: Array, within: float) -> Iterable[Nearest]:
        """All pairs of links nearer than `within` (m, at most the horizon) at a pose (26,)."""
        model, data = self.robot.model, self.robot.data
        self.robot.put(self.robot.map.to_qpos(positions))
        mujoco.mj_collision(model, data)
        if data.ncon == 0:
            return
        contact, bodies = data.contact, model.geom_bodyid
        distances = contact.dist
        for i in (distances < within).nonzero()[0]:
            first, second = bodies[contact.geom[i]]
            yield Nearest(float(distances[i]), (self.robot.links[first], self.robot.links[second]))

    def nearest(self, positions: Array) -> Nearest:
        """The closest pair at a pose (26,)."""
        nearest = Nearest(self._horizon)
        return min(self.pairs(positions, self._horizon), key=lambda pair: pair.distance, default=nearest)

    def smallest(self, poses: Array) -> Array:
        """Smallest distance (N,) m at each of poses (N, 26), the horizon where nothing is nearer."""
        model, data, put = self.robot.model, self.robot.data, self.robot.put
        smallest = np.full(len(poses), self._horizon)
        for i, qpos in enumerate(self.robot.map.to_qpos(poses)):
            put(qpos)
            mujoco.mj_collision(model, data)
            if data.ncon:
                smallest[i] = data.contact.dist.min()
        return smallest
