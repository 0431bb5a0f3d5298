"""Which links touch in a pose, and angle tables in degrees as poses."""

from __future__ import annotations

from collections.abc import Mapping

import mujoco
import numpy as np

from nao_sim.mujoco_model import JointMap
from nao_sim.robot import facts, load_robot

ROBOT = load_robot()
Pair = frozenset[str]
HAND_OF = {f["child_link"]: f["parent_link"] for f in facts()["hand"]["finger_joints"]}


def hand_of(link: str) -> str:
    """The hand that a finger is part of; other links are their own."""
    while link in HAND_OF:
        link = HAND_OF[link]
    return link


class Contacts:
    """Contacts of a model's robot in given poses; distances up to `within` m count as near."""

    def __init__(self, model: mujoco.MjModel, within: float = 0.0) -> None:
        self.model, self.data, self.joints = model, mujoco.MjData(model), JointMap(model)
        self.within = within

    def distances(self, pose: np.ndarray) -> dict[Pair, float]:
        """Least distance (m, negative inside) of each pair of links that is near."""
        self.model.geom_margin[:] = self.within
        self.data.qpos[:] = self.joints.to_qpos(pose)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_collision(self.model, self.data)
        self.model.geom_margin[:] = 0.0
        found: dict[Pair, float] = {}
        for geoms, distance in zip(self.data.contact.geom, self.data.contact.dist, strict=True):
            pair = frozenset(self.model.body(body).name for body in self.model.geom_bodyid[geoms])
            found[pair] = min(found.get(pair, np.inf), float(distance))
        return found

    def touching(self, pose: np.ndarray) -> set[Pair]:
        """Pairs of links that touch."""
        return {pair for pair, distance in self.distances(pose).items() if distance < 0}


def posed(angles_deg: Mapping[str, float]) -> np.ndarray:
    """(26,) Stand with the head straight, and the given joints elsewhere."""
    pose = ROBOT.postures["Stand"].copy()
    pose[ROBOT.limbs["Head"]] = 0.0
    for name, angle in angles_deg.items():
        pose[ROBOT.index[name]] = np.radians(angle)
    return pose


def arm(side: str, *angles_deg: float) -> dict[str, float]:
    """Shoulder pitch and roll, elbow yaw and roll, wrist yaw."""
    names = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw")
    return {side + name: angle for name, angle in zip(names, angles_deg, strict=True)}
