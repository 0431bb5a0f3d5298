"""Which points cannot be right, and which are only fast."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim import body
from nao_sim.imitation.filters.rejection import BONE, CONFIDENCE, JUMP, Reject
from nao_sim.motion import Skeleton
from tests.people import people, person
from tests.tracking import JOINTS, one_track, spoiled


def found(skeleton: Skeleton, **options: float) -> dict[str, set[tuple[int, str]]]:
    """(frame, joint) of every rejected point by reason."""
    masks = Reject(**options).find(skeleton)
    return {reason: {(int(t), skeleton.joints[j]) for t, j in np.argwhere(mask)} for reason, mask in masks.items()}


def displaced(skeleton: Skeleton, frames: slice, joint: str, by: tuple[float, float, float]) -> Skeleton:
    positions = np.array(skeleton.positions)
    positions[frames, skeleton.joints.index(joint)] += by
    return replace(skeleton, positions=positions)


NOTHING: dict[str, set[tuple[int, str]]] = {CONFIDENCE: set(), BONE: set(), JUMP: set()}


@settings(max_examples=25)
@given(people())
def test_of_a_person_nothing_is_rejected(skeleton: Skeleton) -> None:
    assert found(skeleton) == NOTHING


@pytest.mark.parametrize("rate", [10.0, 15.0, 30.0, 60.0, 120.0])
@pytest.mark.parametrize(("frequency", "reach"), [(1.0, 0.6), (3.0, 0.3), (5.0, 0.15)])
def test_a_fast_wave_is_no_outlier(rate: float, frequency: float, reach: float) -> None:
    times = np.arange(0.0, 4.0, 1.0 / rate)
    assert found(one_track(times, reach * np.sin(2.0 * np.pi * frequency * times))) == NOTHING


def test_points_of_little_confidence_are_rejected() -> None:
    skeleton = person(20, joints=JOINTS)
    confidence = np.array(skeleton.confidence)
    confidence[3, 2], confidence[5, 4] = 0.19, 0.2
    assert found(replace(skeleton, confidence=confidence))[CONFIDENCE] == {(3, JOINTS[2])}


def test_missing_points_are_not_counted_as_rejected() -> None:
    skeleton = person(20, joints=JOINTS)
    assert found(replace(skeleton, positions=np.full(skeleton.positions.shape, np.nan))) == NOTHING


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5])
def test_there_and_back_is_rejected_as_long_as_it_lasts(width: int) -> None:
    times = np.arange(40) / 30.0
    track = 0.3 * times
    track[20 : 20 + width] += 1.5
    assert found(one_track(times, track))[JUMP] == {(frame, "left_wrist") for frame in range(20, 20 + width)}


def test_there_and_not_back_is_kept() -> None:
    times = np.arange(60) / 30.0
    assert found(one_track(times, np.where(times < 1.0, 0.0, 1.5))) == NOTHING


@pytest.mark.parametrize("frame", [0, 2, 57, 59])
def test_a_false_start_or_end_is_rejected(frame: int) -> None:
    times = np.arange(60) / 30.0
    track = 0.3 * times
    wrong = slice(0, frame + 1) if frame < 30 else slice(frame, 60)
    track[wrong] += 1.5
    assert found(one_track(times, track))[JUMP] == {(i, "left_wrist") for i in range(60)[wrong]}


def test_in_a_noisy_recording_noise_is_no_jump() -> None:
    random = np.random.default_rng(0)
    noisy = spoiled(person(200, joints=JOINTS), random, noise=0.02, dropouts=0.1, outliers=0.0)
    assert len(found(noisy)[JUMP]) <= 2  # of 2000 points


@pytest.mark.parametrize("joint", JOINTS[4:])
def test_the_joint_that_stretches_its_bones_is_to_blame(joint: str) -> None:
    skeleton = person(60, seed=3, joints=(*JOINTS, "left_hip", "right_hip"))
    drifting = displaced(skeleton, slice(20, 40), joint, (0.0, 0.0, 0.9))  # too long for a jump
    assert found(drifting)[BONE] == {(frame, joint) for frame in range(20, 40)}


def test_of_a_bone_by_itself_the_outer_end_is_to_blame() -> None:
    skeleton = person(60, joints=("left_elbow", "left_wrist"))
    wrong = displaced(skeleton, slice(20, 40), "left_elbow", (0.0, 0.5, 0.0))
    assert {joint for _, joint in found(wrong)[BONE]} == {"left_wrist"}


def test_shoulders_may_come_closer_and_limbs_that_point_at_the_camera_be_short() -> None:
    skeleton = person(60, seed=3, joints=JOINTS)
    near = displaced(skeleton, slice(20, 40), "left_shoulder", (0.0, -0.08, 0.0))
    near = displaced(near, slice(20, 40), "right_shoulder", (0.0, 0.08, 0.0))
    assert found(near)[BONE] == set()
    at, to = (skeleton.joints.index(name) for name in ("left_elbow", "left_wrist"))
    positions = np.array(skeleton.positions)
    positions[10:, to] = (
        positions[10:, at] + (positions[10:, to] - positions[10:, at]) * np.linspace(1, 0.5, 50)[:, None]
    )
    assert found(replace(skeleton, positions=positions))[BONE] == set()


def test_in_a_picture_bones_look_short_but_not_long() -> None:
    skeleton = person(60, seed=3, joints=JOINTS)
    flat = replace(skeleton, positions=skeleton.positions * [0.0, 1.0, 1.0], planar=True)
    assert found(flat) == NOTHING
    assert {joint for _, joint in found(displaced(flat, slice(20, 24), "left_wrist", (0.0, 0.0, 0.9)))[BONE]} == {
        "left_wrist"
    }


def test_bones_of_a_few_frames_tell_nothing() -> None:
    skeleton = displaced(person(4, joints=JOINTS), slice(1, 2), "left_wrist", (0.0, 0.5, 0.0))
    assert found(skeleton)[BONE] == set()


def test_what_stays_is_as_it_was() -> None:
    times = np.arange(40) / 30.0
    track = 0.3 * times
    track[20] += 1.5
    result = Reject().filter(one_track(times, track))
    assert np.isnan(result.positions[20]).all() and result.confidence[20] == 0.0
    kept = np.arange(40) != 20
    assert np.array_equal(result.positions[kept, 0, 1], track[kept]) and (result.confidence[kept] == 1.0).all()


def test_outliers_of_a_bad_tracker_are_found() -> None:
    clean, random = person(600, seed=1, joints=JOINTS), np.random.default_rng(1)
    noisy = spoiled(clean, random, noise=0.01, dropouts=0.03, outliers=0.01)
    off = np.linalg.norm(noisy.positions - clean.positions, axis=2)
    wrong = np.any([*Reject().find(noisy).values()], axis=0)
    assert wrong[off > 0.25].mean() > 0.95
    assert wrong[off < 0.05].mean() < 0.003


@pytest.mark.parametrize("joints", [(), ("head",)])
def test_any_set_of_joints_will_do(joints: tuple[str, ...]) -> None:
    skeleton = Skeleton(np.arange(30) / 30.0, np.zeros((30, len(joints), 3)), joints)
    assert found(skeleton) == NOTHING


def test_every_joint_with_a_bone_is_known() -> None:
    assert set(JOINTS) <= set(body.joints())
