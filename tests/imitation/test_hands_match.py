"""The robot's hands come where the person's are, clear of its body."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.imitation.hand_places import places_of, robot_places
from nao_sim.imitation.hands_match import CLEARANCE, FASTEST, match_hands
from nao_sim.imitation.retarget import one_to_one
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import load_robot
from nao_sim.safety.self_collision import CLEARANCE as GUARDED
from nao_sim.safety.self_distance import SelfDistance
from tests.bodies import Kinematics
from tests.imitation.standing import HEIGHT, standing
from tests.people import person

ROBOT = load_robot()
START = ROBOT.postures["StandInit"]
ARMS = [
    ROBOT.index[letter + name] for letter in "LR" for name in ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll")
]
SEEDS = st.integers(0, 2**16)


def palms(positions):
    """Middle of the left and right palm (T, 2, 3), m in the torso."""
    body = Kinematics(np.where(np.isfinite(positions), positions, START))
    return np.stack(
        [body.places[link] + 0.05775 * body.turns[link][:, :, 0] for link in ("l_wrist", "r_wrist")], axis=1
    )


def errors(skeleton, positions):
    """How far (T, 2) m the hands are from where they belong."""
    return np.linalg.norm(palms(positions) - robot_places(places_of(skeleton), positions, ROBOT), axis=2)


def smallest_distance(positions):
    distance = SelfDistance()
    return min(distance.nearest(np.where(np.isfinite(row), row, START)).distance for row in positions)


def arms_are_clear(positions):
    """Whether the arms keep more than their clearance; legs that stand are nearer to each other."""
    distance, arms = SelfDistance(), ("Shoulder", "Bicep", "Elbow", "ForeArm", "wrist")
    near = (pair for row in positions for pair in distance.pairs(row, CLEARANCE + 0.001))
    return not any(arm in link for pair in near for link in pair.links for arm in arms)


def somebody(seed, frames=15):
    skeleton = person(frames, seed)
    return skeleton, one_to_one(skeleton, ROBOT)


def robot_shaped(positions):
    """A person of the robot's own shape, whose head is not seen, with the arms of positions (T, 26)."""
    body = Kinematics(positions)
    points = {"pelvis": np.zeros((len(positions), 3))}
    for side, letter, sign in (("left", "L", 1.0), ("right", "R", -1.0)):
        shoulder = np.tile((0.0, 0.098 * sign, 0.1), (len(positions), 1))
        elbow, hand = body.places[f"{letter}Elbow"], palms(positions)[:, int(letter == "R")]
        points |= {f"{side}_shoulder": shoulder, f"{side}_elbow": elbow, f"{side}_hand": hand}
        points[f"{side}_wrist"] = (elbow + hand) / 2.0
    return Skeleton(np.arange(len(positions)) / 30.0, np.stack(list(points.values()), axis=1), tuple(points))


def reaching(seed):
    """Arms (20, 26) that go from one pose to another, clear of the body."""
    random = np.random.default_rng(seed)
    while True:
        ends = np.tile(START, (2, 1))
        ends[:, ARMS] = random.uniform(ROBOT.lower + 0.1, ROBOT.upper - 0.1, (2, 26))[:, ARMS]
        positions = ends[0] + np.linspace(0.0, 1.0, 20)[:, None] * (ends[1] - ends[0])
        if arms_are_clear(positions):
            return positions


@settings(max_examples=8)
@given(SEEDS)
def test_places_that_the_robot_reaches_are_reached(seed):
    skeleton = robot_shaped(reaching(seed))
    assert places_of(skeleton).arm == pytest.approx(0.2187, rel=0.01)  # the elbow lies 15 mm beside the upper arm
    asked = one_to_one(skeleton, ROBOT)
    matched = match_hands(skeleton, asked, ROBOT)
    assert np.median(errors(skeleton, matched)) < 0.004
    assert errors(skeleton, matched).mean() <= errors(skeleton, asked).mean() + 1e-3


@settings(max_examples=6)
@given(SEEDS)
def test_whatever_the_person_does_limits_and_clearance_hold(seed):
    skeleton, asked = somebody(seed)
    matched = match_hands(skeleton, asked, ROBOT)
    assert (matched[:, ARMS] >= ROBOT.lower[ARMS] - 1e-9).all() and (matched[:, ARMS] <= ROBOT.upper[ARMS] + 1e-9).all()
    assert smallest_distance(matched) > 0.005
    assert (np.abs(np.diff(matched[:, ARMS], axis=0)) <= FASTEST * np.diff(skeleton.times)[:, None] + 1e-9).all()
    others = np.setdiff1d(np.arange(26), ARMS)
    np.testing.assert_array_equal(matched[:, others], asked[:, others])


def test_hands_are_nearer_than_one_to_one():
    plain, matched = [], []
    for seed in range(4):
        skeleton, asked = somebody(seed)
        plain.append(errors(skeleton, asked))
        matched.append(errors(skeleton, match_hands(skeleton, asked, ROBOT)))
    assert np.mean(matched) < 0.7 * np.mean(plain)


