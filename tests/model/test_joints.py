"""Every joint and motor of facts.json is in the model, and nothing else is."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nao_sim.robot import facts

from .conftest import Scene, Start
from .kinematics import all_joints

JOINTS = {joint["name"]: joint for joint in all_joints()}
MOTORS = [joint["name"] for joint in facts()["joints"] if "driven_by" not in joint]
VERSIONS = ("v4", "v5", "v6")


def test_the_model_has_the_joints_of_the_table_a_free_base_and_no_others(free: mujoco.MjModel) -> None:
    names = [free.joint(i).name for i in range(free.njnt)]
    assert sorted(names) == sorted(["root", *JOINTS])
    assert free.joint("root").type == mujoco.mjtJoint.mjJNT_FREE


def test_the_26_joints_come_in_the_order_of_the_table(free: mujoco.MjModel) -> None:
    assert [joint["name"] for joint in facts()["joints"]] == facts()["joint_order"]


@pytest.mark.parametrize("name", JOINTS)
def test_a_joint_sits_and_turns_as_the_table_says(free: mujoco.MjModel, name: str) -> None:
    joint, row = free.joint(name), JOINTS[name]
    body = joint.bodyid[0]
    assert (free.body(body).name, free.body(free.body_parentid[body]).name) == (row["child"], row["parent"])
    assert joint.type == mujoco.mjtJoint.mjJNT_HINGE
    np.testing.assert_allclose(free.body_pos[body], row["origin_m"], atol=1e-9)
    np.testing.assert_allclose(joint.pos, 0.0)
    np.testing.assert_allclose(joint.axis, np.array(row["axis"]) / np.linalg.norm(row["axis"]), atol=1e-9)
    turned = Rotation.from_quat(free.body_quat[body], scalar_first=True) * Rotation.from_euler("xyz", row["rpy"]).inv()
    assert turned.magnitude() < 1e-8


@pytest.mark.parametrize("name", JOINTS)
def test_a_joint_stops_at_the_documented_limits(free: mujoco.MjModel, name: str) -> None:
    joint = free.joint(name)
    assert free.jnt_limited[joint.id]
    np.testing.assert_allclose(joint.range, (JOINTS[name]["lower"], JOINTS[name]["upper"]), atol=1e-9)


@pytest.mark.parametrize("row", [row for row in facts()["joints"] if "lower_deg" in row], ids=lambda row: row["name"])
def test_limits_in_radians_are_those_in_degrees(row: dict) -> None:
    np.testing.assert_allclose(
        np.degrees([row["lower"], row["upper"]]), [row["lower_deg"], row["upper_deg"]], atol=0.02
    )


def test_25_motors_are_named_as_their_joints(free: mujoco.MjModel) -> None:
    assert [free.actuator(i).name for i in range(free.nu)] == MOTORS
    assert len(MOTORS) == 25
    assert [free.joint(free.actuator_trnid[i, 0]).name for i in range(free.nu)] == MOTORS


@pytest.mark.parametrize("version", VERSIONS)
def test_a_motor_pushes_no_harder_than_its_greatest_torque(scene: Scene, version: str) -> None:
    model = scene(version)
    torques = np.array([JOINTS[name]["max_torque_Nm"][version] for name in MOTORS])
    np.testing.assert_allclose(model.actuator_forcerange, np.stack([-torques, torques], axis=1), rtol=1e-3)
    assert model.actuator_forcelimited.all()


def test_a_command_reaches_from_limit_to_limit(free: mujoco.MjModel) -> None:
    limits = [(JOINTS[name]["lower"], JOINTS[name]["upper"]) for name in MOTORS]
    np.testing.assert_allclose(free.actuator_ctrlrange, limits, atol=1e-9)
    assert free.actuator_ctrllimited.all()


def test_driven_joints_follow_their_motor_in_the_documented_ratio(free: mujoco.MjModel) -> None:
    driven = {n: (j["driven_by"], j.get("multiplier", 1.0)) for n, j in JOINTS.items() if "driven_by" in j}
    found = {}
    for equality in range(free.neq):
        assert free.eq_type[equality] == mujoco.mjtEq.mjEQ_JOINT
        follower, driver = free.joint(free.eq_obj1id[equality]).name, free.joint(free.eq_obj2id[equality]).name
        np.testing.assert_allclose(free.eq_data[equality, [0, 2, 3, 4]], 0.0)
        found[follower] = (driver, float(free.eq_data[equality, 1]))
    assert found == driven
    assert len(found) == 17


def test_both_hips_and_all_fingers_follow_in_motion(scene: Scene, started: Start) -> None:
    model = scene("v5", "pinned")
    data = started(model, "StandInit")
    data.actuator("LHipYawPitch").ctrl[0], data.actuator("LHand").ctrl[0] = -0.6, 1.0
    worst = 0.0
    while data.time < 2.0:
        mujoco.mj_step(model, data)
        hips = data.joint("LHipYawPitch").qpos[0] - data.joint("RHipYawPitch").qpos[0]
        finger = data.joint("LFinger13").qpos[0] - 0.999899 * data.joint("LHand").qpos[0]
        worst = max(worst, abs(hips), abs(finger))
    assert data.joint("RHipYawPitch").qpos[0] == pytest.approx(-0.6, abs=np.radians(1.0))
    assert data.joint("LHand").qpos[0] == pytest.approx(1.0, abs=0.02)
    assert worst < np.radians(2.0)
