"""The robot as it was asked to be, without guard and physics: the other half of a film that compares."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from nao_sim.robot import LEGS, START_POSTURE, Array
from nao_sim.safety.assessment import held

if TYPE_CHECKING:
    from nao_sim.simulation.rollout import Rollout
    from nao_sim.simulation.simulator import Simulator

FEET = ("l_ankle", "r_ankle")


def requested_poses(rollout: Rollout, times: Array, simulator: Simulator) -> Array:
    """Configurations (N, nq) of the requested joints at `times` (N,) s; what is not asked for holds.

    A robot on its feet stands on the lower one, flat where it stood at the start: it neither falls nor slips, which
    nothing of what was asked for tells.
    """
    start = simulator.robot.postures[START_POSTURE]
    asked = held(rollout.requested, start)
    joints = np.column_stack([np.interp(times, rollout.time, column) for column in asked.T])
    if not simulator.map.free:
        return simulator.map.to_qpos(joints)
    legs = joints[:, simulator.robot.joints_of(*LEGS)]
    stances, which = np.unique(legs, axis=0, return_index=True, return_inverse=True)[1:]
    bases = standing_bases(joints[stances], simulator)
    return simulator.map.to_qpos(joints, bases[which.reshape(-1)])


def standing_bases(joints: Array, simulator: Simulator) -> Array:
    """Poses (N, 7) of the torso of a robot with joints (N, 26) whose lower foot is where it was at the start."""
    model, data = simulator.model, mujoco.MjData(simulator.model)
    feet = [model.body(name).id for name in FEET]
    mujoco.mj_resetDataKeyframe(model, data, model.key(START_POSTURE).id)
    mujoco.mj_kinematics(model, data)
    placed = [(data.xpos[foot].copy(), data.xmat[foot].reshape(3, 3).copy()) for foot in feet]
    bases = np.empty((len(joints), 7))
    for base, qpos in zip(bases, simulator.map.to_qpos(joints), strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        lower = int(np.argmin(data.xpos[feet, 2]))
        position, rotation = placed[lower]
        turned = rotation @ data.xmat[feet[lower]].reshape(3, 3).T
        base[:3] = position - turned @ data.xpos[feet[lower]]
        mujoco.mju_mat2Quat(base[3:], turned.ravel())
    return bases
