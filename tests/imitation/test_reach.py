"""The nearest place within the limits, of the shoulder alone and of the elbow alone, against all places."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.imitation.features import LEFT, RIGHT
from nao_sim.imitation.reach import arm_limits, nearest_elbow, nearest_shoulder, upper_arm_error
from tests.imitation.arm_kinematics import ROBOT, errors, forward, limits, random_poses, unit

LIMITS = arm_limits(ROBOT)
LOWER, UPPER = limits(LEFT)
DIRECTIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 1e-3).map(np.array).map(unit)


def places(first, last, count=90):
    """All angles (count^2, 4) of two joints at an even distance, the others 0."""
    ends = (np.linspace(LOWER[i], UPPER[i], count) for i in (first, last))
    angles = np.zeros((count * count, 4))
    angles[:, [first, last]] = np.stack(np.meshgrid(*ends), axis=-1).reshape(-1, 2)
    return angles


UPPER_ARMS, FOREARMS = forward(places(0, 1), LEFT)[0], forward(places(2, 3), LEFT)[1]


def test_the_limits_are_the_documented_ones_and_the_same_on_both_sides():
    assert (LIMITS.pitch, LIMITS.yaw) == (2.0857, 2.0857)
    assert LIMITS.roll == (-0.3142, 1.3265) and LIMITS.bend == (0.0349, 1.5446)
    for joint in (0, 2):
        assert LOWER[joint] == -UPPER[joint]
    signs = ROBOT.mirror_sign[[ROBOT.index["L" + name[1:]] for name in np.array(ROBOT.joint_names)[RIGHT_ARM]]]
    ends = np.sort(np.stack(limits(RIGHT)) * signs, axis=0)
    np.testing.assert_array_equal(ends, np.stack([LOWER, UPPER]))


RIGHT_ARM = [ROBOT.index["R" + name] for name in ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll")]


@given(wanted=DIRECTIONS)
def test_no_place_of_the_shoulder_is_nearer(wanted):
    shoulder = nearest_shoulder(wanted[:, None], LIMITS)
    error = upper_arm_error(wanted[:, None], shoulder)[0]
    assert (shoulder[:, 0] >= LOWER[:2]).all() and (shoulder[:, 0] <= UPPER[:2]).all()
    nearest = 2.0 * np.arcsin(np.linalg.norm(UPPER_ARMS - wanted, axis=1).min() / 2)
    assert error <= nearest + 1e-12 and nearest - error < np.radians(3.0)


@given(wanted=DIRECTIONS, seed=st.integers(0, 1000))
def test_no_place_of_the_elbow_is_nearer(wanted, seed):
    shoulder = random_poses(LEFT, 1, seed)[:, :2].T
    *elbow, error = nearest_elbow(wanted[:, None], shoulder, LIMITS)
    angles = np.concatenate([shoulder, elbow]).T
    assert (angles >= LOWER).all() and (angles <= UPPER).all()
    reached, turned = forward(angles, LEFT)[1][0], FOREARMS @ shoulder_matrix(shoulder).T
    assert abs(2.0 * np.arcsin(min(np.linalg.norm(reached - wanted) / 2, 1.0)) - error[0]) < 1e-9
    nearest = 2.0 * np.arcsin(min(np.linalg.norm(turned - wanted, axis=1).min() / 2, 1.0))
    assert error[0] <= nearest + 1e-12 and nearest - error[0] < np.radians(3.0)


def shoulder_matrix(shoulder):
    """Columns: where the shoulder takes x, y and z."""
    (pitch,), (roll,) = shoulder
    c, s, cr, sr = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    return np.array([[c * cr, -c * sr, s], [sr, cr, 0.0], [-s * cr, s * sr, c]])


@given(wanted=DIRECTIONS)
def test_the_other_end_of_a_joint_is_where_it_is_told_to_stay(wanted):
    rest = np.zeros((2, 1))
    for end in (-1.0, 1.0):
        pitch, _ = nearest_shoulder(wanted[:, None], LIMITS, np.array([end]))
        yaw, _, _ = nearest_elbow(wanted[:, None], rest, LIMITS, np.array([end]))
        if np.abs(np.arctan2(-wanted[2], wanted[0])) > LIMITS.pitch:
            assert pitch[0] == end * LIMITS.pitch
        if np.abs(np.arctan2(-wanted[2], -wanted[1])) > LIMITS.yaw:
            assert yaw[0] == end * LIMITS.yaw


@given(seed=st.integers(0, 10_000))
def test_an_arm_within_the_limits_is_reached(seed):
    poses = random_poses(LEFT, 20, seed)
    upper_arm, forearm = forward(poses, LEFT)
    shoulder = nearest_shoulder(upper_arm.T, LIMITS)
    *elbow, error = nearest_elbow(forearm.T, shoulder, LIMITS)
    assert error.max() < 1e-9
    assert errors(np.concatenate([shoulder, elbow]).T, upper_arm, forearm).max() < 1e-9
