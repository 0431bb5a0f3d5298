from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.imitation.head import HEAD_JOINTS, NOSE_DROP, head_positions
from nao_sim.motion import Skeleton

BODY = {
    "left_shoulder": (0.0, 0.18, 1.40),
    "right_shoulder": (0.0, -0.18, 1.40),
    "pelvis": (0.0, 0.0, 0.95),
    "neck": (0.0, 0.0, 1.45),
}
FACE = {  # from between the ears
    "left_ear": (0.0, 0.075, 0.0),
    "right_ear": (0.0, -0.075, 0.0),
    "left_eye": (0.085, 0.03, 0.03),
    "right_eye": (0.085, -0.03, 0.03),
    "nose": (0.12, 0.0, -0.03),
}
EARS = np.array([0.02, 0.0, 1.6])
yaws = st.floats(-1.5, 1.5)
pitches = st.floats(-0.6, 0.45)


def person(yaw: float, pitch: float, without: tuple[str, ...] = (), turned: float = 0.0) -> Skeleton:
    turn = Rotation.from_euler("ZY", (yaw, pitch))
    tracks = dict(BODY) | {name: turn.apply(place) + EARS for name, place in FACE.items()}
    tracks["head"] = turn.apply((0.0, 0.0, 0.05)) + EARS
    names = tuple(name for name in tracks if name not in without)
    places = Rotation.from_euler("Z", turned).apply(np.array([tracks[name] for name in names]))
    return Skeleton(np.array([0.0]), places[None], names)


def head_of(skeleton: Skeleton, robot, **given_) -> np.ndarray:
    positions = head_positions(skeleton, **given_)
    joints = [robot.index[name] for name in HEAD_JOINTS]
    assert np.isnan(np.delete(positions, joints, axis=1)).all()
    return positions[:, joints]


@given(yaws, pitches, st.floats(-3.0, 3.0))
@settings(max_examples=50)
def test_the_robot_looks_where_the_face_looks(robot, yaw, pitch, turned):
    np.testing.assert_allclose(head_of(person(yaw, pitch, turned=turned), robot)[0], (yaw, pitch), atol=1e-6)


def test_the_tip_of_the_nose_alone_is_known_to_lie_low(robot):
    eyeless = head_of(person(0.4, 0.0, ("left_eye", "right_eye")), robot)[0]
    assert eyeless == pytest.approx((0.4, 0.0), abs=abs(np.arctan2(0.03, 0.12) - NOSE_DROP) + 1e-9)


def test_no_angle_leaves_the_robot_s_limits(robot):
    for pitch in (-1.5, 1.5):
        yaw, nod = head_of(person(2.5, pitch), robot)[0]
        assert robot.lower[0] <= yaw <= robot.upper[0]
        assert robot.lower[1] <= nod <= robot.upper[1]


@given(yaws, pitches)
@settings(max_examples=30)
def test_the_mirrored_person_looks_the_mirrored_way(robot, yaw, pitch):
    somebody = person(yaw, pitch)
    mirrored = robot.mirror(head_positions(somebody))
    np.testing.assert_allclose(head_positions(somebody.mirrored()), mirrored, atol=1e-12)


def nodding(leans: np.ndarray, tilt: float) -> Skeleton:
    """Somebody without a face whose sensor sees them lean by `tilt` when upright."""
    angles = leans + tilt
    head = np.stack([0.2 * np.sin(angles), np.zeros_like(angles), 1.45 + 0.2 * np.cos(angles)], axis=1)
    tracks = [np.tile(place, (len(leans), 1)) for place in BODY.values()] + [head]
    return Skeleton(np.arange(len(leans)) / 30.0, np.stack(tracks, axis=1), (*BODY, "head"))


@pytest.mark.parametrize("tilt", [0.0, 0.35])
def test_without_a_face_only_the_nod_is_known_whatever_the_sensor_calls_upright(robot, tilt):
    leans = np.array([0.0, 0.0, 0.3, 0.0, -0.2])
    angles = head_of(nodding(leans, tilt), robot)
    assert np.isnan(angles[:, 0]).all()
    np.testing.assert_allclose(angles[:, 1], leans, atol=1e-9)


def test_a_stream_is_told_what_counts_as_upright(robot):
    whole = nodding(np.array([0.0, 0.0, 0.3]), 0.2)
    last = replace(whole, times=whole.times[:1], positions=whole.positions[2:], confidence=whole.confidence[2:])
    assert head_of(last, robot, upright=0.2)[0, 1] == pytest.approx(0.3)


def test_a_camera_without_depth_sees_the_head_turn(robot):
    flat = person(0.0, 0.0).positions * (0.0, 1.0, 1.0)
    turned = person(0.5, 0.0).positions * (0.0, 1.0, 1.0)
    both = Skeleton(np.array([0.0, 1.0]), np.concatenate([flat, turned]), person(0.0, 0.0).joints, planar=True)
    yaw = head_of(both, robot)[:, 0]
    assert yaw[0] == pytest.approx(0.0, abs=1e-6)
    assert yaw[1] == pytest.approx(0.5, abs=0.15)


def test_nobody_s_head_asks_for_nothing(robot):
    nobody = Skeleton(
        np.array([0.0]), np.array([[[0.0, 0.2, 1.4], [0.0, -0.2, 1.4]]]), ("left_shoulder", "right_shoulder")
    )
    assert np.isnan(head_positions(nobody)).all()
