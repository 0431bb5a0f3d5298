"""The guard's promises on commands; the simulated joints are in tests/properties."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.guard import CLEARANCE, Guard
from nao_sim.safety.limits import coupling_excess
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.safety.speed import speed_limits
from tests.motions import poses, wild_motions

DT = 0.02


def _start():
    return load_robot().postures["StandInit"]


def _run(requests, legs_free=False, legs_together=False):
    guard = Guard(load_robot(), _start(), legs_free, legs_together)
    steps = [guard.step(request, DT) for request in requests]
    return np.array([command for command, _ in steps]), [changes for _, changes in steps]


@settings(max_examples=25)
@given(wild_motions(seconds=2.0), st.booleans())
def test_whatever_is_asked_every_command_keeps_every_rule(motion, legs_together):
    robot, distance = load_robot(), SelfDistance()
    commands, _ = _run(motion.sample(np.arange(0, 2, DT)), legs_free=True, legs_together=legs_together)
    assert np.isfinite(commands).all()
    assert (commands >= robot.lower - 1e-9).all()
    assert (commands <= robot.upper + 1e-9).all()
    speeds = np.diff(np.concatenate([[_start()], commands]), axis=0) / DT
    assert (np.abs(speeds) <= speed_limits(robot) + 1e-9).all()
    accelerations = np.diff(np.concatenate([np.zeros((1, 26)), speeds]), axis=0) / DT
    assert (np.abs(accelerations) <= robot.max_acceleration * (1 + 1e-6) + 1e-6).all()
    for coupling in robot.couplings:
        assert coupling_excess(coupling, commands).max() < 1e-5
    assert min(distance.nearest(command).distance for command in commands) >= CLEARANCE - 1e-6


@settings(max_examples=20)
@given(wild_motions(seconds=2.0))
def test_guarding_twice_changes_nothing_more(motion):
    once, _ = _run(motion.sample(np.arange(0, 2, DT)))
    twice, _ = _run(once)
    assert np.abs(twice - once).max() < 1e-6


@settings(max_examples=15)
@given(wild_motions(seconds=2.0))
def test_the_mirrored_request_gives_the_mirrored_command(motion):
    robot = load_robot()
    requests = motion.sample(np.arange(0, 2, DT))
    plain, _ = _run(requests)
    mirrored, _ = _run(robot.mirror(requests))
    assert np.degrees(np.abs(robot.mirror(mirrored) - plain).max()) < 0.5


@settings(max_examples=20)
@given(poses())
def test_a_safe_pose_in_the_open_is_reached(pose):
    """Arms spread sideways and any way from there have nothing between them."""
    robot = load_robot()
    target = _start().copy()
    arms = np.concatenate([robot.limbs["LArm"], robot.limbs["RArm"]])
    target[arms] = pose[arms]
    for side, sign in (("L", 1), ("R", -1)):
        target[robot.index[f"{side}ShoulderRoll"]] = sign * 1.2
        target[robot.index[f"{side}ElbowRoll"]] = -sign * 0.3
        target[robot.index[f"{side}Hand"]] = 0.5
    spread = _start().copy()
    for side, sign in (("L", 1), ("R", -1)):
        spread[robot.index[f"{side}ShoulderRoll"]] = sign * 1.2
        spread[robot.index[f"{side}ElbowRoll"]] = -sign * 0.3
    target[arms] = np.clip(target[arms], robot.lower[arms] + 0.02, robot.upper[arms] - 0.02)
    commands, _ = _run([spread] * 60 + [target] * 150)
    assert np.abs(commands[-1] - target).max() < 1e-6


def test_a_hand_that_pushed_into_the_chest_may_leave_again(robot):
    inside = _start().copy()
    for side, sign in (("L", 1), ("R", -1)):
        inside[robot.index[f"{side}ShoulderPitch"]] = 0.6
        inside[robot.index[f"{side}ShoulderRoll"]] = -sign * 0.3
        inside[robot.index[f"{side}ElbowYaw"]] = -sign * 0.5
        inside[robot.index[f"{side}ElbowRoll"]] = -sign * 1.5
    commands, changes = _run([inside] * 150 + [_start()] * 200)
    assert any(change.reason == "self_collision" for step in changes for change in step)
    assert np.abs(commands[149] - inside).max() > 0.05
    assert np.abs(commands[-1] - _start()).max() < 1e-6


def test_the_head_waits_for_its_pitch_and_then_gets_where_it_is_asked(robot):
    yaw, pitch = robot.index["HeadYaw"], robot.index["HeadPitch"]
    down, side = _start().copy(), _start().copy()
    down[pitch] = robot.upper[pitch]
    side[pitch], side[yaw] = robot.upper[pitch], 1.9
    commands, changes = _run([down] * 60 + [side] * 150)
    assert commands[-1, yaw] == pytest.approx(1.9, abs=1e-6)
    assert commands[-1, pitch] < robot.upper[pitch] - 0.1
    assert any(change.reason == "coupling" for step in changes for change in step)


def test_what_is_not_a_number_asks_nothing_new(robot):
    arm = robot.index["LShoulderPitch"]
    up = _start().copy()
    up[arm] = 0.5
    broken = np.full(26, np.nan)
    broken[robot.index["RShoulderPitch"]] = np.inf
    commands, _ = _run([up] * 50 + [broken] * 50)
    assert commands[-1, arm] == pytest.approx(0.5)
    assert np.isfinite(commands).all()


def test_free_standing_legs_keep_their_posture_and_the_report_says_so(robot):
    squat = _start().copy()
    squat[robot.index["LKneePitch"]] = 1.8
    commands, changes = _run([squat] * 50)
    assert np.array_equal(commands[-1], _start())
    assert {change.reason for step in changes for change in step} == {"legs_hold"}
    knee = next(change for change in changes[0] if change.reason == "legs_hold")
    assert np.flatnonzero(knee.size).tolist() == [robot.index["LKneePitch"]]


def test_one_motor_turns_both_hips(robot):
    left, right = robot.index["LHipYawPitch"], robot.index["RHipYawPitch"]
    apart = _start().copy()
    apart[left], apart[right] = -0.3, 0.2
    commands, changes = _run([apart] * 100, legs_free=True)
    assert np.array_equal(commands[:, left], commands[:, right])
    assert commands[-1, left] == pytest.approx(-0.3)
    assert any(change.reason == "one_motor" for change in changes[-1])


def test_a_safe_motion_passes_unchanged():
    from nao_sim.paths import TRAJECTORIES
    from nao_sim.recordings import load
    from nao_sim.simulation.performance import timeline

    for name in ("wave", "greeting", "arm_circles", "gesture_side", "gesture_up"):
        _, requests = timeline(load(TRAJECTORIES / f"{name}.csv").motion, _start())
        commands, changes = _run(requests)
        asked = np.isfinite(requests)
        assert np.abs((commands - requests)[asked]).max() < 1e-6, name
        assert not any(changes), name


def _squat():
    """A deep squat on flat feet, and the indices of the legs."""
    robot = load_robot()
    pose = _start().copy()
    for side in "LR":
        for name, angle in (("HipPitch", -1.0), ("KneePitch", 1.9), ("AnklePitch", -1.0)):
            pose[robot.index[side + name]] = angle
    return pose, np.concatenate([robot.limbs["LLeg"], robot.limbs["RLeg"]])


def test_legs_that_move_together_all_have_the_same_share_of_their_way_behind_them():
    target, legs = _squat()
    commands, _ = _run([target] * 100, legs_free=True, legs_together=True)
    way = (target - _start())[legs]
    shares = (commands - _start())[:, legs][:, way != 0.0] / way[way != 0.0]
    assert np.ptp(shares, axis=1).max() < 0.02
    assert shares[-1] == pytest.approx(1.0, abs=1e-3)
    alone, _ = _run([target] * 100, legs_free=True)
    shares = (alone - _start())[:, legs][:, way != 0.0] / way[way != 0.0]
    assert np.ptp(shares, axis=1).max() > 0.05


def test_an_arm_in_the_way_of_one_leg_stops_both_where_they_move_together():
    robot = load_robot()
    target, legs = _squat()
    for name, angle in (("ShoulderPitch", 0.7), ("ShoulderRoll", 0.1), ("ElbowYaw", 0.9), ("ElbowRoll", -0.8)):
        target[robot.index["L" + name]] = angle  # the hand is where the thigh goes
    arm_first = target.copy()
    arm_first[legs] = _start()[legs]
    for together in (True, False):
        commands, changes = _run([arm_first] * 100 + [target] * 150, legs_free=True, legs_together=together)
        assert {"l_wrist", "LThigh"} in [set(change.links) for step in changes for change in step]
        apart = np.abs(commands - robot.mirror(commands))[:, robot.limbs["LLeg"]].max()
        assert apart < 1e-9 if together else apart > 0.5
