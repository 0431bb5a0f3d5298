"""Where each vendor posture rests on the floor: drop it, let it settle, note the torso's pose."""

from __future__ import annotations

import mujoco
import numpy as np
from tables import MODEL, table

SETTLE_S = 8.0
# Torso pitch to drop from (rad): sitting, feet and seat meet the floor together.
PITCH = {"LyingBack": -np.pi / 2, "LyingBelly": np.pi / 2, "Sit": -0.6, "SitRelax": -0.1}


def base_poses() -> dict[str, list[float]]:
    """Torso pose (x, y, z, qw, qx, qy, qz) of each posture at rest, moved to x = y = 0 and facing +x."""
    model = mujoco.MjModel.from_xml_path(str(MODEL / "scene.xml"))
    data = mujoco.MjData(model)
    return {posture: _settle(model, data, posture) for posture in table("facts.json")["postures"]}


def _settle(model: mujoco.MjModel, data: mujoco.MjData, posture: str) -> list[float]:
    mujoco.mj_resetDataKeyframe(model, data, model.key(posture).id)
    half = PITCH.get(posture, 0.0) / 2
    data.qpos[:7] = 0, 0, 0, np.cos(half), 0, np.sin(half), 0
    mujoco.mj_kinematics(model, data)
    data.qpos[2] -= _lowest_point(model, data) - 0.001
    while data.time < SETTLE_S:
        mujoco.mj_step(model, data)
    return [0.0, 0.0, *(float(round(x, 5) + 0.0) for x in (data.qpos[2], *_facing_forward(data.qpos[3:7])))]


def _facing_forward(quat: np.ndarray) -> np.ndarray:
    """The same tilt without its turn about the vertical."""
    turn = np.arctan2(quat[3], quat[0])
    untwisted = np.empty(4)
    mujoco.mju_mulQuat(untwisted, np.array([np.cos(-turn), 0.0, 0.0, np.sin(-turn)]), quat)
    return untwisted * np.sign(untwisted[0])


def _lowest_point(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Lower end of the bounding boxes of all shapes of the robot."""
    robot = np.flatnonzero((model.geom_bodyid > 0) & (model.geom_contype > 0))
    centre, half = model.geom_aabb[robot, :3], model.geom_aabb[robot, 3:]
    frames = data.geom_xmat[robot].reshape(-1, 3, 3)
    height = data.geom_xpos[robot, 2] + np.einsum("gi,gi->g", frames[:, 2], centre)
    return float((height - np.einsum("gi,gi->g", abs(frames[:, 2]), half)).min())
