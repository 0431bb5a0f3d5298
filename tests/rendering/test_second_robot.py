"""A second robot in the film is where it should be, in the posture that it should have."""

import numpy as np
import pytest

from nao_sim.mujoco_model import JointMap
from nao_sim.rendering.presets import load_second
from nao_sim.rendering.second_robot import NAME, add_second, second_poses
from nao_sim.robot import load_robot
from nao_sim.simulation.scene import compile_scene, compiled, compose


@pytest.mark.parametrize(("version", "base"), [("v5", "free"), ("v6", "pinned")])
def test_the_second_robot_is_the_first_one_moved_aside(version, base):
    import mujoco

    robot, alone = load_robot(version), compile_scene(version, base)
    scene = compose(version, base)
    add_second(scene, compose(version, base))
    model = compiled(scene)
    posture = (robot.lower + 0.3 * (robot.upper - robot.lower))[None]
    map_ = JointMap(alone)
    pose = map_.to_qpos(posture, np.array([[0.1, 0.0, 0.33, 1.0, 0.0, 0.0, 0.0]]))
    data = mujoco.MjData(model)
    torso = mujoco.MjData(alone)
    torso.qpos[:] = pose[0]
    mujoco.mj_kinematics(alone, torso)
    base_pose = np.concatenate([torso.body("torso").xpos, torso.body("torso").xquat])[None]
    data.qpos[:] = np.hstack([pose, second_poses(pose[:, 7 if map_.free else 0 :], base_pose)])[0]
    mujoco.mj_kinematics(model, data)
    for body in ("Head", "LForeArm", "r_wrist", "LFoot"):
        if body in [alone.body(i).name for i in range(alone.nbody)]:
            moved = data.body(f"{NAME}/{body}").xpos - data.body(body).xpos
            np.testing.assert_allclose(moved, [*load_second().place, 0.0], atol=1e-9)
    assert sum(model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE) == 1
