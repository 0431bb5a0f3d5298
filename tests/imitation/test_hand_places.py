"""Places on the person's body become the same places on the robot's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.imitation.hand_places import HEAD_CENTRE, HEAD_RADIUS, PALM_ROOM, Places, palm, places_of, robot_places
from nao_sim.motion import Skeleton
from nao_sim.robot import load_robot
from tests.people import person

ROBOT = load_robot()
ARM, HALF = 0.64, 0.18  # m, of the person
HEAD = np.array([0.02, 0.0, 0.2])
SHOULDER = np.array([0.0, 0.098, 0.1])  # of the robot, m
ROBOT_HEAD = np.array([0.0, 0.0, 0.1265]) + HEAD_CENTRE
AHEAD = np.full((1, 26), np.nan)
SEEDS = st.integers(0, 2**32 - 1)


def robot_place(place, head=HEAD, positions=AHEAD, side=0):
    hands = np.full((1, 2, 3), np.nan)
    hands[0, side] = place
    return robot_places(Places(hands, np.array([head]), ARM, HALF), positions, ROBOT)[0, side]


def test_a_stretched_arm_is_a_stretched_arm():
    for way in np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, -1.0]]):
        found = robot_place([0.0, HALF, 0.0] + ARM * way)
        np.testing.assert_allclose(found, SHOULDER + 0.2187 * way, atol=1e-12)


def test_a_hand_on_a_shoulder_or_on_the_midline_stays_there():
    np.testing.assert_allclose(robot_place([0.0, HALF, 0.0], head=[np.nan] * 3), SHOULDER, atol=1e-12)
    np.testing.assert_allclose(robot_place([0.0, -HALF, 0.0], head=[np.nan] * 3), SHOULDER * [1, -1, 1], atol=1e-12)
    assert robot_place([0.4, 0.0, -0.1])[1] == 0.0


@settings(max_examples=50)
@given(SEEDS)
def test_hands_that_meet_keep_meeting_and_a_mirror_mirrors(seed):
    place = np.random.default_rng(seed).uniform(-ARM, ARM, 3)
    left, right = (robot_place(place, side=side) for side in (0, 1))
    np.testing.assert_array_equal(left, right)
    np.testing.assert_allclose(robot_place(place * [1, -1, 1]), left * [1, -1, 1], atol=1e-12)


@settings(max_examples=50)
@given(SEEDS)
def test_a_small_move_is_a_small_move(seed):
    random = np.random.default_rng(seed)
    place, move = HEAD + random.uniform(-0.5, 0.5, 3), random.normal(size=3) * 1e-4
    if np.linalg.norm(place - HEAD) < 0.1:
        return  # inside the head
    assert np.linalg.norm(robot_place(place + move) - robot_place(place)) < 2.0 * np.linalg.norm(move)


@pytest.mark.parametrize(
    ("where", "way"),
    [("mouth", [0.9, 0.0, -0.44]), ("forehead", [0.8, 0.0, 0.6]), ("ear", [0.0, 1.0, 0.0]), ("top", [0.0, 0.0, 1.0])],
)
def test_a_hand_on_the_face_comes_to_the_same_place_of_the_face(where, way):
    way = np.array(way) / np.linalg.norm(way)
    found = robot_place(HEAD + 0.12 * way)
    np.testing.assert_allclose(found, ROBOT_HEAD + (HEAD_RADIUS + PALM_ROOM) * way, atol=1e-12, err_msg=where)


def test_a_nodding_head_takes_the_hand_on_it_along():
    positions = np.full((1, 26), np.nan)
    positions[0, ROBOT.index["HeadPitch"]] = 0.4
    turn = Rotation.from_euler("y", 0.4)
    ahead = np.array([1.0, 0.0, 0.0])
    expected = (0.0, 0.0, 0.1265) + turn.apply(HEAD_CENTRE) + (HEAD_RADIUS + PALM_ROOM) * ahead
    np.testing.assert_allclose(robot_place(HEAD + 0.12 * ahead, positions=positions), expected, atol=1e-12)


@settings(max_examples=5)
@given(SEEDS, st.floats(-3.0, 3.0), st.floats(0.5, 1.5))
def test_where_the_person_is_how_turned_and_how_tall_does_not_matter(seed, turn, size):
    skeleton = person(10, seed)
    points = Rotation.from_euler("z", turn).apply(np.array(skeleton.positions).reshape(-1, 3)) * size + [3.0, 1.0, 0.0]
    other = replace(skeleton, positions=points.reshape(skeleton.positions.shape))
    asked = np.full((10, 26), np.nan)
    plain, moved = (robot_places(places_of(told), asked, ROBOT) for told in (skeleton, other))
    np.testing.assert_allclose(moved, plain, atol=1e-9)


def test_a_palm_is_taken_from_what_is_tracked():
    skeleton = person(10)
    without = [i for i, name in enumerate(skeleton.joints) if name != "left_hand"]
    knuckles = Skeleton(skeleton.times, skeleton.positions[:, without], tuple(skeleton.joints[i] for i in without))
    bare = [i for i in without if skeleton.joints[i] in {"left_elbow", "left_wrist"}]
    arm = Skeleton(skeleton.times, skeleton.positions[:, bare], tuple(skeleton.joints[i] for i in bare))
    np.testing.assert_array_equal(palm(skeleton, "left"), skeleton.track("left_hand"))
    assert np.linalg.norm(palm(knuckles, "left") - palm(skeleton, "left"), axis=1).max() < 0.05
    along = palm(arm, "left") - arm.track("left_wrist")
    forearm = arm.track("left_wrist") - arm.track("left_elbow")
    np.testing.assert_allclose(along, forearm * 0.05 / 0.146, atol=1e-12)


def test_what_is_not_tracked_has_no_place():
    skeleton = person(10, joints=("left_shoulder", "right_shoulder", "left_elbow", "left_wrist", "pelvis"))
    places = robot_places(places_of(skeleton), np.full((10, 26), np.nan), ROBOT)
    assert np.isfinite(places[:, 0]).all() and np.isnan(places[:, 1]).all()
