"""Legs over planted feet, against the kinematics of the facts table and the model's masses."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.imitation.legs import (
    FEET,
    HIP_YAW_PITCH,
    LEG_JOINTS,
    TWIST,
    hip_centre,
    leg_positions,
    lowest_hip_pitch,
    stance_of,
    torso_turn,
)
from nao_sim.imitation.mass import centre_of_mass, link_frames, masses
from nao_sim.mujoco_model import JointMap
from nao_sim.robot import VERSIONS, load_robot
from nao_sim.safety.self_collision import CLEARANCE
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.simulation.scene import compile_scene
from tests.model.kinematics import link_frames as facts_frames

ROBOT = load_robot()
START = ROBOT.postures["StandInit"]
STANCE = stance_of(START, ROBOT)
JOINTS = np.array([[ROBOT.index[letter + name] for name in LEG_JOINTS] for letter in "LR"])
MIRROR = np.diag([1.0, -1.0, 1.0])


def leans(seed, count=50):
    """Places of the hips and turns of the torso that legs reach."""
    random = np.random.default_rng(seed)
    hips = random.uniform((-0.04, -0.04, 0.12), (0.04, 0.04, 0.185), (count, 3))
    return hips, torso_turn(random.uniform(-0.4, 0.9, count), random.uniform(-0.25, 0.25, count))


def pose(legs):
    positions = np.tile(START, (len(legs), 1))
    positions[:, JOINTS.ravel()] = legs.reshape(len(legs), 12)
    return positions


def test_the_start_posture_is_found_again():
    legs, torso = leg_positions(STANCE.hips[None], STANCE.torso[None], STANCE)
    np.testing.assert_allclose(pose(legs)[0], START, atol=1e-12)
    np.testing.assert_allclose(torso[0], STANCE.torso, atol=1e-12)


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_the_feet_stay_where_they_are(seed):
    hips, turn = leans(seed)
    legs, torso = leg_positions(hips, turn, STANCE)
    known = np.isfinite(legs).all(axis=(1, 2))
    assert known.mean() > 0.5
    frames = facts_frames(pose(legs[known]))
    for side, foot in enumerate(FEET):
        turned = torso[known] @ frames[foot][:, :3, :3]
        place = hips[known] + np.einsum("tij,tj->ti", torso[known], frames[foot][:, :3, 3] - hip_centre())
        np.testing.assert_allclose(turned, np.broadcast_to(STANCE.feet[side], turned.shape), atol=1e-6)
        np.testing.assert_allclose(place, np.broadcast_to(STANCE.ankles[side], place.shape), atol=1e-6)


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_one_motor_turns_both_hips_and_the_torso_leans_as_told(seed):
    hips, turn = leans(seed)
    legs, torso = leg_positions(hips, turn, STANCE)
    known = np.isfinite(legs).all(axis=(1, 2))
    np.testing.assert_array_equal(legs[known, 0, HIP_YAW_PITCH], legs[known, 1, HIP_YAW_PITCH])
    np.testing.assert_allclose(torso[:, 2], turn[:, 2], atol=1e-12)  # the vertical, seen from the torso


@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1))
def test_the_mirrored_lean_takes_the_mirrored_legs(seed):
    hips, turn = leans(seed)
    plain, _ = leg_positions(hips, turn, STANCE)
    mirrored, _ = leg_positions(hips @ MIRROR, MIRROR @ turn @ MIRROR, STANCE)
    np.testing.assert_allclose(ROBOT.mirror(pose(mirrored)), pose(plain), atol=1e-9)


def test_out_of_reach_there_is_no_answer():
    legs, _ = leg_positions(np.array([[0.0, 0.0, 0.25], STANCE.hips]), np.tile(STANCE.torso, (2, 1, 1)), STANCE)
    assert np.isnan(legs[0]).all() and np.isfinite(legs[1]).all()


@pytest.mark.parametrize("version", VERSIONS)
def test_the_centre_of_mass_is_the_models(version):
    robot = load_robot(version)
    model = compile_scene(version)
    data, joints = mujoco.MjData(model), JointMap(model)
    poses = np.random.default_rng(0).uniform(robot.lower, robot.upper, (20, 26))
    above, below = masses(robot)
    parts = centre_of_mass(poses, robot, legs=False) * above, centre_of_mass(poses, robot, legs=True) * below
    assert above + below == pytest.approx(model.body_mass.sum(), abs=1e-3)  # the fingers' 2 mg
    for found, qpos in zip(sum(parts) / (above + below), joints.to_qpos(poses), strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        np.testing.assert_allclose(found, data.subtree_com[1], atol=3e-4)  # V6's head is 1.5 mm off the middle


def test_the_mirrored_pose_has_the_mirrored_centre_of_mass():
    poses = np.random.default_rng(1).uniform(ROBOT.lower, ROBOT.upper, (20, 26))
    for version in VERSIONS:
        robot = load_robot(version)
        for legs in (False, True):
            plain = centre_of_mass(poses, robot, legs)
            np.testing.assert_allclose(centre_of_mass(robot.mirror(poses), robot, legs), plain @ MIRROR, atol=1e-15)


def test_frames_are_those_of_the_facts_table():
    poses = np.random.default_rng(2).uniform(ROBOT.lower, ROBOT.upper, (20, 26))
    expected = facts_frames(poses)
    for name, (turn, place) in link_frames(poses, ROBOT, frozenset(["Head", "l_wrist", "r_ankle"])).items():
        np.testing.assert_allclose(turn, expected[name][:, :3, :3], atol=1e-8)
        np.testing.assert_allclose(place, expected[name][:, :3, 3], atol=1e-8)


@settings(max_examples=25)
@given(st.floats(-0.25, 0.78), st.floats(0.0, 1.0), st.floats(-TWIST, TWIST))  # farther inward the guard decides
def test_a_hip_bent_as_far_as_it_may_leaves_room_between_thigh_and_torso(roll, more, twist):
    lowest = float(lowest_hip_pitch(np.array(roll)))
    positions = START.copy()
    for letter, sign in (("L", 1.0), ("R", -1.0)):
        positions[ROBOT.index[f"{letter}HipYawPitch"]] = twist
        positions[ROBOT.index[f"{letter}HipRoll"]] = sign * roll
        positions[ROBOT.index[f"{letter}HipPitch"]] = lowest + more * (0.4 - lowest)
    near = [pair.distance for pair in SelfDistance().pairs(positions, 0.03) if "torso" in pair.links]
    assert min(near, default=1.0) >= CLEARANCE - 1e-4
