"""The measures of how good a recording is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim import body, health
from nao_sim.imitation.filters import clean
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import load_robot
from tests.people import person
from tests.tracking import JOINTS, one_track, spoiled, tracked

ROBOT = load_robot()


def joint_health(skeleton: Skeleton) -> dict[str, health.JointHealth]:
    return {each.joint: each for each in health.joint_health(skeleton, clean(skeleton, smooth=None)[0])}


def test_the_clock_of_even_frames() -> None:
    clock = health.clock(person(61, joints=JOINTS))
    assert (clock.frames, clock.gaps, clock.repeated) == (61, 0, 0)
    assert clock.duration == pytest.approx(2.0) and clock.rate == pytest.approx(30.0)
    assert clock.unevenness == pytest.approx(0.0, abs=1e-9) and clock.longest == pytest.approx(1 / 30)


def test_pauses_and_uneven_frames_are_told_apart() -> None:
    random = np.random.default_rng(0)
    intervals = random.normal(1 / 30, 0.1 / 30, 300)
    intervals[[50, 90]] = 0.1, 0.4
    clock = health.clock(one_track(np.cumsum(intervals), random.normal(size=300)))
    assert clock.gaps == 2 and clock.longest == pytest.approx(0.4)
    assert clock.rate == pytest.approx(30.0, rel=0.02) and clock.unevenness == pytest.approx(0.1, rel=0.2)


def test_a_single_frame_has_no_rate() -> None:
    assert health.clock(person(1, joints=JOINTS)) == health.Clock(1, 0.0, None, None, 0, None, 0)


def test_frames_that_repeat_the_one_before_are_counted_but_not_empty_ones() -> None:
    track = np.arange(10.0)
    track[4:6] = track[3]
    track[8:] = np.nan
    assert health.clock(one_track(np.arange(10) / 30, track)).repeated == 2


def test_dropouts_are_counted_with_the_longest() -> None:
    track = np.zeros(30)
    track[[0, 5, 10, 11, 12, 28, 29]] = np.nan
    found = joint_health(one_track(np.arange(30) / 10.0, track))["left_wrist"]
    assert found.seen == pytest.approx(23 / 30) and found.gaps == 4
    assert found.longest_gap == pytest.approx(0.4)  # from frame 9 to 13


def test_a_joint_that_is_never_seen() -> None:
    found = joint_health(one_track(np.arange(30) / 30.0, np.full(30, np.nan)))["left_wrist"]
    assert found == health.JointHealth("left_wrist", 0.0, 1, pytest.approx(29 / 30), None, None)


def test_confidence_is_that_of_the_frames_with_the_joint() -> None:
    track, confidence = np.zeros(4), np.array([[1.0], [0.5], [0.9], [0.0]])
    track[2] = np.nan
    assert joint_health(replace(one_track(np.arange(4.0), track), confidence=confidence))[
        "left_wrist"
    ].confidence == pytest.approx(0.5)


@pytest.mark.parametrize("noise", [0.001, 0.005, 0.02])
def test_jitter_grows_with_the_noise_and_not_with_the_motion_or_a_jump(noise: float) -> None:
    still = one_track(np.arange(600) / 30.0, np.zeros(600))
    moving = person(600, joints=("left_wrist",))

    def measured(skeleton: Skeleton) -> float | None:
        random = np.random.default_rng(0)
        worse = spoiled(skeleton, random, noise=noise, dropouts=0.02, outliers=0.0)
        positions = np.array(worse.positions)
        positions[[100, 300]] += 1.0
        return joint_health(replace(worse, positions=positions))["left_wrist"].jitter

    assert measured(still) == pytest.approx(measured(moving), rel=0.1)
    assert measured(still) == pytest.approx(1.25 * noise, rel=0.15)  # what is above 6 of 15 Hz, of three coordinates


def test_what_is_filled_in_is_no_sign_of_a_quiet_hand() -> None:
    track = np.random.default_rng(0).normal(size=600) * 0.01
    gaps = np.where(np.arange(600) % 20 < 9, np.nan, track)
    jitters = [joint_health(one_track(np.arange(600) / 30.0, each))["left_wrist"].jitter for each in (track, gaps)]
    assert jitters[1] == pytest.approx(jitters[0], rel=0.15)


@pytest.mark.parametrize(("frames", "rate"), [(3, 30.0), (50, 10.0)])
def test_too_few_or_too_rare_frames_tell_no_jitter(frames: int, rate: float) -> None:
    skeleton = one_track(np.arange(frames) / rate, np.zeros(frames))
    assert joint_health(skeleton)["left_wrist"].jitter is None


def test_bones_of_a_person_keep_their_lengths_and_are_alike_on_both_sides() -> None:
    found = {(bone.start, bone.end): bone for bone in health.bone_health(person(60, height=1.8))}
    assert set(found) == {(bone.start, bone.end) for bone in body.bones()}
    upper = found["left_shoulder", "left_elbow"]
    assert upper.length == pytest.approx(0.172 * 1.8) and upper.spread < 1e-9
    assert upper.longer == pytest.approx(0.0, abs=1e-9)
    assert found["neck", "head"].longer is None and found["left_hip", "right_hip"].longer is None


def test_a_bone_that_is_longer_on_one_side_and_shakes() -> None:
    skeleton = person(200, joints=JOINTS)
    elbow, wrist = JOINTS.index("left_elbow"), JOINTS.index("left_wrist")
    positions = np.array(skeleton.positions)
    length = 1.2 + 0.05 * np.random.default_rng(0).normal(size=200)
    positions[:, wrist] = positions[:, elbow] + (positions[:, wrist] - positions[:, elbow]) * length[:, None]
    bones = health.bone_health(replace(skeleton, positions=positions))
    found = {(bone.start, bone.end): bone for bone in bones}
    assert found["left_elbow", "left_wrist"].longer == pytest.approx(0.2 / 1.1, rel=0.05)
    assert found["left_elbow", "left_wrist"].spread == pytest.approx(0.05 / 1.2, rel=0.2)
    assert found["right_elbow", "right_wrist"].longer == pytest.approx(-0.2 / 1.1, rel=0.05)


@settings(max_examples=20)
@given(tracked())
def test_a_mirror_changes_the_names_alone(skeleton: Skeleton) -> None:
    here, there = joint_health(skeleton), joint_health(skeleton.mirrored())
    for name, found in here.items():
        assert replace(there[body.twin(name)], joint=name, jitter=None) == replace(found, jitter=None)
    lengths = {(bone.start, bone.end): bone.length for bone in health.bone_health(skeleton)}
    for bone in health.bone_health(skeleton.mirrored()):
        ends = body.twin(bone.start), body.twin(bone.end)
        assert bone.length == pytest.approx(lengths[ends if ends in lengths else ends[::-1]])


def angles(**tracks: list[float]) -> dict[str, health.AngleHealth]:
    frames = len(next(iter(tracks.values())))
    positions = np.full((frames, 26), np.nan)
    for name, values in tracks.items():
        positions[:, ROBOT.index[name]] = values
    given_ = np.isin(ROBOT.joint_names, list(tracks))
    motion = JointTrajectory(np.arange(frames) / 10.0, positions, given_)
    return {each.joint: each for each in health.angle_health(motion, ROBOT)}


def test_angles_are_held_against_limits_and_motors() -> None:
    limit, speed = ROBOT.upper[ROBOT.index["HeadYaw"]], ROBOT.max_speed[ROBOT.index["HeadYaw"]]
    found = angles(HeadYaw=[0.0, 0.1, np.nan, limit + 0.1, limit], LHand=[0.0, 0.5, 1.0, 1.0, 1.0])
    yaw = found["HeadYaw"]
    assert (yaw.seen, yaw.lowest, yaw.highest) == (0.8, 0.0, pytest.approx(limit + 0.1))
    assert (yaw.lower, yaw.upper, yaw.beyond) == (-limit, limit, 0.2)
    assert yaw.speed == pytest.approx(limit / 0.2) and yaw.speed_ratio == pytest.approx(limit / 0.2 / speed)
    assert found["LHand"].beyond == 0.0 and found["LHand"].speed == pytest.approx(5.0)


def test_a_limit_rounded_by_a_file_is_not_beyond() -> None:
    limit = float(np.radians(np.round(np.degrees(ROBOT.upper[ROBOT.index["HeadYaw"]]), 2)))
    assert angles(HeadYaw=[limit])["HeadYaw"].beyond == 0.0
    assert angles(HeadYaw=[limit])["HeadYaw"].speed is None


def test_joints_that_nothing_is_asked_of_are_left_out() -> None:
    assert set(angles(HeadYaw=[0.0], HeadPitch=[np.nan])) == {"HeadYaw"}


def test_fingers_stand_together_and_joints_in_the_bodys_order() -> None:
    joints = ("right_thumb_tip", "left_index_mcp", "left_wrist", "head", "left_index_tip")
    assert health.together(joints) == {"head": [3], "left_wrist": [2], "left_fingers": [1, 4], "right_thumb_tip": [0]}
    everything = health.together(body.joints())
    assert sorted(place for places in everything.values() for place in places) == list(range(len(body.joints())))