@settings(max_examples=3)
@given(SEEDS)
def test_a_mirrored_person_makes_a_mirrored_robot(seed):
    skeleton, asked = somebody(seed)
    plain = match_hands(skeleton, asked, ROBOT)
    mirrored = match_hands(skeleton.mirrored(), ROBOT.mirror(asked), ROBOT)
    assert np.degrees(np.abs(ROBOT.mirror(mirrored) - plain)[:, ARMS].max()) < 0.1


def test_the_same_person_makes_the_same_robot():
    skeleton, asked = somebody(3)
    np.testing.assert_array_equal(match_hands(skeleton, asked, ROBOT), match_hands(skeleton, asked, ROBOT))


def test_gaps_stay_gaps():
    skeleton, asked = somebody(1)
    points = np.array(skeleton.positions)
    points[5:9, [skeleton.joints.index(f"right_{part}") for part in ("elbow", "wrist", "hand")]] = np.nan
    seen = Skeleton(skeleton.times, points, skeleton.joints)
    asked = one_to_one(seen, ROBOT)
    matched = match_hands(seen, asked, ROBOT)
    np.testing.assert_array_equal(np.isnan(matched), np.isnan(asked))
    assert np.isnan(matched[5:9, ARMS[4:]]).all() and np.isfinite(matched[:, ARMS[:4]]).all()


def test_an_arm_whose_hand_has_no_place_stays_one_to_one():
    skeleton, asked = somebody(2)
    asked = np.array(asked)
    asked[:, ARMS] = START[ARMS] + 0.1
    seen = [i for i, name in enumerate(skeleton.joints) if not name.startswith(("left", "right"))]
    faceless = Skeleton(skeleton.times, skeleton.positions[:, seen], tuple(skeleton.joints[i] for i in seen))
    np.testing.assert_allclose(match_hands(faceless, asked, ROBOT)[-1, ARMS], asked[-1, ARMS], atol=1e-3)


def pointing(way, frames=40):
    """A standing person whose right palm goes to the face and ends there, `way` (3,) from the middle of the head."""
    skeleton = standing(np.arange(frames) / 30.0)
    share = np.clip(skeleton.times, 0.0, 1.0)[:, None]
    goal = skeleton.track("head") + 0.085 * HEIGHT * np.array(way)
    begin, shoulder = skeleton.track("right_wrist"), skeleton.track("right_shoulder")
    hand = begin + share * (goal - begin) + share * (1.0 - share) * [1.0, 0.0, 0.0]  # in a bow in front of the body
    upper, lower = 0.172 * HEIGHT, 0.196 * HEIGHT
    far = np.linalg.norm(hand - shoulder, axis=1, keepdims=True)
    along = (hand - shoulder) / far
    before = (upper**2 - lower**2 + far**2) / (2.0 * far)  # where the elbow is seen from the line shoulder to hand
    out = np.cross(along, np.cross([0.2, -0.6, -0.8], along))
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    elbow = shoulder + before * along + np.sqrt(np.maximum(upper**2 - before**2, 0.0)) * out
    points = np.array(skeleton.positions)
    points[:, skeleton.joints.index("right_elbow")] = elbow
    points[:, skeleton.joints.index("right_wrist")] = elbow + (hand - elbow) * 0.146 / 0.196
    return Skeleton(skeleton.times, np.concatenate([points, hand[:, None]], axis=1), (*skeleton.joints, "right_hand"))


@pytest.mark.parametrize(
    ("where", "way"), [("mouth", (0.9, 0.0, -0.44)), ("eyes", (1.0, 0.0, 0.1)), ("forehead", (0.8, 0.0, 0.6))]
)
def test_a_hand_at_the_face_ends_at_the_same_place_of_the_robots_face(where, way):
    skeleton = pointing(way)
    matched = match_hands(skeleton, one_to_one(skeleton, ROBOT), ROBOT)
    away = palms(matched)[-1, 1] - [-0.001, 0.0, 0.1835]
    apart = np.arccos(away @ way / np.linalg.norm(away) / np.linalg.norm(way))
    assert np.degrees(apart) < 10.0, where
    assert np.linalg.norm(away) < 0.11  # of which the head's radius and half the hand take 0.08
    assert smallest_distance(matched) > GUARDED


def test_progress_is_told_and_one_frame_is_enough():
    skeleton, asked = somebody(4, frames=1)
    told = []
    matched = match_hands(skeleton, asked, ROBOT, lambda done, total: told.append((done, total)))
    assert told == [(1, 1)]
    assert errors(skeleton, matched).mean() < errors(skeleton, asked).mean() + 1e-3


@pytest.mark.parametrize("seed", [0, 1])
def test_the_guard_leaves_matched_hands_alone(seed):
    """Slowly enough, what is matched can be done: the clearance is the guard's and more."""
    assert CLEARANCE > GUARDED
    skeleton, asked = somebody(seed)
    motion = JointTrajectory(skeleton.times, match_hands(skeleton, asked, ROBOT))
    assert smallest_distance(motion.sample(np.linspace(0.0, motion.duration, 60))) > GUARDED - 0.002
