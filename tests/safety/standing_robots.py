"""Robots on both soles, for the tests of what they stand on."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from nao_sim.robot import LEGS, Array, load_robot
from nao_sim.safety.posed import PosedRobot

ROBOT = load_robot()
STAND = np.where(ROBOT.joints_of(*LEGS), ROBOT.postures["StandZero"], ROBOT.postures["StandInit"])
STEP = 1e-6


def bent(pose: Array, hip: float, knee: float, sway: float) -> Array:
    """Legs (rad) that keep both soles flat and where they are, or nearly so where they sway."""
    pose = pose.copy()
    for side in "LR":
        pose[ROBOT.index[f"{side}HipPitch"]] += hip
        pose[ROBOT.index[f"{side}KneePitch"]] += knee
        pose[ROBOT.index[f"{side}AnklePitch"]] -= hip + knee
        pose[ROBOT.index[f"{side}HipRoll"]] += sway
        pose[ROBOT.index[f"{side}AnkleRoll"]] -= sway
    return pose


@st.composite
def standing(draw: st.DrawFn) -> Array:
    """Poses (26,) with both soles flat, head and arms anywhere."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    anywhere = np.where(ROBOT.joints_of(*LEGS), STAND, random.uniform(ROBOT.lower, ROBOT.upper))
    return bent(anywhere, *(random.uniform(-0.3, 0.0), random.uniform(0.0, 0.6), random.uniform(-0.2, 0.2)))


def slopes(value, pose: Array, put) -> Array:  # type: ignore[no-untyped-def]
    """Central differences of a value of the pose as put, by each joint, last axis."""
    columns = []
    for step in STEP * np.eye(26):
        ends = []
        for changed in (pose + step, pose - step):
            put(changed)
            ends.append(np.array(value()))
        columns.append((ends[0] - ends[1]) / (2.0 * STEP))
    put(pose)
    return np.stack(columns, axis=-1)


def putter(posed: PosedRobot, then):  # type: ignore[no-untyped-def]
    """A function that puts a pose, and calls what must follow."""

    def put(pose: Array) -> None:
        posed.put(posed.map.to_qpos(pose))
        then()

    return put
