"""The nearest that NAO's arm can do, against brute force and the laws of mirror, stream and continuity."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from nao_sim.imitation import feasible
from nao_sim.imitation.arms import angle_between, arm_directions_of, arm_positions, direction_error
from nao_sim.imitation.feasible import feasible_angles, feasible_positions
from nao_sim.imitation.features import FOREARM, LEFT, RIGHT, UPPER_ARM
from tests.imitation.arm_kinematics import ROBOT, X, errors, forward, joints, limits, random_poses, unit

LOWER, UPPER = limits(LEFT)
ROLL_END, BENDS = UPPER[1], (-UPPER[3], -LOWER[3])
SEEDS = st.integers(0, 2**32 - 1)
ARMS = joints(LEFT) + joints(RIGHT)


def one(upper_arm, forearm, previous=(0.0, 0.0, 0.0, 0.0), side=LEFT):
    return feasible_angles(np.array([upper_arm], float), np.array([forearm], float), side, ROBOT, previous)[0]


def near(base, off, rng):
    return unit(base + off * rng.normal(size=np.shape(base)))


def hard_directions(seed, count):
    """Pairs of unit vectors: anywhere, near the shoulder axis, with a straight or a folded elbow."""
    rng = np.random.default_rng(seed)
    upper_arm, forearm = unit(rng.normal(size=(2, count, 3)))
    kind, off = rng.integers(0, 6, size=(count, 1)), 10.0 ** rng.uniform(-4.0, -0.5, size=(count, 1))
    upper_arm = np.where(kind == 1, near(np.tile([0.0, 1.0, 0.0], (count, 1)), off, rng), upper_arm)
    forearm = np.where(kind == 2, near(upper_arm, off, rng), np.where(kind == 3, near(-upper_arm, off, rng), forearm))
    return upper_arm, forearm


def grid(first, last, counts):
    ends = (np.linspace(LOWER[i], UPPER[i], n) for i, n in zip((first, last), counts, strict=True))
    angles = np.zeros((counts[0] * counts[1], 4))
    angles[:, [first, last]] = np.stack(np.meshgrid(*ends, indexing="ij"), axis=-1).reshape(-1, 2)
    return angles


SHOULDERS, ELBOWS = grid(0, 1, (25, 11)), grid(2, 3, (25, 10))
STENCIL = np.stack(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 4), axis=-1).reshape(-1, 4)


def turned(vector):
    """`vector` as the upper arm sees it in each of `SHOULDERS`."""
    pitch, roll = SHOULDERS[:, 0], SHOULDERS[:, 1]
    ahead = np.cos(pitch) * vector[0] - np.sin(pitch) * vector[2]
    up = np.sin(pitch) * vector[0] + np.cos(pitch) * vector[2]
    side = np.cos(roll) * vector[1] - np.sin(roll) * ahead
    return np.stack([np.cos(roll) * ahead + np.sin(roll) * vector[1], side, up], axis=-1)


def brute_force(upper_arm, forearm):
    """The least sum of both errors on a grid of all four joints, refined around the best six shoulders."""
    shoulder = np.arccos(np.clip(turned(upper_arm)[:, 0], -1.0, 1.0))
    elbow = np.arccos(np.clip(turned(forearm) @ forward(ELBOWS, LEFT)[1].T, -1.0, 1.0))
    start = np.argsort(shoulder + elbow.min(axis=1))[:6]
    poses, radius = SHOULDERS[start] + ELBOWS[elbow[start].argmin(axis=1)], np.radians(10.0)
    for _ in range(20):
        around = np.clip(poses[:, None] + radius * STENCIL, LOWER, UPPER)
        total = errors(around.reshape(-1, 4), upper_arm, forearm).sum(axis=1).reshape(around.shape[:2])
        poses, radius = around[np.arange(len(poses)), total.argmin(axis=1)], 0.65 * radius
    return total.min()


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_the_mean_error_is_within_half_a_degree_of_brute_force(side):
    upper_arm, forearm = hard_directions(side, 80)
    mirror = [1.0, -1.0 if side == RIGHT else 1.0, 1.0]
    angles = feasible_angles(upper_arm * mirror, forearm * mirror, side, ROBOT)
    ours = errors(angles, upper_arm * mirror, forearm * mirror, side).sum(axis=1)
    excess = np.degrees(ours - [brute_force(u, f) for u, f in zip(upper_arm, forearm, strict=True)]) / 2.0
    assert excess.max() < 0.4  # one batch of frames that have nothing to do with each other
    assert -0.1 < excess.mean() < 0.1  # brute force is as good, and we are


@given(seed=SEEDS)
@settings(max_examples=30)
def test_whatever_the_frame_before_the_answer_is_next_to_the_best(seed):
    upper_arm, forearm = hard_directions(seed, 30)
    fresh = np.array([one(u, f) for u, f in zip(upper_arm, forearm, strict=True)])
    batch = feasible_angles(upper_arm, forearm, LEFT, ROBOT, random_poses(LEFT, 1, seed)[0])
    apart = errors(batch, upper_arm, forearm).sum(axis=1) - errors(fresh, upper_arm, forearm).sum(axis=1)
    assert np.degrees(np.abs(apart)).max() / 2.0 < 0.35


@given(values=arrays(float, (5, 2, 2, 3), elements=st.floats(width=64) | st.sampled_from([0.0, 1.0, -1.0, 1e-9])))
def test_whatever_the_directions_the_limits_are_kept_and_only_what_is_lost_is_nan(values):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        positions = feasible_positions(values, ROBOT)
    known = np.isfinite(positions)
    assert not np.isinf(positions).any() and not known[:, np.setdiff1d(range(26), ARMS)].any()
    told = np.where(known, positions, ROBOT.lower)
    assert (told >= ROBOT.lower).all() and (told <= ROBOT.upper).all()
    with np.errstate(over="ignore", invalid="ignore"):
        length = np.hypot(np.hypot(values[..., 0], values[..., 2]), values[..., 1])
    has = np.isfinite(length) & (length > 0.0)
    for side in (LEFT, RIGHT):
        assert (known[:, joints(side)[:2]] == has[:, side, UPPER_ARM, None]).all()
        assert (known[:, joints(side)[2:]] == has[:, side].all(axis=1)[:, None]).all()


@given(seed=SEEDS, side=st.sampled_from([LEFT, RIGHT]))
def test_a_pose_within_the_limits_is_found_again_whatever_came_before(seed, side):
    poses = random_poses(side, 20, seed)
    previous = random_poses(side, 1, seed + 1)[0]
    np.testing.assert_allclose(feasible_angles(*forward(poses, side), side, ROBOT, previous), poses, rtol=0, atol=1e-9)


@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_the_ends_of_the_joints_are_within_the_limits(side):
    lower, upper = limits(side)
    poses = np.stack(np.meshgrid(*zip(lower, upper, strict=True)), axis=-1).reshape(-1, 4)
    np.testing.assert_allclose(feasible_angles(*forward(poses, side), side, ROBOT), poses, rtol=0, atol=1e-7)


@given(seed=SEEDS)
def test_where_the_closed_form_is_within_the_limits_it_is_the_answer(seed):
    directions = np.random.default_rng(seed).normal(size=(40, 2, 2, 3))
    closed, nearest = arm_positions(directions), feasible_positions(directions, ROBOT)
    for side in (LEFT, RIGHT):
        wanted, lower, upper = closed[:, joints(side)], *limits(side)
        inside = ((wanted >= lower) & (wanted <= upper)).all(axis=1)
        np.testing.assert_allclose(nearest[:, joints(side)][inside], wanted[inside], rtol=0, atol=1e-12)
        assert direction_error(nearest, directions)[inside, side].max(initial=0.0) < 1e-9


def walk(seed, frames=40):
    """Directions that go on from frame to frame, some lost, through singular postures too."""
    rng = np.random.default_rng(seed)
    directions = np.cumsum(rng.normal(size=(frames, 2, 2, 3)) * rng.choice([0.01, 0.1, 0.5]), axis=0)
    directions += rng.choice([0.0, 1.0]) * np.array([[[0.0, 1.0, 0.0]] * 2, [[0.0, -1.0, 0.0]] * 2])
    if rng.random() < 0.3:
        directions[:, :, FOREARM] = directions[:, :, UPPER_ARM] * (1.0 + 0.01 * rng.normal(size=(frames, 2, 3)))
    lost = rng.random((frames, 2, 2)) < 0.1
    directions[lost] = rng.choice([np.nan, 0.0, np.inf])
    return directions


@settings(max_examples=30)
@given(seed=SEEDS)
def test_the_mirrored_person_gives_the_mirrored_robot(seed):
    directions = walk(seed)
    previous = np.random.default_rng(seed).uniform(-1.5, 1.5, 26)
    mirrored = feasible_positions(directions[:, ::-1] * [1.0, -1.0, 1.0], ROBOT, ROBOT.mirror(previous))
    expected = ROBOT.mirror(feasible_positions(directions, ROBOT, previous))
    np.testing.assert_allclose(mirrored, expected, rtol=0, atol=1e-9)


@settings(max_examples=10)
@given(seed=SEEDS)
def test_frames_one_by_one_are_the_same_as_all_at_once(seed):
    directions = walk(seed)
    told = np.zeros(26)
    for frame, expected in zip(directions, feasible_positions(directions, ROBOT), strict=True):
        positions = feasible_positions(frame[None], ROBOT, told)[0]
        np.testing.assert_allclose(positions, expected, rtol=0, atol=1e-9)
        told = np.where(np.isfinite(positions), positions, told)


def test_long_recordings_are_solved_in_parts_without_a_seam(monkeypatch):
    directions = walk(5, 300)
    whole = feasible_positions(directions, ROBOT)
    monkeypatch.setattr(feasible, "_TOGETHER", 7)
    np.testing.assert_allclose(feasible_positions(directions, ROBOT), whole, rtol=0, atol=1e-9)


@settings(max_examples=30)
@given(seed=SEEDS)
def test_a_person_who_holds_still_holds_the_robot_still(seed):
    upper_arm, forearm = (vectors[:1].repeat(4, axis=0) for vectors in hard_directions(seed, 1))
    angles = feasible_angles(upper_arm, forearm, LEFT, ROBOT, random_poses(LEFT, 1, seed)[0])
    np.testing.assert_allclose(angles[1:], angles[:1].repeat(3, axis=0), rtol=0, atol=1e-9)


@given(seed=SEEDS, power=st.integers(-60, 60))
def test_the_length_of_a_segment_does_not_matter(seed, power):
    directions = np.random.default_rng(seed).normal(size=(10, 2, 2, 3))
    expected = feasible_positions(directions, ROBOT)
    np.testing.assert_allclose(feasible_positions(directions * 2.0**power, ROBOT), expected, rtol=0, atol=1e-9)


def test_an_elbow_bent_too_much_shares_what_is_missing_between_both_segments():
    upper_arm, forearm = forward(np.array([[0.5, 0.2, -0.4, -np.radians(130.0)]]), LEFT)
    angles = feasible_angles(upper_arm, forearm, LEFT, ROBOT)
    missing = np.radians(130.0) - BENDS[1]
    np.testing.assert_allclose(errors(angles, upper_arm, forearm)[0], [missing / 2, missing / 2], rtol=0, atol=1e-9)


def test_an_upper_arm_out_of_reach_leaves_the_forearm_right():
    upper_arm, forearm = forward(np.array([[0.5, np.radians(-40.0), 0.3, -0.8]]), LEFT)
    angles = feasible_angles(upper_arm, forearm, LEFT, ROBOT)
    np.testing.assert_allclose(
        errors(angles, upper_arm, forearm)[0], [np.radians(40.0) + LOWER[1], 0.0], rtol=0, atol=1e-9
    )


@settings(max_examples=30)
@given(seed=SEEDS)
def test_an_upper_arm_alone_points_as_near_as_it_can(seed):
    upper_arm, _ = hard_directions(seed, 20)
    angles = feasible_angles(upper_arm, np.full((20, 3), np.nan), LEFT, ROBOT)
    assert np.isnan(angles[:, 2:]).all()
    reached = forward(np.nan_to_num(angles), LEFT)[0]
    places = forward(SHOULDERS, LEFT)[0]
    best = angle_between(upper_arm[:, None], places).min(axis=1)
    assert (angle_between(reached, upper_arm) <= best + np.radians(0.6)).all()


def test_lost_frames_are_passed_over():
    pose = np.array([[0.3, 0.4, 0.9, -0.02]] * 4)  # straighter than the elbow can be: ElbowYaw is the last one's
    pose[0, 3] = -0.5
    upper_arm, forearm = (np.array(vectors) for vectors in forward(pose, LEFT))
    forearm[2:] = upper_arm[2:]
    upper_arm[1], forearm[2] = np.nan, np.nan
    angles = feasible_angles(upper_arm, forearm, LEFT, ROBOT)
    assert np.isnan(angles[1]).all() and np.isnan(angles[2, 2:]).all() and np.isfinite(angles[2, :2]).all()
    assert angles[3, 2] == pytest.approx(0.9, abs=1e-9)


@pytest.mark.parametrize("tilt", np.linspace(0.0, 2.0 * np.pi, 7))
@pytest.mark.parametrize("off", [0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3])
def test_next_to_a_singular_posture_the_last_angle_is_kept(tilt, off):
    previous = np.array([0.6, ROLL_END, -0.3, -0.7])
    forearm = forward(previous[None], LEFT)[1][0]
    beside = [off * np.cos(tilt), 1.0, off * np.sin(tilt)]
    np.testing.assert_allclose(one(beside, forearm, previous), previous, rtol=0, atol=np.radians(1.0))
    previous = np.array([0.6, 0.4, -0.8, -BENDS[0]])
    upper_arm = forward(previous[None], LEFT)[0][0]
    across = unit(np.cross(upper_arm, [0.3, -0.5, 0.8]))
    straight = upper_arm + off * (np.cos(tilt) * across + np.sin(tilt) * np.cross(upper_arm, across))
    np.testing.assert_allclose(one(upper_arm, straight, previous), previous, rtol=0, atol=1e-9)


def test_an_arm_passes_the_shoulder_axis_with_its_pitch_going_round_bit_by_bit():
    """From in front of the axis to behind it, a hundredth of a degree a frame."""
    sweep = np.radians(np.arange(-12.0, 12.0, 0.01))
    upper_arm = unit(np.stack([-np.sin(sweep), np.cos(sweep), np.full(len(sweep), 0.002)], axis=-1))
    angles = feasible_angles(upper_arm, np.tile([0.0, 0.0, 1.0], (len(sweep), 1)), LEFT, ROBOT)
    assert np.degrees(np.abs(np.diff(angles, axis=0))).max() < 15.0
    assert np.degrees(np.ptp(angles[:, 0])) > 60.0


def steps_that_were_not_forced(upper_arm, forearm, rng):
    """Frames at which a segment jumped by 5 degrees, though staying around would have been no worse."""
    angles = feasible_angles(upper_arm, forearm, LEFT, ROBOT)
    positions = np.full((len(angles), 26), np.nan)
    positions[:, joints(LEFT)] = angles
    reached = arm_directions_of(positions)[:, LEFT]
    for frame in np.flatnonzero(angle_between(reached[1:], reached[:-1]).max(axis=1) > np.radians(5.0)):
        around = np.clip(angles[frame] + np.radians(1.5) * rng.uniform(-1.0, 1.0, (2000, 4)), LOWER, UPPER)
        around[0] = angles[frame]
        wanted = upper_arm[frame + 1], forearm[frame + 1]
        stay, gone = errors(around, *wanted).sum(axis=1).min(), errors(angles[frame + 1], *wanted).sum()
        if np.degrees(stay - gone) < -0.15:
            yield frame


@settings(max_examples=12)
@given(seed=SEEDS)
def test_the_arm_jumps_only_where_staying_would_be_worse(seed):
    rng = np.random.default_rng(seed)
    start, end = (np.stack(hard_directions(seed + i, 1))[:, 0] for i in (0, 1))
    angle = np.linspace(0.0, 0.2, 250)[:, None]
    across = unit(end - np.sum(start * end, axis=1, keepdims=True) * start)
    upper_arm, forearm = (np.cos(angle) * start[i] + np.sin(angle) * across[i] for i in (0, 1))
    assert not list(steps_that_were_not_forced(upper_arm, forearm, rng))


@pytest.mark.parametrize(
    ("pose", "column"),
    [([np.pi, 0.3, 0.0, -0.9], 0), ([0.4, 0.3, np.pi, -0.9], 2), ([1.4, 0.2, np.pi, -0.1], 2)],
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_noise_about_a_tie_between_both_ends_of_a_joint_does_not_throw_the_arm_round(pose, column, side):
    rng = np.random.default_rng(2)
    poses = np.tile(pose, (200, 1)) + 0.001 * rng.normal(size=(200, 4))
    poses[0, column] = side * 2.5
    angles = feasible_angles(*forward(poses, LEFT), LEFT, ROBOT)[:, column]
    assert (np.sign(angles) == side).all()


def test_the_limits_are_those_of_the_robot_that_is_asked_for():
    upper = ROBOT.upper.copy()
    upper[ROBOT.index["LShoulderRoll"]] = 0.5
    assert feasible_angles(np.array([[0.0, 1.0, 0.0]]), X[None], LEFT, replace(ROBOT, upper=upper))[0, 1] == 0.5
