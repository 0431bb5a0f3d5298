"""Where the links are, multiplied together from facts.json alone: no MuJoCo, no code of the model's scripts."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from nao_sim.robot import facts, load_robot


def all_joints() -> list[dict[str, Any]]:
    """The 26 joints and the 16 of the fingers, parents first, under one set of keys."""
    fingers = [
        {
            "name": f["name"],
            "parent": f["parent_link"],
            "child": f["child_link"],
            "origin_m": f["origin_xyz_m"],
            "rpy": f["origin_rpy_rad"],
            "axis": f["axis"],
            "lower": f["lower_rad"],
            "upper": f["upper_rad"],
            "driven_by": f["driven_by"],
            "multiplier": f["multiplier"],
        }
        for f in facts()["hand"]["finger_joints"]
    ]
    return [*({"rpy": (0.0, 0.0, 0.0), **joint} for joint in facts()["joints"]), *fingers]


def angles(joint: dict[str, Any], poses: np.ndarray) -> np.ndarray:
    """(T,) angle of a joint in poses (T, 26); a finger turns with its hand."""
    index = load_robot().index
    if joint["name"] in index:
        return poses[:, index[joint["name"]]]
    return poses[:, index[joint["driven_by"]]] * joint["multiplier"]


def link_frames(poses: np.ndarray) -> dict[str, np.ndarray]:
    """Pose (T, 4, 4) of each link in the torso's frame."""
    frames = {"torso": np.tile(np.eye(4), (len(poses), 1, 1))}
    for joint in all_joints():
        turn = Rotation.from_rotvec(angles(joint, poses)[:, None] * np.array(joint["axis"]))
        step = np.tile(np.eye(4), (len(poses), 1, 1))
        step[:, :3, :3] = (Rotation.from_euler("xyz", joint["rpy"]) * turn).as_matrix()
        step[:, :3, 3] = joint["origin_m"]
        frames[joint["child"]] = frames[joint["parent"]] @ step
    return frames


def difference(a: np.ndarray, b: np.ndarray) -> tuple[float, float]:
    """Greatest distance (m) and turn (rad) between two sets of poses (T, 4, 4)."""
    turn = Rotation.from_matrix(a[:, :3, :3].swapaxes(1, 2) @ b[:, :3, :3]).magnitude()
    return float(np.linalg.norm(a[:, :3, 3] - b[:, :3, 3], axis=1).max()), float(turn.max())
