"""Sensors are where facts.json says, and read what they should."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nao_sim.paths import MODEL
from nao_sim.robot import facts, load_robot

from .conftest import Scene, Start

SENSORS, FOOT = facts()["sensors"], facts()["foot"]
SONARS = {name: row for name, row in SENSORS["sonar"].items() if isinstance(row, dict)}
TOUCH = {
    name.replace("/", "_"): row
    for name, row in {**SENSORS["touch"], **facts()["hand"]["touch"], **FOOT["bumpers"]}.items()
}
FRAMES = {**SENSORS["imu"], **SENSORS["infrared"], **SENSORS["microphones"]} | TOUCH
G = 9.81


@pytest.fixture(scope="module")
def at_rest(scene: Scene, started: Start) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Standing still in StandInit for three seconds."""
    model = scene()
    data = started(model, "StandInit")
    while data.time < 3.0:
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    return model, data


@pytest.mark.parametrize("name", FRAMES)
def test_a_site_is_on_its_link_at_the_documented_pose(free: mujoco.MjModel, name: str) -> None:
    site, row = free.site(name), FRAMES[name]
    assert free.body(site.bodyid[0]).name == row["link"]
    np.testing.assert_allclose(site.pos, row["xyz_m"], atol=1e-9)
    turn = Rotation.from_euler("xyz", row.get("rpy_rad", (0, 0, 0)))
    assert (Rotation.from_quat(site.quat, scalar_first=True) * turn.inv()).magnitude() < 1e-7


@pytest.mark.parametrize("name", FOOT["fsr_m"])
def test_a_force_sensor_is_in_the_sole(free: mujoco.MjModel, name: str) -> None:
    site = free.site(name)
    assert free.body(site.bodyid[0]).name == {"L": "l_ankle", "R": "r_ankle"}[name[0]]
    np.testing.assert_allclose(site.pos, [*FOOT["fsr_m"][name], -facts()["foot_height_m"]], atol=1e-9)


@pytest.mark.parametrize("name", SENSORS["cameras"])
@pytest.mark.parametrize("version", ["v4", "v5", "v6"])
def test_a_camera_sits_and_sees_as_documented(scene: Scene, version: str, name: str) -> None:
    camera, row = scene(version).camera(name), SENSORS["cameras"][name]
    np.testing.assert_allclose(camera.pos, row["xyz_m"], atol=1e-9)
    assert camera.fovy[0] == facts()["versions"][version]["camera_fov_deg"]["vertical"]


