"""The robot's arms from the axes in the facts table: what the formulas of the product are checked against."""

import numpy as np
from scipy.spatial.transform import Rotation

from nao_sim.imitation.arms import ARM_JOINTS
from nao_sim.imitation.features import LEFT, RIGHT
from nao_sim.robot import facts, load_robot

ROBOT = load_robot()
LETTER = {LEFT: "L", RIGHT: "R"}
AXES = {joint["name"]: np.array(joint["axis"]) for joint in facts()["joints"]}
X = np.array([1.0, 0.0, 0.0])


def joints(side):
    return [ROBOT.index[LETTER[side] + name] for name in ARM_JOINTS]


def limits(side):
    return ROBOT.lower[joints(side)], ROBOT.upper[joints(side)]


def forward(angles, side):
    """Directions (T, 3) of upper arm and forearm."""
    turns = [Rotation.from_rotvec(np.outer(angles[:, i], AXES[LETTER[side] + n])) for i, n in enumerate(ARM_JOINTS)]
    shoulder, elbow = turns[0] * turns[1], turns[2] * turns[3]
    return shoulder.apply(X), (shoulder * elbow).apply(X)


def random_poses(side, count=1000, seed=0):
    lower, upper = limits(side)
    return lower + (upper - lower) * np.random.default_rng(seed).random((count, 4))


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def errors(angles, upper_arm, forearm, side=LEFT):
    """Angles (T, 2) rad by which the arm misses unit vectors."""
    reached = np.stack(forward(np.atleast_2d(angles), side), axis=1)
    return 2.0 * np.arcsin(
        np.minimum(np.linalg.norm(reached - np.stack([upper_arm, forearm], axis=-2), axis=-1) / 2, 1)
    )
