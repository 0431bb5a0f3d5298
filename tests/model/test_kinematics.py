"""MJCF, URDF and a product of transforms from facts.json put every link in the same place."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from nao_sim.mujoco_model import JointMap
from nao_sim.paths import MODEL
from nao_sim.robot import facts, load_robot

from .kinematics import all_joints, difference, link_frames

yourdfpy = pytest.importorskip("yourdfpy")
MICRO = 1e-6


@pytest.fixture(scope="module")
def by_table(random_poses: np.ndarray) -> dict[str, np.ndarray]:
    return link_frames(random_poses)


@pytest.fixture(scope="module")
def by_mjcf(alone: mujoco.MjModel, random_poses: np.ndarray) -> dict[str, np.ndarray]:
    names = [alone.body(i).name for i in range(1, alone.nbody)]
    frames = np.tile(np.eye(4), (len(random_poses), len(names), 1, 1))
    data = mujoco.MjData(alone)
    torso = alone.body("torso")
    for frame, qpos in zip(frames, JointMap(alone).to_qpos(random_poses), strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(alone, data)
        frame[:, :3, :3] = data.xmat[1:].reshape(-1, 3, 3)
        frame[:, :3, 3] = data.xpos[1:] - torso.pos
    return dict(zip(names, frames.swapaxes(0, 1), strict=True))


@pytest.fixture(scope="module")
def urdf():
    return yourdfpy.URDF.load(str(MODEL / "nao_h25.urdf"), load_meshes=False, build_collision_scene_graph=False)


@pytest.fixture(scope="module")
def by_urdf(urdf, random_poses: np.ndarray, by_mjcf: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    columns = [load_robot().index[name] for name in urdf.actuated_joint_names]
    frames = {link: np.empty((len(random_poses), 4, 4)) for link in by_mjcf}
    for t, pose in enumerate(random_poses):
        urdf.update_cfg(pose[columns])
        for link, frame in frames.items():
            frame[t] = urdf.get_transform(link, "torso")
    return frames


def test_the_mjcf_puts_every_link_where_the_table_does(by_table, by_mjcf) -> None:
    assert set(by_table) == set(by_mjcf)
    assert np.max([difference(by_table[link], by_mjcf[link]) for link in by_table]) < MICRO


def test_the_urdf_puts_every_link_where_the_mjcf_does(by_mjcf, by_urdf) -> None:
    assert np.max([difference(by_mjcf[link], by_urdf[link]) for link in by_mjcf]) < MICRO


def test_a_micrometre_is_a_sharp_eye(by_table, random_poses: np.ndarray) -> None:
    """The comparison sees a joint that turns by one microradian more."""
    moved = link_frames(random_poses + 2e-6)
    assert min(difference(by_table[j["child"]], moved[j["child"]])[1] for j in facts()["joints"]) > MICRO


def test_the_urdf_has_the_25_motors_and_mimics_for_the_rest(urdf) -> None:
    driven = {j["name"]: (j["driven_by"], j.get("multiplier", 1.0)) for j in all_joints() if "driven_by" in j}
    mimics = {n: (j.mimic.joint, j.mimic.multiplier) for n, j in urdf.joint_map.items() if j.mimic}
    assert mimics == driven
    assert all(urdf.joint_map[name].mimic.offset == 0 for name in mimics)
    assert set(urdf.actuated_joint_names) == {j["name"] for j in all_joints()} - set(driven)


@pytest.mark.parametrize("row", facts()["joints"], ids=lambda row: row["name"])
def test_the_urdf_repeats_limits_torque_and_speed(urdf, row: dict) -> None:
    limit = urdf.joint_map[row["name"]].limit
    assert (limit.lower, limit.upper) == pytest.approx((row["lower"], row["upper"]))
    assert (limit.effort, limit.velocity) == pytest.approx((row["max_torque_Nm"]["v5"], row["no_load_speed"]["v5"]))


@pytest.mark.parametrize("row", facts()["links"], ids=lambda row: row["name"])
def test_the_urdf_repeats_mass_centre_and_inertia(urdf, row: dict) -> None:
    inertial = urdf.link_map[row["name"]].inertial
    turn = inertial.origin[:3, :3]
    xx, yy, zz, xy, xz, yz = row["inertia_about_com_kg_m2"]
    wanted = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    assert inertial.mass == pytest.approx(row["mass_kg"])
    np.testing.assert_allclose(inertial.origin[:3, 3], row["com_m"], atol=1e-9)
    np.testing.assert_allclose(turn @ inertial.inertia @ turn.T, wanted, atol=2e-6 * np.trace(wanted))


@pytest.mark.parametrize("site", ["LArm", "RArm", "LLeg", "CameraTop", "Gyrometer", "LFsrFL", "Sonar_US1_right"])
def test_a_sensor_frame_of_the_urdf_is_where_the_mjcf_has_it(free: mujoco.MjModel, urdf, site: str) -> None:
    element = free.camera(site) if site.startswith("Camera") else free.site(site)
    link = free.body(element.bodyid[0]).name
    frame = urdf.get_transform(f"{site}_frame", link)
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, element.quat)
    np.testing.assert_allclose(frame[:3, 3], element.pos, atol=1e-8)
    np.testing.assert_allclose(frame[:3, :3], turn.reshape(3, 3), atol=1e-8)
