"""Directions of the arms to NAO's angles, against its kinematics."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from nao_sim.imitation.arms import (
    angle_between,
    arm_angles,
    arm_directions_of,
    arm_positions,
    direction_error,
    left_arm_angles,
)
from nao_sim.imitation.features import LEFT, RIGHT
from tests.imitation.arm_kinematics import ROBOT, X, forward, joints, random_poses, unit

TURN = ROBOT.upper[ROBOT.index["LShoulderPitch"]]


def one(upper_arm, forearm, side=LEFT, **options):
    return arm_angles(np.array([upper_arm], float), np.array([forearm], float), side, **options)[0]


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_any_pose_within_the_limits_is_found_again(side):
    poses = random_poses(side)
    np.testing.assert_allclose(arm_angles(*forward(poses, side), side), poses, atol=1e-9)


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_the_length_of_a_segment_does_not_matter(side):
    upper_arm, forearm = forward(poses := random_poses(side, 50), side)
    np.testing.assert_allclose(arm_angles(upper_arm * 0.3, forearm * 250.0, side), poses, atol=1e-9)


def directions(seed, count=200):
    return np.random.default_rng(seed).normal(size=(2, count, 3))


@given(seed=st.integers(0, 10_000))
def test_the_right_arm_is_the_left_one_in_a_mirror(seed):
    upper_arm, forearm = directions(seed, 20)
    left = arm_angles(upper_arm, forearm, LEFT)
    right = arm_angles(upper_arm * [1, -1, 1], forearm * [1, -1, 1], RIGHT)
    np.testing.assert_array_equal(right, left * [1, -1, -1, -1])
    assert ROBOT.mirror_sign[joints(LEFT)].tolist() == [1, -1, -1, -1]


@given(seed=st.integers(0, 10_000))
def test_the_forearm_points_right_from_wherever_the_upper_arm_is_taken_to(seed):
    """Easing ShoulderPitch near the shoulder axis tilts the upper arm, never the elbow's bend in it."""
    upper_arm, forearm = directions(seed, 20)
    upper_arm[:, 1] += 5.0  # near the shoulder axis
    angles = arm_angles(upper_arm, forearm, LEFT)
    bent = np.abs(np.sin(angles[:, 3])) > np.sin(-ROBOT.upper[ROBOT.index["LElbowRoll"]])
    unit = forearm / np.linalg.norm(forearm, axis=1, keepdims=True)
    np.testing.assert_allclose(forward(angles, LEFT)[1][bent], unit[bent], atol=1e-9)


def test_an_arm_along_the_shoulder_axis_keeps_its_pitch():
    assert one([0, 1, 0], [0, 1, 0])[:2] == pytest.approx([0.0, np.pi / 2])
    assert one([0, 1, 0], [0, 1, 0], previous=[1.1, 0.4, -0.5, -0.3])[0] == 1.1
    assert one([0, -1, 0], [0, -1, 0], RIGHT, previous=[1.1, -0.4, 0.5, 0.3])[0] == 1.1


def test_a_straight_elbow_keeps_its_yaw():
    assert one([1, 0, 0], [1, 0, 0])[2:] == pytest.approx([0.0, 0.0])
    kept = one([1, 0, 0], [1, 0, 0], previous=[0.2, 0.0, -1.2, -0.6])
    assert kept[2] == -1.2 and kept[3] == 0.0
    assert one([1, 0, 0], [1, 0, 0], RIGHT, previous=[0.2, 0.0, 1.2, 0.6])[2] == 1.2


def test_the_branch_is_kept_from_frame_to_frame():
    poses = np.array([[0.5, 0.3, -1.0, -0.5], [0.5, 0.3, -1.0, 0.0], [0.5, 0.3, -1.0, -0.5]])
    np.testing.assert_allclose(arm_angles(*forward(poses, LEFT), LEFT), poses, atol=1e-9)


