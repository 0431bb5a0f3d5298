"""The robot put into one pose after the other: what every rule on poses looks at."""

from __future__ import annotations

from functools import cache

import mujoco
import numpy as np

from nao_sim.mujoco_model import JointMap, robot_alone
from nao_sim.robot import Array, facts


class PosedRobot:
    """The robot alone, its torso held upright.

    Args:
        margin: m; shapes nearer than this are found by the collision query.
        version: whose masses count.

    Attributes:
        model: the compiled model.
        data: its state; `put` brings the kinematics up to date and nothing else.
        map: where the joint vector is in it.
        movers: (bodies, joints of the model) 1 where the joint moves the body.
        by_vector: (joints of the model, 26) how the model's joints turn with the joint vector:
            a hand's opening turns its fingers.
        links: of each body; fingers count as part of their hand.
    """

    def __init__(self, margin: float = 0.0, version: str = "v5") -> None:
        self.model = _compiled(margin, version)
        self.data = mujoco.MjData(self.model)
        self.map = JointMap(self.model)
        self.movers = _movers(self.model)
        unit, zero = np.eye(len(self.map.qpos)), np.zeros(len(self.map.qpos))
        self.by_vector = (self.map.to_qpos(unit) - self.map.to_qpos(zero)).T
        self.links = tuple(hand_of_finger(self.model.body(i).name) for i in range(self.model.nbody))

    def put(self, qpos: Array) -> None:
        """Take a pose, given as the model's own configuration (nq,)."""
        self.data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self.data)

    def parting(self, first: int, second: int, point: Array, direction: Array) -> Array:
        """How a point of one body parts from the same point of another along a direction, (26,) m/rad (hands m)."""
        movers = self.movers[second] - self.movers[first]
        return np.asarray((self._turned(point, direction) * movers) @ self.by_vector)

    def _turned(self, point: Array, direction: Array) -> Array:
        """(joints,) m/rad along a direction, of a point that every joint of the model turns."""
        x, y, z = (point - self.data.xanchor).T
        u, v, w = direction
        # (axis x arm) . direction = axis . (arm x direction), without np.cross, which takes longer than all the rest
        arm_x_direction = np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)
        return np.asarray((self.data.xaxis * arm_x_direction).sum(axis=1))


@cache
def _compiled(margin: float, version: str) -> mujoco.MjModel:
    """The model, which nothing here changes, so that all who ask for it share it."""
    return robot_alone(margin, version)


def _movers(model: mujoco.MjModel) -> Array:
    """(bodies, joints) 1 where the joint moves the body."""
    moves = np.zeros((model.nbody, model.njnt))
    for body in range(1, model.nbody):
        moves[body] = moves[model.body_parentid[body]]
        first = model.body_jntadr[body]
        if first >= 0:
            moves[body, first : first + model.body_jntnum[body]] = 1.0
    return moves


def hand_of_finger(link: str) -> str:
    """Fingers count as part of their hand."""
    for finger in facts()["hand"]["finger_joints"]:
        if finger["child_link"] == link:
            return "l_wrist" if link[0] == "L" else "r_wrist"
    return link
