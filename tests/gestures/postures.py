"""Made-up people who hold the postures of the thesis's table."""

import numpy as np

from nao_sim.gestures.directions import ArmReadings, readings_of_features
from nao_sim.gestures.training_table import thesis_table
from nao_sim.motion import Skeleton

JOINTS = tuple(f"{side}_{part}" for part in ("shoulder", "hip", "elbow", "wrist", "hand") for side in ("left", "right"))
PLAIN = {  # upper arm and forearm of the left side
    "side": [[0, 1, 0], [0, 1, 0]],
    "forward": [[1, 0, 0], [1, 0, 0]],
    "piUp": [[0, 1, 0], [0, 0, 1]],
    "up": [[0, 0, 1], [0, 0, 1]],
    "down": [[0, 0, -1], [0, 0, -1]],
}
MIRROR = np.array([1.0, -1.0, 1.0])


def held(left, right=None):
    """Directions (2, 2, 3) of the named postures of the left and the right arm."""
    return np.array([PLAIN[left], np.array(PLAIN[right or left]) * MIRROR], float)


def body(directions, height=1.7, turn=0.0, place=(0.0, 0.0, 0.0), noise=0.0, seed=0):
    """Joints (T, J, 3) m of a person with arms in directions (T, 2, 2, 3), turned to the left by `turn` rad."""
    frames = len(directions)
    found = {}
    for sign, side in ((1, "left"), (-1, "right")):
        arm = directions[:, 0 if side == "left" else 1]
        found[f"{side}_shoulder"] = np.tile([0.0, 0.105 * sign, 0.82], (frames, 1))
        found[f"{side}_hip"] = np.tile([0.0, 0.055 * sign, 0.53], (frames, 1))
        found[f"{side}_elbow"] = found[f"{side}_shoulder"] + 0.172 * arm[:, 0]
        found[f"{side}_wrist"] = found[f"{side}_elbow"] + 0.146 * arm[:, 1]
        found[f"{side}_hand"] = found[f"{side}_wrist"] + 0.05 * arm[:, 1]
    points = np.stack([found[joint] for joint in JOINTS], axis=1) * height
    points = points + np.random.default_rng(seed).normal(0.0, noise, points.shape)
    cos, sin = np.cos(turn), np.sin(turn)
    return points @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]) + place


def skeleton(directions, rate=30.0, **how):
    return Skeleton(np.arange(len(directions)) / rate, body(directions, **how), JOINTS)


def slerp(start, end, share):
    """Directions (..., 3) on the way between two, through the front where they are opposite."""
    across = np.cross(start, end)
    length = np.linalg.norm(across, axis=-1, keepdims=True)
    axis = np.where(length < 1e-6, [0.0, -1.0, 0.0], across / np.maximum(length, 1e-9))
    angle = share * np.arctan2(length, np.sum(start * end, axis=-1, keepdims=True))
    return start * np.cos(angle) + np.cross(axis, start) * np.sin(angle)


def thesis():
    """Readings (28) of the thesis's rows, their labels and users."""
    table = thesis_table()
    return readings_of_features(table.features), table.labels, table.users


def readings(*directions) -> ArmReadings:
    return ArmReadings(np.stack(directions))