@pytest.mark.parametrize("tilt", np.linspace(0.0, 2.0 * np.pi, 7))
def test_a_small_change_near_a_singular_posture_is_a_small_change_of_angles(tilt):
    """From a hair beside the shoulder axis, and beside a straight elbow, out to the regular region."""
    previous = [0.6, 1.2, -0.8, -0.2]
    for off in (1e-12, 1e-9, 1e-6, 1e-4):
        beside = [off * np.cos(tilt), 1.0, off * np.sin(tilt)]
        assert one(beside, [1, 0, 0], previous=previous)[0] == pytest.approx(0.6, abs=1e-3)
        beside = [1.0, off * np.cos(tilt), off * np.sin(tilt)]
        assert one([1, 0, 0], beside, previous=previous)[2] == pytest.approx(-0.8, abs=1e-3)


def test_angles_are_continuous_in_the_directions_for_a_given_previous_frame():
    rng, previous = np.random.default_rng(3), np.array([0.3, 0.5, -0.6, -0.7])
    sweep = np.linspace(0.0, 1.0, 4001)[:, None]
    start, end = forward(previous[None], LEFT), forward(np.array([[-0.9, 1.32, 0.9, -0.036]]), LEFT)
    for _ in range(5):
        bump = 0.3 * rng.normal(size=(2, 3)) * np.sin(np.pi * sweep)[:, None]
        upper_arm = start[0] + sweep * (end[0] - start[0]) + bump[:, 0]
        forearm = start[1] + sweep * (end[1] - start[1]) + bump[:, 1]
        arms = np.stack([upper_arm, forearm], axis=1)[None]  # side by side, each from the same frame before
        angles = left_arm_angles(arms, np.tile(previous, (len(sweep), 1)))[0]
        step = np.abs(np.angle(np.exp(1j * np.diff(angles[:, [1, 3]], axis=0))))
        assert step.max() < 0.02


@pytest.mark.parametrize("column", [0, 2])
def test_an_angle_goes_on_past_half_a_turn_until_the_other_end_is_nearer(column):
    limit = ROBOT.upper[ROBOT.index["LShoulderPitch"]]
    poses = np.tile([0.2, 0.3, 0.1, -0.9], (720, 1))
    poses[:, column] = np.linspace(0.0, 2.0 * np.pi, len(poses))
    angles = arm_angles(*forward(poses, LEFT), LEFT)[:, column]
    jumps = np.flatnonzero(np.abs(np.diff(angles)) > 0.1)
    assert len(jumps) == 1
    assert angles[jumps[0]] == pytest.approx(2.0 * np.pi - limit, abs=0.02)
    assert angles[jumps[0] + 1] == pytest.approx(-limit, abs=0.02)


def test_noise_about_half_a_turn_does_not_throw_the_arm_round():
    rng = np.random.default_rng(1)
    poses = np.tile([np.pi, 0.3, 0.1, -0.9], (500, 1))
    poses[:, 0] += 0.05 * rng.normal(size=500)
    poses[0, 0] = 3.0
    angles = arm_angles(*forward(poses, LEFT), LEFT)
    assert np.abs(np.diff(angles[:, 0])).max() < 0.5


@pytest.mark.parametrize("lost", [[0.0, 0.0, 0.0], [np.nan, 0.0, 0.0], [np.inf, 0.0, 0.0]])
def test_a_direction_that_is_not_known_asks_nothing_and_is_forgotten(lost):
    poses = np.array([[0.5, 0.3, -1.0, -0.5]] * 4)
    upper_arm, forearm = forward(poses, LEFT)
    upper_arm, forearm = upper_arm.copy(), forearm.copy()
    upper_arm[1], forearm[2] = lost, lost
    angles = arm_angles(upper_arm, forearm, LEFT)
    expected = poses.copy()
    expected[1], expected[2, 2:] = np.nan, np.nan
    np.testing.assert_allclose(angles, expected, atol=1e-9)


def test_frames_one_by_one_are_the_same_as_all_at_once():
    upper_arm, forearm = directions(7)
    state, angles = np.zeros(4), []
    for u, f in zip(upper_arm, forearm, strict=True):
        state = arm_angles(u[None], f[None], RIGHT, state)[0]
        angles.append(state)
    np.testing.assert_allclose(angles, arm_angles(upper_arm, forearm, RIGHT), atol=1e-12)


