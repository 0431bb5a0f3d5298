"""The servos: no overshoot, no motor faster than it can turn, the same delay for every joint."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from nao_sim.mujoco_model import JointMap
from nao_sim.robot import Robot, facts, gains, load_robot

from .conftest import Scene

VERSIONS = ("v4", "v5", "v6")
ARM = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw")
STEP = np.radians(30.0)
JOINTS = {joint["name"]: joint for joint in facts()["joints"]}


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", JOINTS)
def test_at_its_no_load_speed_a_motor_has_no_torque_left(version: str, name: str) -> None:
    row = gains(version)[name]
    assert row["damping_cubic"] * JOINTS[name]["no_load_speed"][version] ** 3 > row["force"]


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", JOINTS)
def test_at_the_fastest_command_half_of_the_spare_torque_is_left(version: str, name: str) -> None:
    row = gains(version)[name]
    used = row["damping_cubic"] * row["speed"] ** 3
    assert row["speed"] < JOINTS[name]["no_load_speed"][version]
    assert used <= row["force"] / 2 * 1.01


@pytest.mark.parametrize("version", VERSIONS)
def test_every_joint_follows_with_the_same_delay(version: str) -> None:
    delays = [row["kv"] / row["kp"] for name, row in gains(version).items() if name != "finger"]
    np.testing.assert_allclose(delays, 1 / 30, rtol=1e-3)


@pytest.mark.parametrize("version", VERSIONS)
def test_gains_are_in_the_compiled_model(scene: Scene, version: str) -> None:
    model = scene(version)
    for i in range(model.nu):
        row = gains(version)[model.actuator(i).name]
        assert model.actuator_gainprm[i, 0] == pytest.approx(row["kp"])
        np.testing.assert_allclose(model.actuator_biasprm[i, 1:3], [-row["kp"], -row["kv"]])
    for name in JOINTS:
        dof, row = model.joint(name).dofadr[0], gains(version)[name]
        assert model.dof_armature[dof] == pytest.approx(row["armature"])
        assert model.dof_frictionloss[dof] == 0.0


@pytest.mark.parametrize("version", VERSIONS)
def test_both_sides_have_the_same_servos(version: str) -> None:
    for name, row in gains(version).items():
        if name.startswith("L") and name != "LHipYawPitch":  # that motor turns both legs
            assert gains(version)["R" + name[1:]] == row


def legal_steps(robot: Robot, joint: str) -> list[tuple[float, float]]:
    """Starts and ends of steps of the left joint, up and down, from five places of its range."""
    low, high = robot.lower[robot.index["L" + joint]], robot.upper[robot.index["L" + joint]]
    starts = np.linspace(low, high, 5)
    return [(s, s + d) for s in starts for d in (-STEP, STEP) if low - 1e-9 <= s + d <= high + 1e-9]


def overshoot(model: mujoco.MjModel, robot: Robot, joint: str, start: float, end: float) -> float | None:
    """Greatest way beyond the target, as a share of the step, of both arms; none where an arm touches."""
    joints, data, column = JointMap(model), mujoco.MjData(model), robot.index["L" + joint]
    twin = robot.mirror_of[column]
    poses = np.tile(robot.postures["StandInit"], (2, 1))
    poses[:, column] = start, end
    poses[:, twin] = poses[:, column] * robot.mirror_sign[column]
    data.qpos[:], data.ctrl[:] = joints.to_qpos(poses[0]), joints.to_ctrl(poses[0])
    step(model, data, 0.4)
    data.ctrl[:] = joints.to_ctrl(poses[1])
    beyond = -np.inf
    while data.time < 1.4:
        mujoco.mj_step(model, data)
        if data.ncon:
            return None
        way = (data.qpos[joints.qpos] - poses[0])[[column, twin]] / (poses[1] - poses[0])[[column, twin]]
        beyond = max(beyond, float(way.max()) - 1)
    return beyond


def step(model: mujoco.MjModel, data: mujoco.MjData, seconds: float) -> None:
    until = data.time + seconds
    while data.time < until:
        mujoco.mj_step(model, data)


@pytest.mark.parametrize("version", ["v5", "v6"])
@pytest.mark.parametrize("joint", ARM)
def test_a_step_of_30_degrees_does_not_overshoot(scene: Scene, version: str, joint: str) -> None:
    model, robot = scene(version, "pinned"), load_robot(version)
    found = [overshoot(model, robot, joint, start, end) for start, end in legal_steps(robot, joint)]
    beyond = [x for x in found if x is not None]
    assert len(beyond) >= 3
    assert max(beyond) <= 0.05
    assert min(beyond) >= -0.05  # it arrives, too


def bang_bang(model: mujoco.MjModel, robot: Robot, seed: int, seconds: float, only: str = "") -> np.ndarray:
    """Speeds (T, 26) as shares of no-load speed while motors are thrown from limit to limit at random times."""
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT  # the motors alone drive
    random, joints, data = np.random.default_rng(seed), JointMap(model), mujoco.MjData(model)
    data.qpos[:] = joints.to_qpos(robot.postures["StandInit"])
    data.ctrl[:] = joints.to_ctrl(robot.postures["StandInit"])
    thrown = np.array([only in ("", model.actuator(i).name) for i in range(model.nu)])
    wait = np.zeros(model.nu)
    speeds = np.empty((round(seconds / model.opt.timestep), 26))
    for row in speeds:
        wait -= model.opt.timestep
        now = thrown & (wait <= 0)
        data.ctrl[now] = model.actuator_ctrlrange[now, random.integers(0, 2, now.sum())]
        wait[now] = random.uniform(0.05, 1.0, now.sum())
        mujoco.mj_step(model, data)
        row[:] = np.abs(data.qvel[joints.dofs]) / robot.no_load_speed
    assert data.warning.number.sum() == 0
    return speeds


@pytest.mark.parametrize("version", ["v5", "v6"])
def test_alone_no_motor_reaches_its_no_load_speed(scene: Scene, version: str) -> None:
    model, robot = scene(version, "pinned"), load_robot(version)
    names = [model.actuator(i).name for i in range(model.nu)]
    fastest = {name: bang_bang(model, robot, i, 3.0, name)[:, robot.index[name]].max() for i, name in enumerate(names)}
    assert max(fastest.values()) < 0.97
    assert min(fastest.values()) > 0.5  # and none is held back


@pytest.mark.parametrize("version", ["v5", "v6"])
def test_under_any_command_no_joint_passes_its_no_load_speed_by_more_than_2_percent(scene: Scene, version: str) -> None:
    model, robot = scene(version, "pinned"), load_robot(version)
    speeds = np.concatenate([bang_bang(model, robot, seed, 20.0) for seed in range(4)])
    assert speeds.max() <= 1.02
