"""The composed scene."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from nao_sim.mujoco_model import JointMap
from nao_sim.rendering.presets import camera_names, load_camera
from nao_sim.robot import VERSIONS, facts, load_robot
from nao_sim.simulation.scene import compile_scene


@pytest.fixture(scope="module", params=VERSIONS)
def version(request):
    return request.param


@pytest.fixture(scope="module")
def model(version):
    return compile_scene(version)


def test_each_version_has_its_documented_mass(model, version):
    assert model.body_mass.sum() == pytest.approx(facts()["versions"][version]["total_mass_kg"], abs=1e-3)


def test_each_version_has_its_motors(model, version):
    robot = load_robot(version)
    for i in range(model.nu):
        joint = robot.index[model.actuator(i).name]
        assert model.actuator_forcerange[i] == pytest.approx(
            [-robot.max_torque[joint], robot.max_torque[joint]], rel=1e-3
        )


def test_each_version_has_its_cameras(model, version):
    fov = facts()["versions"][version]["camera_fov_deg"]["vertical"]
    assert model.cam("CameraTop").fovy[0] == pytest.approx(fov)
    assert model.cam("CameraBottom").fovy[0] == pytest.approx(fov)


def test_the_scenes_cameras_are_the_presets():
    model = compile_scene()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for name in camera_names():
        preset = load_camera(name)
        if preset.stands:
            camera = model.cam(name).id
            ahead = -data.cam_xmat[camera].reshape(3, 3)[:, 2]
            assert data.cam_xpos[camera] + preset.distance * ahead == pytest.approx(preset.lookat, abs=1e-3), name
            assert model.cam_fovy[camera] == preset.fovy_deg


def test_a_pinned_robot_has_no_base_joint_and_room_under_its_toes(robot):
    model = compile_scene(base="pinned")
    data = mujoco.MjData(model)
    assert not JointMap(model).free
    pose = np.zeros(26)
    for side in "LR":
        pose[robot.index[f"{side}AnklePitch"]] = robot.upper[robot.index[f"{side}AnklePitch"]]
    data.qpos[:] = JointMap(model).to_qpos(pose)
    mujoco.mj_forward(model, data)
    floor = model.geom("floor").id
    assert floor not in data.contact.geom[data.contact.dist < 0]