def test_both_arms_go_to_their_places_in_the_joint_vector():
    left, right = random_poses(LEFT, 5, 1), random_poses(RIGHT, 5, 2)
    arms = np.stack([np.stack(forward(left, LEFT), axis=1), np.stack(forward(right, RIGHT), axis=1)], axis=1)
    positions = arm_positions(arms)
    np.testing.assert_allclose(positions[:, joints(LEFT)], left, atol=1e-9)
    np.testing.assert_allclose(positions[:, joints(RIGHT)], right, atol=1e-9)
    assert np.isfinite(positions).sum() == 5 * 8
    straight = np.tile(X, (1, 2, 2, 1))
    assert arm_positions(straight, positions[-1])[0, joints(RIGHT)[2]] == positions[-1, joints(RIGHT)[2]]


def test_easing_meets_the_formula_smoothly_at_the_edge_of_the_robots_reach():
    edge = np.cos(ROBOT.upper[ROBOT.index["LShoulderRoll"]])
    for inside, expected in ((1.0, -1.0), (0.999, -1.0), (0.5, -0.2), (1e-3, 0.6)):
        off = edge * inside
        upper_arm = [off * np.cos(1.0), np.sqrt(1.0 - off * off), off * np.sin(1.0)]  # ShoulderPitch -1
        pitch = one(upper_arm, [1, 0, 0], previous=[0.6, 1.2, -0.8, -0.2])[0]
        assert pitch == pytest.approx(expected, abs=1e-5)


def one_by_one(upper_arm, forearm, side, previous):
    """The rule as it reads: frame after frame, each from the last known angles."""
    signs = np.array([1.0, -1.0, -1.0, -1.0]) if side == RIGHT else np.ones(4)
    mirror = [1.0, -1.0 if side == RIGHT else 1.0, 1.0]
    state, angles = np.array(previous) * signs, []
    for u, f in zip(upper_arm * mirror, forearm * mirror, strict=True):
        angles.append(left_arm(u, f, state))
        state = np.where(np.isfinite(angles[-1]), angles[-1], state)
    return np.array(angles) * signs


def left_arm(upper_arm, forearm, previous):
    x, y, z = upper_arm.tolist()
    length = math.hypot(x, y, z)
    if not (math.isfinite(length) and length > 0.0):
        return [math.nan] * 4
    roll_end, bend_end = ROBOT.upper[ROBOT.index["LShoulderRoll"]], -ROBOT.upper[ROBOT.index["LElbowRoll"]]
    pitch = follow(math.atan2(-z, x), previous[0], math.hypot(x, z) / length / math.cos(roll_end))
    roll = math.atan2(y, math.hypot(x, z))
    x, y, z = (rotation("z", -roll) @ rotation("y", -pitch) @ forearm).tolist()
    length = math.hypot(x, y, z)
    if not (math.isfinite(length) and length > 0.0):
        return [pitch, roll, math.nan, math.nan]
    across = math.hypot(y, z)
    yaw = follow(math.atan2(-z, -y), previous[2], across / length / math.sin(bend_end))
    return [pitch, roll, yaw, -math.atan2(across, x)]


def rotation(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]] if axis == "y" else [[c, -s, 0], [s, c, 0], [0, 0, 1]])


def follow(angle, previous, trust):
    trust = min(trust, 1.0)
    angle = previous + trust * trust * (3.0 - 2.0 * trust) * math.remainder(angle - previous, math.tau)
    return angle - math.copysign(math.tau, angle) if abs(angle) > math.tau - TURN else angle


