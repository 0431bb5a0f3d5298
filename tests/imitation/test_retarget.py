"""A person in, joint angles out: what holds for the whole of it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.imitation.arms import arm_directions_of
from nao_sim.imitation.person import arm_directions
from nao_sim.imitation.retarget import one_to_one, retarget
from nao_sim.motion import Skeleton
from tests.bodies import person_like, smooth_motion
from tests.people import people, person

LEGS = ("LLeg", "RLeg")


@given(people())
@settings(max_examples=15)
def test_what_is_asked_is_inside_the_limits_whoever_moves_however(robot, somebody):
    positions = retarget(somebody, robot).motion.positions
    finite = np.isfinite(positions)
    assert finite.any()
    assert (positions >= robot.lower - 1e-9)[finite].all()
    assert (positions <= robot.upper + 1e-9)[finite].all()


@given(people())
@settings(max_examples=15)
def test_the_mirrored_person_is_followed_by_the_mirrored_robot(robot, somebody):
    mirrored = retarget(somebody.mirrored(), robot).motion
    np.testing.assert_allclose(mirrored.positions, robot.mirror(retarget(somebody, robot).motion.positions), atol=1e-9)
    np.testing.assert_array_equal(mirrored.given, retarget(somebody, robot).motion.given[robot.mirror_of])


@given(st.integers(0, 1000))
@settings(max_examples=10)
def test_a_person_who_moves_like_a_nao_is_followed_exactly(robot, seed):
    motion = smooth_motion(seed, 1.0)
    followed = one_to_one(person_like(motion), robot)
    np.testing.assert_allclose(arm_directions_of(followed), arm_directions_of(motion.positions), atol=1e-6)


@given(people())
@settings(max_examples=10)
def test_a_stream_gets_the_file_s_answers(robot, somebody):
    whole = one_to_one(somebody, robot)
    previous, arms = None, np.concatenate([robot.limbs["LArm"], robot.limbs["RArm"]])
    for i in range(len(somebody)):
        single = replace(
            somebody, times=somebody.times[i : i + 1], positions=somebody.positions[i : i + 1],
            confidence=somebody.confidence[i : i + 1],
        )  # fmt: skip
        previous = one_to_one(single, robot, previous)[0]
        np.testing.assert_array_equal(previous[arms], whole[i, arms])


def test_a_gap_asks_for_nothing_and_the_arm_goes_on_afterwards(robot):
    somebody = person(frames=90)
    positions = somebody.positions.copy()
    positions[30:80, somebody.joints.index("left_elbow")] = np.nan
    asked = retarget(replace(somebody, positions=positions), robot, raw=True).motion.positions
    shoulder, other = robot.index["LShoulderPitch"], robot.index["RShoulderPitch"]
    assert np.isnan(asked[30:80, shoulder]).all()
    assert np.isfinite(asked[[29, 80], shoulder]).all()
    assert np.isfinite(asked[:, other]).all()


def test_the_legs_are_not_asked_for_anything_by_arms(robot):
    given_ = retarget(person(), robot).motion.given
    assert not given_[np.concatenate([robot.limbs[leg] for leg in LEGS])].any()


def test_the_whole_body_asks_for_the_legs_too(robot):
    motion = retarget(person(), robot, body="whole", start=robot.postures["StandInit"]).motion
    assert motion.given[np.concatenate([robot.limbs[leg] for leg in LEGS])].all()


def test_filters_calm_a_trembling_person_and_raw_leaves_them_alone(robot):
    somebody = person(frames=120, seed=3)
    noise = np.random.default_rng(0).normal(0.0, 0.01, somebody.positions.shape)
    trembling = replace(somebody, positions=somebody.positions + noise)

    def jerk(positions: np.ndarray) -> float:
        return float(np.nanmean(np.abs(np.diff(positions, 3, axis=0))))

    raw, calm = (retarget(trembling, robot, raw=raw).motion.positions for raw in (True, False))
    assert jerk(calm) < 0.3 * jerk(raw)
    np.testing.assert_array_equal(retarget(trembling, robot, raw=True).person.positions, trembling.positions)


def test_the_robot_points_where_the_cleaned_person_points_as_far_as_it_can(robot):
    somebody = person(frames=60, seed=5)
    done = retarget(somebody, robot)
    wanted, reached = arm_directions(done.person), arm_directions_of(done.motion.positions)
    assert np.degrees(np.arccos(np.clip((wanted * reached).sum(axis=-1), -1, 1))).mean() < 20.0


def test_nobody_s_arms_are_refused_with_what_is_there_and_what_is_needed(robot):
    hands = Skeleton(np.arange(3.0), np.ones((3, 2, 3)), ("left_hand", "right_hand"))
    with pytest.raises(UsageError, match=r"only left_hand, right_hand; expected left_shoulder, left_elbow"):
        retarget(hands, robot)
