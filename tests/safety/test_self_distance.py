"""Distances between the robot's own parts."""

from __future__ import annotations

import mujoco
import pytest
from hypothesis import given

from nao_sim.mujoco_model import JointMap, robot_alone
from nao_sim.robot import load_robot
from nao_sim.safety.posed import hand_of_finger
from nao_sim.safety.self_distance import HORIZON, SelfDistance
from tests.motions import poses
from tests.safety.shape_pairs import shape_pairs

DISTANCE, SHORT = SelfDistance(), SelfDistance(0.008)


@given(poses())
def test_the_mirrored_pose_is_as_near(pose):
    robot = load_robot()
    assert DISTANCE.nearest(robot.mirror(pose)).distance == pytest.approx(DISTANCE.nearest(pose).distance, abs=1e-6)


@given(poses())
def test_the_nearest_pair_is_the_smallest_of_all_pairs(pose):
    pairs = list(DISTANCE.pairs(pose, HORIZON))
    nearest = DISTANCE.nearest(pose)
    assert nearest.distance == min([pair.distance for pair in pairs], default=HORIZON)
    assert all(len(set(pair.links)) == 2 for pair in pairs)


@given(poses())
def test_a_shorter_horizon_sees_the_same_near_pairs(pose):
    near = {(pair.links, round(pair.distance, 7)) for pair in DISTANCE.pairs(pose, 0.008)}
    assert near == {(pair.links, round(pair.distance, 7)) for pair in SHORT.pairs(pose, 0.008)}


@given(poses())
def test_no_pair_is_missed(pose):
    """Each pair of shapes that may touch, asked for its distance one by one."""
    seen = {}
    for pair in DISTANCE.pairs(pose, HORIZON):
        seen[frozenset(pair.links)] = min(pair.distance, seen.get(frozenset(pair.links), HORIZON))
    asked = brute_force(pose)
    for links in asked.keys() | seen.keys():
        assert asked.get(links, HORIZON) == pytest.approx(seen.get(links, HORIZON), abs=1e-4)


def brute_force(pose):
    """Smallest distance of each pair of links nearer than the horizon."""
    DATA.qpos[:] = JointMap(MODEL).to_qpos(pose)
    mujoco.mj_kinematics(MODEL, DATA)
    found = {}
    for first, second in PAIRS:
        distance = mujoco.mj_geomDistance(MODEL, DATA, first, second, HORIZON, None)
        if distance < HORIZON:
            bodies = MODEL.geom_bodyid[[first, second]]
            links = frozenset(hand_of_finger(MODEL.body(body).name) for body in bodies)
            found[links] = min(distance, found.get(links, HORIZON))
    return found


MODEL = robot_alone()
DATA = mujoco.MjData(MODEL)
PAIRS = list(shape_pairs(MODEL))


def test_vendor_postures_are_clear(robot):
    for name, posture in robot.postures.items():
        assert DISTANCE.nearest(posture).distance > 0.004, name


def test_a_hand_in_the_face_is_found(robot):
    pose = robot.postures["StandInit"].copy()
    pose[robot.index["LShoulderPitch"]] = -0.9
    pose[robot.index["LShoulderRoll"]] = -0.3
    pose[robot.index["LElbowYaw"]] = -0.3
    pose[robot.index["LElbowRoll"]] = -1.2
    nearest = DISTANCE.nearest(pose)
    assert nearest.distance < 0
    assert set(nearest.links) == {"Head", "l_wrist"}
