"""The robot compiled once a session, and the little that all tests of the model say."""

from __future__ import annotations

import copy
from collections.abc import Callable
from functools import cache

import mujoco
import numpy as np
import pytest

from nao_sim.mujoco_model import JointMap, robot_alone
from nao_sim.paths import MODEL
from nao_sim.robot import load_robot
from nao_sim.simulation.scene import Base, compile_scene

Scene = Callable[..., mujoco.MjModel]
Start = Callable[[mujoco.MjModel, str], mujoco.MjData]
cached_scene = cache(compile_scene)


@pytest.fixture(scope="session")
def scene() -> Scene:
    """A compiled scene by version and base: a copy that the test may change."""

    def get(version: str = "v5", base: Base = "free") -> mujoco.MjModel:
        return copy.copy(cached_scene(version, base))

    return get


@pytest.fixture(scope="session")
def free() -> mujoco.MjModel:
    """The V5 scene, for tests that only read it."""
    return cached_scene("v5", "free")


@pytest.fixture(scope="session")
def alone() -> mujoco.MjModel:
    """The robot's collision shapes, its torso fixed, every contact rule in force."""
    return robot_alone()


@pytest.fixture(scope="session")
def bare() -> mujoco.MjModel:
    """The same shapes with no pair of links exempt: no exclusions, parents may touch children."""
    spec = mujoco.MjSpec.from_file(str(MODEL / "nao_h25.xml"))
    for part in [*spec.keys, *spec.excludes, *(g for g in spec.geoms if g.type == mujoco.mjtGeom.mjGEOM_MESH)]:
        spec.delete(part)
    for mesh in list(spec.meshes):
        spec.delete(mesh)
    spec.delete(spec.joint("root"))
    model = spec.compile()
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_FILTERPARENT
    return model


@pytest.fixture(scope="session")
def random_poses() -> np.ndarray:
    """(1000, 26) anywhere in the joints' ranges, both HipYawPitch as their one motor turns them."""
    robot = load_robot()
    poses = np.random.default_rng(0).uniform(robot.lower, robot.upper, (1000, 26))
    poses[:, robot.index["RHipYawPitch"]] = poses[:, robot.index["LHipYawPitch"]]
    return poses


@pytest.fixture(scope="session")
def started() -> Start:
    """A vendor posture at rest, held by the servos: on the floor where the base is free, in the air where not."""

    def start(model: mujoco.MjModel, posture: str) -> mujoco.MjData:
        data, joints = mujoco.MjData(model), JointMap(model)
        if joints.free:
            mujoco.mj_resetDataKeyframe(model, data, model.key(posture).id)
        else:
            data.qpos[:] = joints.to_qpos(load_robot().postures[posture])
            data.ctrl[:] = joints.to_ctrl(load_robot().postures[posture])
        return data

    return start