def camera_axes(model: mujoco.MjModel, name: str) -> np.ndarray:
    """Columns: right, up, against the view, in the torso's frame at the zero pose."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    return data.camera(name).xmat.reshape(3, 3)


@pytest.mark.parametrize("name", SENSORS["cameras"])
def test_a_camera_looks_forward_and_down_by_the_documented_angle(free: mujoco.MjModel, name: str) -> None:
    right, up, back = camera_axes(free, name).T
    np.testing.assert_allclose(right, [0, -1, 0], atol=1e-9)
    assert np.degrees(np.arctan2(back[2], -back[0])) == pytest.approx(SENSORS["cameras"][name]["pitch_deg"], abs=0.01)
    assert up[2] > 0.7


def test_both_feet_together_feel_the_weight(at_rest: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    model, data = at_rest
    felt = sum(data.sensor(name).data[0] for name in FOOT["fsr_m"])
    assert felt == pytest.approx(G * model.body("torso").subtreemass[0], rel=0.02)


def test_a_robot_that_stands_symmetrically_loads_both_feet_alike(at_rest: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    _, data = at_rest
    feet = [sum(data.sensor(name).data[0] for name in FOOT["fsr_m"] if name[0] == side) for side in "LR"]
    assert feet[0] == pytest.approx(feet[1], rel=0.02)
    assert all(data.sensor(name).data[0] > 1.0 for name in FOOT["fsr_m"])


def test_leaning_loads_the_force_sensors_on_that_side(scene: Scene, started: Start) -> None:
    model = scene()
    data = started(model, "StandInit")
    data.actuator("LAnkleRoll").ctrl[0] = data.actuator("RAnkleRoll").ctrl[0] = -0.05
    while data.time < 2.0:
        mujoco.mj_step(model, data)
    left, right = (sum(data.sensor(name).data[0] for name in FOOT["fsr_m"] if name[0] == side) for side in "LR")
    assert abs(left - right) > 3.0
    assert np.sign(left - right) == np.sign(data.subtree_com[0, 1] - feet_middle(data))


def feet_middle(data: mujoco.MjData) -> float:
    return float(data.geom("left_sole").xpos[1] + data.geom("right_sole").xpos[1]) / 2


def test_at_rest_the_gyrometer_reads_nothing(at_rest: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    assert np.abs(at_rest[1].sensor("Gyrometer").data).max() < 1e-3


def test_at_rest_the_accelerometer_reads_gravity_upward_in_the_leaning_torso(
    at_rest: tuple[mujoco.MjModel, mujoco.MjData],
) -> None:
    _, data = at_rest
    turn = data.body("torso").xmat.reshape(3, 3)
    lean = np.arctan2(turn[0, 2], turn[2, 2])
    np.testing.assert_allclose(data.sensor("Accelerometer").data, [-G * np.sin(lean), 0, G * np.cos(lean)], atol=0.02)
    assert np.degrees(lean) == pytest.approx(5.95, abs=0.5)


def test_turning_about_the_vertical_is_read_by_the_gyrometer(scene: Scene, started: Start) -> None:
    model = scene()
    data = started(model, "StandZero")
    data.qvel[3:6] = 0.1, 0.2, 0.3  # a free joint turns in its own frame
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.sensor("Gyrometer").data, [0.1, 0.2, 0.3], atol=1e-9)


@pytest.mark.parametrize("name", SONARS)
def test_a_sonar_looks_forward_as_documented(free: mujoco.MjModel, name: str) -> None:
    site, row = free.site(f"Sonar_{name}"), SONARS[name]
    ray = Rotation.from_quat(site.quat, scalar_first=True).apply([0, 0, 1])
    np.testing.assert_allclose(site.pos, row["xyz_m"], atol=1e-9)
    np.testing.assert_allclose(ray, Rotation.from_euler("xyz", row["rpy_rad"]).apply([1, 0, 0]), atol=1e-7)
    assert ray[0] > 0.85
    assert np.sign(ray[1]) == np.sign(row["xyz_m"][1])


def test_a_sonar_that_looks_down_measures_the_floor(at_rest: tuple[mujoco.MjModel, mujoco.MjData]) -> None:
    _, data = at_rest
    site = data.site("Sonar_US4_left")
    ray = site.xmat.reshape(3, 3)[:, 2]
    assert data.sensor("Sonar_US4_left").data[0] == pytest.approx(-site.xpos[2] / ray[2], abs=1e-6)


def test_joint_sensors_read_positions_and_speeds(scene: Scene, started: Start) -> None:
    model, random = scene(), np.random.default_rng(0)
    data = started(model, "Stand")
    data.qpos[7:] += random.normal(0, 0.1, model.nq - 7)
    data.qvel[:] = random.normal(0, 1, model.nv)
    mujoco.mj_forward(model, data)
    for name in load_robot().joint_names:
        assert data.sensor(f"{name}_pos").data[0] == data.joint(name).qpos[0]
        assert data.sensor(f"{name}_vel").data[0] == data.joint(name).qvel[0]


@pytest.fixture(scope="module")
def probed() -> mujoco.MjModel:
    """The robot, weightless, and a ball of 4 mm, a finger to press its sensors with."""
    spec = mujoco.MjSpec.from_file(str(MODEL / "nao_h25.xml"))
    body = spec.worldbody.add_body(name="probe", mocap=True)
    body.add_geom(name="probe", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.004, 0, 0])
    spec.option.gravity = [0, 0, 0]
    return spec.compile()


def press(model: mujoco.MjModel, sensor: str, depth: float) -> float:
    """What a touch sensor reads when the ball comes from outside, along its x axis, and sinks in by `depth`."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("StandZero").id)
    for way in np.arange(0.04, -0.01, -0.0002):
        mujoco.mj_kinematics(model, data)
        site = data.site(sensor)
        data.mocap_pos[0] = site.xpos + way * site.xmat.reshape(3, 3)[:, 0]
        mujoco.mj_forward(model, data)
        if data.ncon and data.contact.dist.min() < -depth:
            return float(data.sensor(sensor).data[0])
    return 0.0


@pytest.mark.parametrize("name", TOUCH)
def test_a_finger_that_presses_on_a_touch_sensor_is_felt(probed: mujoco.MjModel, name: str) -> None:
    assert press(probed, name, 0.001) > 0