@settings(max_examples=50)
@given(seed=st.integers(0, 2**32 - 1), side=st.sampled_from([LEFT, RIGHT]))
def test_all_frames_at_once_are_the_rule_frame_after_frame(seed, side):
    """Any mixture of postures: anywhere, near the shoulder axis, with a straight elbow, slow, lost."""
    rng = np.random.default_rng(seed)
    upper_arm, forearm = rng.normal(size=(2, 40, 3))
    near = 10.0 ** rng.uniform(-12.0, 0.0, size=(2, 40, 1))
    kind = rng.integers(0, 4, size=40)
    upper_arm = np.where((kind == 1)[:, None], [0.0, rng.choice([-1.0, 1.0]), 0.0] + near[0] * upper_arm, upper_arm)
    forearm = np.where((kind == 2)[:, None], rng.choice([-1.0, 1.0]) * upper_arm + near[1] * forearm, forearm)
    lost = rng.integers(0, 12, size=(2, 40))
    upper_arm[lost[0] == 0], forearm[lost[1] == 0] = np.nan, 0.0
    if rng.random() < 0.5:
        upper_arm, forearm = np.cumsum(0.2 * upper_arm, axis=0), np.cumsum(0.2 * forearm, axis=0)
    previous = rng.uniform(-2.0, 2.0, 4)
    expected = one_by_one(upper_arm, forearm, side, previous)
    np.testing.assert_allclose(arm_angles(upper_arm, forearm, side, previous), expected, rtol=0, atol=1e-9)


@given(values=arrays(float, (6, 2, 2, 3), elements=st.floats(width=64)))
def test_whatever_the_directions_the_answer_is_angles_or_nan(values):
    angles = arm_positions(values)
    assert not np.isinf(angles).any()
    for side in (LEFT, RIGHT):
        lost = ~np.isfinite(values[:, side]).all(axis=-1)
        assert np.isnan(angles[:, joints(side)][lost[:, 0]]).all()
        assert np.isnan(angles[:, joints(side)][lost[:, 1]][:, 2:]).all()


def test_no_frames_are_no_angles():
    assert arm_angles(np.empty((0, 3)), np.empty((0, 3)), LEFT).shape == (0, 4)
    assert arm_positions(np.empty((0, 2, 2, 3))).shape == (0, 26)


def test_a_previous_angle_that_is_not_known_counts_as_rest():
    straight = np.tile(X, (1, 2, 2, 1))
    np.testing.assert_array_equal(arm_positions(straight, np.full(26, np.nan)), arm_positions(straight))
    assert one([0, 1, 0], [0, 1, 0], previous=[np.nan, 0.4, -0.5, -0.3])[0] == 0.0


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_the_robots_directions_are_those_of_its_kinematics(side):
    positions = np.full((200, 26), np.nan)
    positions[:, joints(side)] = random_poses(side, 200, 4)
    directions = arm_directions_of(positions)
    np.testing.assert_allclose(
        directions[:, side], np.stack(forward(positions[:, joints(side)], side), axis=1), rtol=0, atol=1e-12
    )
    assert np.isnan(directions[:, 1 - side]).all()


def test_a_joint_that_is_not_known_hides_what_it_turns():
    positions = np.zeros((3, 26))
    positions[1, joints(LEFT)[0]], positions[2, joints(LEFT)[3]] = np.inf, np.nan
    known = np.isfinite(arm_directions_of(positions)).all(axis=-1)
    np.testing.assert_array_equal(known[:, LEFT], [[True, True], [False, False], [True, False]])
    assert known[:, RIGHT].all()


@given(seed=st.integers(0, 10_000), scale=st.floats(1e-150, 1e150))
def test_closed_form_and_kinematics_are_inverse_whatever_the_length(seed, scale):
    directions = np.random.default_rng(seed).normal(size=(20, 2, 2, 3))
    directions[..., 0] += np.sign(directions[..., 0])  # off the shoulder axis
    error = direction_error(arm_positions(directions), directions * scale)
    across = np.linalg.norm(np.cross(unit(directions[:, :, 0]), unit(directions[:, :, 1])), axis=-1)
    assert error[..., 0].max() < 1e-9 and error[..., 1][across > 0.035].max(initial=0.0) < 1e-9


def test_angles_between_vectors_are_exact_where_acos_is_not():
    tiny = 1e-9
    others = np.array([[1.0, tiny, 0], [-1.0, tiny, 0], [0, 3.0, 0], [0, 0, 0], [np.nan, 0, 0], [np.inf, 0, 0]])
    expected = [tiny, np.pi - tiny, np.pi / 2, np.nan, np.nan, np.nan]
    np.testing.assert_allclose(angle_between(X, others), expected, rtol=0, atol=1e-15)
