"""The imitation score."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.imitation.similarity import STAGES, Similarity, similarity
from nao_sim.imitation.similarity_body import LINKS, person_body, robot_body
from nao_sim.imitation.similarity_measures import delay
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import load_robot
from nao_sim.simulation.rollout import Rollout
from tests.bodies import Kinematics, person_like, random_poses, smooth_motion
from tests.people import people

ROBOT = load_robot()
DOCS = Path(__file__).resolve().parents[2] / "docs" / "report.md"
SEEDS = st.integers(0, 2**31)


def _of(score: Similarity, stage: str = "requested") -> dict:
    return score.as_report()["stages"][stage]


def _moved(person: Skeleton, turn: Rotation, scale: float = 1.0, shift: tuple[float, ...] = (0, 0, 0)) -> Skeleton:
    return replace(person, positions=scale * (person.positions @ turn.as_matrix().T) + shift)


def _bent(motion: JointTrajectory, joint: str, degrees: float) -> JointTrajectory:
    positions = motion.positions.copy()
    positions[:, ROBOT.index[joint]] += np.radians(degrees)
    return JointTrajectory(motion.times, positions)


def _still(frames: int = 20, **angles: float) -> JointTrajectory:
    positions = np.zeros((frames, 26))
    for joint, degrees in angles.items():
        positions[:, ROBOT.index[joint]] = np.radians(degrees)
    return JointTrajectory(0.02 * np.arange(frames), positions)


def _rollout(times: np.ndarray, positions: np.ndarray, base: Rotation | None = None, **clock: float) -> Rollout:
    pose = np.zeros((len(times), 7))
    pose[:, 3:] = np.roll((base or Rotation.identity()).as_quat(), 1, axis=-1)
    return Rollout(times, positions, positions, positions, np.zeros_like(positions), pose, **clock)


# a robot posed exactly as a reachable person


@settings(max_examples=10)
@given(SEEDS)
def test_a_robot_posed_as_a_person_has_no_error_and_is_all_alike(seed):
    motion = random_poses(seed, 40)
    score = similarity(person_like(motion), motion)
    stage = score.stages["requested"]
    assert np.abs(stage.direction_errors).max() < 1e-9 and np.abs(score.limits).max() < 1e-6
    assert np.abs(stage.wbf - 1.0).max() < 1e-9 and np.abs(stage.llf - 1.0).max() < 1e-9
    assert score.coverage.tolist() == [1.0, 1.0] and len(score.times) == 40


@settings(max_examples=10)
@given(SEEDS)
def test_a_person_of_naos_proportions_has_the_hand_one_elbow_offset_away(seed):
    motion = random_poses(seed, 20)
    errors = similarity(person_like(motion), motion).stages["requested"].hand_errors
    assert errors == pytest.approx(0.015 / (0.105 + 0.05595 + 0.05775))


@settings(max_examples=10)
@given(SEEDS)
def test_the_robots_hand_is_where_mujoco_has_it(seed):
    motion = random_poses(seed, 20)
    body = Kinematics(motion.positions)
    for side, letter in enumerate("LR"):
        forearm = body.turns[f"{letter}ForeArm"]
        hand = body.places[f"{letter}ForeArm"] + forearm @ (0.05595 + 0.05775, 0.0, 0.0) - body.places[f"{letter}Bicep"]
        assert robot_body(motion.times, motion.positions).hands[:, side] == pytest.approx(hand / 0.2187)


@settings(max_examples=10)
@given(SEEDS)
def test_a_joint_angle_recording_is_all_alike_with_itself(seed):
    motion = smooth_motion(seed, 2.0)
    report = _of(similarity(motion, motion))
    assert report["direction_error_deg"]["all"]["p95"] == report["hand_error_arm_lengths"]["all"]["p95"] == 0.0
    assert report["wbf"]["mean"] == report["llf"]["mean"] == 1.0
    assert list(report["wbf"]["links"]) == list(LINKS)


# what changes nothing


@settings(max_examples=10)
@given(people(frames=20), SEEDS, st.floats(-3.1, 3.1), st.floats(0.3, 3.0))
def test_where_a_person_stands_and_faces_and_how_tall_they_are_changes_nothing(person, seed, turn, scale):
    motion = JointTrajectory(person.times, random_poses(seed, len(person)).positions)
    moved = _moved(person, Rotation.from_euler("z", turn), scale, (1.0, -2.0, 0.5))
    plain, other = similarity(person, motion), similarity(moved, motion)
    for name in ("direction_errors", "hand_errors", "wbf", "llf"):
        assert getattr(other.stages["requested"], name) == pytest.approx(
            getattr(plain.stages["requested"], name), abs=1e-6
        )
    assert other.limits == pytest.approx(plain.limits, abs=1e-3)


@settings(max_examples=10)
@given(people(frames=20), SEEDS)
def test_lying_down_changes_the_upright_frame_only(person, seed):
    motion = JointTrajectory(person.times, random_poses(seed, len(person)).positions)
    lying = _moved(person, Rotation.random(rng=np.random.default_rng(seed)))
    plain, other = (similarity(who, motion).stages["requested"] for who in (person, lying))
    assert other.direction_errors == pytest.approx(plain.direction_errors, abs=1e-6)
    assert other.hand_errors == pytest.approx(plain.hand_errors, abs=1e-6)
    assert other.llf[:, 1:] == pytest.approx(plain.llf[:, 1:], abs=1e-6)  # the torso's own comes first


@settings(max_examples=10)
@given(people(frames=20), SEEDS)
def test_in_the_mirror_the_sides_change_places(person, seed):
    motion = JointTrajectory(person.times, random_poses(seed, len(person)).positions)
    plain, other = similarity(person, motion), similarity(person.mirrored(), motion.mirrored())
    one, two = plain.stages["requested"], other.stages["requested"]
    assert two.direction_errors[:, ::-1] == pytest.approx(one.direction_errors, abs=1e-9)
    assert two.hand_errors[:, ::-1] == pytest.approx(one.hand_errors, abs=1e-9)
    swapped = [LINKS.index({"l": "right", "r": "left"}[link[0]] + link[link.index("_") :]) if "_" in link else i
               for i, link in enumerate(LINKS)]  # fmt: skip
    assert two.wbf[:, swapped] == pytest.approx(one.wbf, abs=1e-9)
    assert two.llf[:, swapped] == pytest.approx(one.llf, abs=1e-9)
    assert other.limits[:, ::-1] == pytest.approx(plain.limits, abs=1e-6)


# errors of a known size


@pytest.mark.parametrize(("joint", "letter"), [("LShoulderPitch", "L"), ("RShoulderPitch", "R")])
def test_a_shoulder_ten_degrees_off_is_off_at_both_segments_and_once_for_the_local_measure(joint, letter):
    motion = _still(LElbowRoll=-60, RElbowRoll=60)
    score = similarity(person_like(motion), _bent(motion, joint, 10.0))
    stage, side = _of(score), "left" if letter == "L" else "right"
    off = stage["direction_error_deg"]
    assert off[f"{side}_upper_arm"]["mean"] == pytest.approx(10.0, abs=1e-3)
    assert off[f"{side}_forearm"]["mean"] == pytest.approx(np.degrees(_turned(60.0, 10.0)), abs=1e-3)
    assert off["all"]["median"] == pytest.approx(off[f"{side}_forearm"]["mean"] / 2, abs=1e-3)
    assert stage["wbf"]["links"][f"{side}_forearm"] == pytest.approx(np.cos(_turned(60.0, 10.0)), abs=1e-4)
    assert stage["llf"]["links"][f"{side}_upper_arm"] == pytest.approx(np.cos(np.radians(10.0)), abs=1e-4)
    assert stage["llf"]["links"][f"{side}_forearm"] == 1.0
    assert stage["wbf"]["mean"] < stage["llf"]["mean"] == pytest.approx(0.9 + np.cos(np.radians(10.0)) / 10, abs=1e-4)


def _turned(bend: float, pitch: float) -> float:
    """Angle between a forearm `bend` degrees from straight ahead to the side and itself after `pitch` degrees."""
    ahead = np.cos(np.radians(bend))
    return float(np.arccos(1.0 - ahead**2 * (1.0 - np.cos(np.radians(pitch)))))


def test_a_knee_counts_once_and_a_hip_twice_in_the_whole_body():
    motion = _still(LKneePitch=30)
    person = person_like(motion, upright=True)
    upright = Rotation.identity()
    knee = _rollout(motion.times, _bent(motion, "LKneePitch", 20.0).positions, upright)
    hip = _rollout(motion.times, _bent(motion, "LHipPitch", 20.0).positions, upright)
    far = pytest.approx(np.cos(np.radians(20.0)), abs=1e-4)
    for stage in STAGES:
        links = _of(similarity(person, knee), stage)
        assert links["wbf"]["links"]["left_shank"] == links["llf"]["links"]["left_shank"] == far
        assert links["wbf"]["links"]["left_thigh"] == links["llf"]["links"]["right_shank"] == 1.0
        links = _of(similarity(person, hip), stage)
        assert links["wbf"]["links"]["left_shank"] == links["wbf"]["links"]["left_thigh"] == far
        assert links["llf"]["links"]["left_thigh"] == far and links["llf"]["links"]["left_shank"] == 1.0


def test_a_leaning_robot_is_off_everywhere_in_the_whole_body_and_once_for_the_local_measure():
    motion = _still(LShoulderPitch=90, RShoulderPitch=90)
    lean = Rotation.from_euler("zy", [40.0, 20.0], degrees=True)  # where it faces does not count
    stage = _of(similarity(person_like(motion), _rollout(motion.times, motion.positions, lean)), "simulated")
    assert list(stage["wbf"]["links"].values()) == pytest.approx([np.cos(np.radians(20.0))] * 10, abs=1e-4)
    assert list(stage["llf"]["links"].values()) == pytest.approx([np.cos(np.radians(20.0))] + [1.0] * 9, abs=1e-4)
    assert stage["direction_error_deg"]["all"]["p95"] == 0.0


def test_a_robot_that_bends_its_knees_with_feet_flat_leans_as_its_feet_say():
    motion = _still(LHipPitch=-40, RHipPitch=-40, LKneePitch=60, RKneePitch=60)  # ankles straight: leans back by 20
    upright = person_like(motion, upright=True)
    links = _of(similarity(upright, motion))["wbf"]["links"]
    assert links["torso"] == pytest.approx(np.cos(np.radians(20.0)), abs=1e-4)


# what NAO's limits allow


@settings(max_examples=10)
@given(people(frames=20), SEEDS)
def test_no_pose_inside_the_limits_is_nearer_than_the_nearest(person, seed):
    motion = JointTrajectory(person.times, random_poses(seed, len(person)).positions)
    score = similarity(person, motion)
    assert np.degrees(score.stages["requested"].excess.min()) > -0.5  # how near the search comes to the optimum
    assert np.degrees(score.stages["requested"].excess.mean()) > 0.0


def test_an_arm_out_of_reach_is_naos_limit_and_none_of_our_error():
    beyond = _still(LShoulderRoll=85, RShoulderRoll=-85, LElbowRoll=-45, RElbowRoll=45)
    nearest = _still(LShoulderRoll=76, RShoulderRoll=-76, LElbowRoll=-36, RElbowRoll=36)
    clamped = _still(LShoulderRoll=76, RShoulderRoll=-76, LElbowRoll=-45, RElbowRoll=45)
    report = similarity(person_like(beyond), nearest).as_report()
    assert report["limits_deg"]["left_upper_arm"]["mean"] == pytest.approx(9.0, abs=0.5)
    assert report["limits_deg"]["right_forearm"]["mean"] == pytest.approx(0.0, abs=0.5)
    assert report["stages"]["requested"]["excess_deg"]["mean"] == pytest.approx(0.0, abs=0.25)
    excess = _of(similarity(person_like(beyond), clamped))["excess_deg"]
    assert excess["mean"] == pytest.approx(4.5, abs=0.25)  # 9 degrees at the forearm, none at the upper arm


# time


@settings(max_examples=25)
@given(SEEDS, st.floats(-0.8, 0.8), st.sampled_from([25.0, 30.0, 120.0]))
def test_a_pure_delay_is_found_to_two_milliseconds(seed, late, rate):
    motion = smooth_motion(seed, 6.0, rate=rate)
    times = 0.02 * np.arange(-100, 400)
    robot = robot_body(times, motion.sample(times - late))
    assert delay(person_body(person_like(motion)), robot) == pytest.approx(late, abs=0.002)


@settings(max_examples=10)
@given(SEEDS, st.floats(0.0, 0.4))
def test_gaps_do_not_change_the_delay(seed, late):
    motion = smooth_motion(seed, 8.0, rate=60.0)
    person = person_like(motion)
    lost = np.random.default_rng(seed).random((len(person), 1, 1)) < 0.1
    gaps = replace(person, positions=np.where(lost, np.nan, person.positions))
    times = 0.02 * np.arange(450)
    robot = robot_body(times, motion.sample(times - late))
    assert delay(person_body(gaps), robot) == pytest.approx(late, abs=0.004)


def test_a_wave_is_late_by_the_smallest_delay_that_fits():
    motion = _still(400, LElbowRoll=-45)
    positions = motion.positions.copy()
    positions[:, ROBOT.index["LShoulderPitch"]] = 0.5 * np.sin(2 * np.pi * motion.times / 0.8)
    wave = JointTrajectory(motion.times, positions)
    late = JointTrajectory(wave.times, wave.sample(wave.times - 0.1))
    assert delay(person_body(person_like(wave)), robot_body(late.times, late.positions)) == pytest.approx(
        0.1, abs=0.003
    )


def test_where_nothing_moves_there_is_no_delay():
    motion, moving = _still(200), smooth_motion(3, 4.0)
    for person, robot in ((motion, motion), (motion, moving), (moving, motion)):
        assert delay(person_body(person_like(person)), robot_body(robot.times, robot.positions)) is None


def test_the_approach_and_the_rest_do_not_count():
    motion = smooth_motion(5, 4.0)
    times = 0.02 * np.arange(1, 301)
    start = 1.0
    positions = motion.sample(times - start)
    outside = (times < start - 1e-9) | (times > start + motion.duration + 1e-9)
    positions[outside] = random_poses(0, int(outside.sum())).positions
    score = similarity(person_like(motion), _rollout(times, positions, motion_start=start))
    assert (score.times[0], score.times[-1]) == pytest.approx((start, start + motion.duration))
    for stage in STAGES:
        assert np.degrees(score.stages[stage].direction_errors.max()) < 1e-6


def test_at_twice_the_speed_the_person_is_twice_as_fast():
    motion = smooth_motion(6, 4.0, rate=25.0)
    sped = motion.at_speed(2.0)
    times = 0.02 * np.arange(1, 200)
    rollout = _rollout(times, sped.sample(times - 0.5), motion_start=0.5, speed=2.0)
    person = person_like(motion)
    assert np.degrees(similarity(person, rollout).stages["simulated"].direction_errors.max()) < 0.01
    slow = replace(rollout, speed=1.0)
    assert np.degrees(similarity(person, slow).stages["simulated"].direction_errors.mean()) > 3.0


def test_between_a_persons_frames_the_motion_goes_on():
    coarse, fine = smooth_motion(7, 3.0, rate=25.0), smooth_motion(7, 3.0, rate=50.0)
    errors = similarity(person_like(coarse), fine).stages["requested"].direction_errors
    assert len(errors) == 149 and np.isfinite(errors).all() and np.degrees(errors.max()) < 2.0


# what is not known


@settings(max_examples=10)
@given(SEEDS)
def test_frames_that_are_not_known_are_left_out(seed):
    motion, other = random_poses(seed, 30), random_poses(seed + 1, 30)
    person = person_like(motion)
    lost = np.random.default_rng(seed).random(30) < 0.4
    gaps = replace(person, positions=np.where(lost[:, None, None], np.nan, person.positions))
    left, whole = similarity(gaps, other), similarity(person, other)
    for name in ("direction_errors", "hand_errors", "wbf", "llf"):
        known, all_of_it = (getattr(score.stages["requested"], name) for score in (left, whole))
        assert np.isnan(known[lost]).all() and known[~lost] == pytest.approx(all_of_it[~lost])
    mean = np.degrees(whole.stages["requested"].direction_errors[~lost].mean())
    assert _of(left)["direction_error_deg"]["all"]["mean"] == pytest.approx(mean, abs=1e-3)
    assert left.as_report()["coverage"]["left"] == pytest.approx(1.0 - lost.mean(), abs=1e-4)
    assert left.as_report()["compared"] == (~lost).sum()


def test_between_keyframes_the_joints_move_on_and_not_the_directions():
    times = np.array([0.0, 1.0, 3.0])
    keyframes = JointTrajectory(times, random_poses(8, 3).positions)
    steps = 0.02 * np.arange(151)
    for human, robot in ((keyframes, JointTrajectory(steps, keyframes.sample(steps))), (keyframes, keyframes)):
        score = similarity(human, robot)
        assert len(score.times) == 151 and score.times == pytest.approx(steps)
        assert np.degrees(score.stages["requested"].direction_errors.max()) < 1e-6
    rollout = _rollout(steps + 1.0, keyframes.sample(2.0 * steps), motion_start=1.0, speed=2.0)
    assert np.degrees(similarity(keyframes, rollout).stages["simulated"].direction_errors.max()) < 1e-6


def test_an_arm_that_is_not_seen_is_left_out_alone():
    motion = random_poses(1, 10)
    person = person_like(motion)
    joints = tuple(joint for joint in person.joints if joint != "left_elbow")
    positions = np.stack([person.track(joint) for joint in joints], axis=1)
    report = similarity(Skeleton(person.times, positions, joints), motion).as_report()
    assert report["coverage"] == {"left": 0.0, "right": 1.0} and report["compared"] == 10
    assert report["stages"]["requested"]["direction_error_deg"]["left_upper_arm"]["mean"] is None
    assert report["stages"]["requested"]["direction_error_deg"]["all"]["mean"] == 0.0
    assert report["stages"]["requested"]["hand_error_arm_lengths"]["left"]["p95"] is None
    assert "left_forearm" not in report["stages"]["requested"]["wbf"]["links"]


def test_joints_that_nobody_asked_for_are_left_out():
    motion = smooth_motion(2, 2.0)
    arms = np.where(
        [name[1:].startswith(("Shoulder", "Elbow")) for name in ROBOT.joint_names], motion.positions, np.nan
    )
    links = _of(similarity(person_like(motion, upright=True), JointTrajectory(motion.times, arms)))["wbf"]["links"]
    assert list(links) == ["torso", *LINKS[2:6]] and set(links.values()) == {1.0}


@pytest.mark.parametrize("joints", [("head",), ("left_shoulder", "right_shoulder", "pelvis")])
def test_somebody_without_arms_has_a_score_of_nothing(joints):
    person = Skeleton(np.array([0.0, 0.02]), np.random.default_rng(0).normal(size=(2, len(joints), 3)), joints)
    report = similarity(person, random_poses(0, 2)).as_report()
    assert report["compared"] == 0 and report["coverage"] == {"left": 0.0, "right": 0.0}
    assert report["stages"]["requested"]["excess_deg"]["mean"] is None
    assert "NaN" not in json.dumps(report)


def test_a_motion_elsewhere_in_time_has_no_moment_in_common():
    motion = smooth_motion(0, 1.0)
    score = similarity(motion, _rollout(motion.times + 1.0, motion.positions, motion_start=50.0))
    assert len(score.times) == 0
    assert score.as_report()["compared"] == 0


@settings(max_examples=15)
@given(st.floats(0.05, 20.0), st.floats(-1e6, 1e6))
def test_keyframes_may_last_any_time(seconds, first):
    motion = JointTrajectory(first + np.array([0.0, seconds]), random_poses(0, 2).positions)
    score = similarity(motion, motion)
    assert score.times[-1] == pytest.approx(motion.times[-1], rel=1e-12) and np.diff(score.times).max() < 0.0201
    assert np.degrees(np.nanmax(score.stages["requested"].direction_errors)) < 1e-3


def test_a_single_frame_is_compared_with_the_moment_it_is_asked_for():
    pose = random_poses(4, 1)
    times = 0.02 * np.arange(1, 101)
    rollout = _rollout(times, np.repeat(pose.positions, 100, axis=0), motion_start=1.0)
    report = similarity(person_like(pose), rollout).as_report()
    assert report["compared"] == 1
    assert report["stages"]["simulated"]["direction_error_deg"]["all"]["mean"] == 0.0


def test_every_key_of_the_report_is_documented():
    motion = smooth_motion(0, 2.0)
    rollout = _rollout(motion.times, motion.positions)
    documented = DOCS.read_text(encoding="utf-8")
    missing = {
        key for key in _keys(similarity(person_like(motion), rollout).as_report()) if f"`{key}`" not in documented
    }
    assert not missing


def _keys(report: object) -> set[str]:
    if not isinstance(report, dict):
        return set()
    return set(report).union(*(_keys(value) for value in report.values()))
