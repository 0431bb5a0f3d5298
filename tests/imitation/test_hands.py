import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.imitation.hands import FINGERS, hand_opening, hand_positions
from nao_sim.motion import Skeleton

BODY = {"left_shoulder": (0.0, 0.18, 1.40), "right_shoulder": (0.0, -0.18, 1.40), "pelvis": (0.0, 0.0, 0.95)}
KNUCKLES = {"index": 0.03, "middle": 0.01, "ring": -0.01, "pinky": -0.03}  # m along the palm, thumb's side positive
BONES = (0.045, 0.025, 0.02)
unit = st.floats(0.0, 1.0)


def arms_of(robot, shares) -> np.ndarray:
    return (robot.lower + np.asarray(shares) * (robot.upper - robot.lower))[None]


def person(robot, arms: np.ndarray, bend: float) -> Skeleton:
    """Somebody whose hands stand as the robot's would, the fingers bent by `bend` rad at each joint."""
    tracks = dict(BODY)
    for side in ("left", "right"):
        joints = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw")
        p, r, y, b, w = (arms[0, robot.index[side[0].upper() + name]] for name in joints)
        hand = Rotation.from_euler("YZX", (p, r, y)) * Rotation.from_euler("ZX", (b, w))
        inwards = -1.0 if side == "left" else 1.0  # the palm looks inwards, and the fingers bend that way
        wrist = np.add(BODY[f"{side}_shoulder"], (0.4, 0.0, 0.0))
        tracks[f"{side}_wrist"] = wrist
        for finger, height in KNUCKLES.items():
            place = np.array([0.09, 0.0, height])
            tracks[f"{side}_{finger}_mcp"] = wrist + hand.apply(place)
            for number, (joint, length) in enumerate(zip(("pip", "dip", "tip"), BONES, strict=True), 1):
                place = place + length * np.array([np.cos(number * bend), inwards * np.sin(number * bend), 0.0])
                tracks[f"{side}_{finger}_{joint}"] = wrist + hand.apply(place)
    return Skeleton(np.array([0.0]), np.array(list(tracks.values()))[None], tuple(tracks))


@given(st.lists(unit, min_size=26, max_size=26))
@settings(max_examples=50)
def test_the_robot_s_wrists_turn_as_the_person_s(robot, shares):
    arms = arms_of(robot, shares)
    yaws = [robot.index["LWristYaw"], robot.index["RWristYaw"]]
    found = hand_positions(person(robot, arms, 0.0), arms)
    np.testing.assert_allclose(found[:, yaws], arms[:, yaws], atol=1e-9)
    hands = [robot.index["LHand"], robot.index["RHand"]]
    assert np.isnan(np.delete(found, yaws + hands, axis=1)).all()


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_flat_hand_is_open_a_fist_is_closed_and_between_it_closes_steadily(robot, side):
    arms = arms_of(robot, [0.5] * 26)
    openings = [hand_opening(person(robot, arms, bend), side)[0] for bend in np.linspace(0.0, np.pi / 2, 12)]
    assert openings[0] == 1.0
    assert openings[-1] < 0.25
    assert (np.diff(openings) <= 1e-12).all()


@given(st.lists(unit, min_size=26, max_size=26), st.floats(0.0, 1.5))
@settings(max_examples=30)
def test_the_mirrored_person_s_hands_are_mirrored(robot, shares, bend):
    arms = arms_of(robot, shares)
    somebody = person(robot, arms, bend)
    mirrored = hand_positions(somebody.mirrored(), robot.mirror(arms))
    np.testing.assert_allclose(mirrored, robot.mirror(hand_positions(somebody, arms)), atol=1e-9)


def test_hands_without_finger_joints_ask_for_nothing(robot):
    arms = arms_of(robot, [0.5] * 26)
    whole = person(robot, arms, 0.0)
    kept = [i for i, name in enumerate(whole.joints) if not any(finger in name for finger in FINGERS)]
    bare = Skeleton(whole.times, whole.positions[:, kept], tuple(whole.joints[i] for i in kept))
    assert np.isnan(hand_positions(bare, arms)).all()


def test_a_camera_without_depth_cannot_tell_how_a_palm_is_turned(robot):
    arms = arms_of(robot, [0.5] * 26)
    seen = person(robot, arms, 0.0)
    flat = Skeleton(seen.times, seen.positions, seen.joints, planar=True)
    assert np.isnan(hand_positions(flat, arms)[:, robot.index["LWristYaw"]]).all()
