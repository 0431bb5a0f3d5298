"""The search for a way round."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety import detour
from nao_sim.safety.detour import Detour
from nao_sim.safety.promise import Promise
from nao_sim.safety.route import SAMPLING, looks
from nao_sim.safety.rules import Rules

ROBOT = load_robot()
STAND = ROBOT.postures["StandInit"]
BOUNDS = ROBOT.lower, ROBOT.upper
MOVING = ROBOT.joints_of("Head", "LArm", "RArm")
SHOULDERS = [ROBOT.index[name] for name in ("LShoulderPitch", "LElbowYaw", "RShoulderPitch", "RElbowYaw")]
LEFT = SHOULDERS[:2]


class Boxes:
    """Forbidden boxes around middles (N, J) in some joints; what is looked at is kept.

    Of a box, every pose between two looks at most `SAMPLING` apart is at most half of that inside.
    """

    def __init__(self, joints, middles, half):
        self.joints, self.middles, self.half, self.looked = joints, np.array(middles), half, []

    def depth(self, poses):
        gaps = np.abs(poses[:, None, self.joints] - self.middles).max(axis=2)
        return np.maximum(self.half - gaps, 0.0).max(axis=1, initial=0.0)

    def free(self, poses):
        self.looked.append(len(poses))
        return bool((self.depth(poses) == 0.0).all())

    def mirrored_free(self, poses):
        return self.free(ROBOT.mirror(poses))


@st.composite
def problems(draw: st.DrawFn):
    """A start and a goal that differ in some joints, boxes of which one is between them, and which joints move."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    moving = MOVING & (random.random(26) < draw(st.sampled_from([0.7, 1.0])))
    moving[LEFT] = True
    start, goal = (np.where(moving, random.uniform(*BOUNDS), STAND) for _ in range(2))
    joints = draw(st.sampled_from([SHOULDERS, LEFT]))
    middles = [(start + goal)[joints] / 2, *random.uniform(*BOUNDS, (draw(st.integers(0, 3)), 26))[:, joints]]
    boxes = Boxes(joints, middles, draw(st.sampled_from([0.1, 0.4])))
    assume(not boxes.depth(np.array([start, goal])).any())
    return start, goal, moving, boxes


def _solved(free, start, goal, moving=MOVING, slices=(10**9,)):
    search = Detour(ROBOT, free, start, goal, moving, BOUNDS)
    for poses in slices:
        search.work(poses)
    return search


def _along(path):
    """Poses close together, all the way."""
    pieces = [before + (after - before) * np.linspace(0, 1, 40)[:, None] for before, after in pairwise(path)]
    return np.concatenate([path, *pieces])


@given(problems())
def test_a_way_is_free_from_end_to_end_and_moves_only_what_may_move(problem):
    start, goal, moving, boxes = problem
    search = _solved(boxes.free, start, goal, moving)
    assert search.state == "found"
    assert search.looked == sum(boxes.looked)
    path = search.path
    assert (path[0] == start).all()
    assert (path[-1] == goal).all()
    assert (path[:, ~moving] == start[~moving]).all()
    assert (boxes.depth(path) == 0.0).all()  # the corners themselves were looked at
    assert boxes.depth(_along(path)).max() <= SAMPLING / 2 + 1e-9
    lower, upper = np.minimum(BOUNDS[0], start), np.maximum(BOUNDS[1], start)
    assert (path >= lower - 1e-9).all()
    assert (path <= upper + 1e-9).all()


@settings(max_examples=40)
@given(problems(), st.lists(st.integers(1, 200), min_size=1, max_size=5))
def test_the_way_does_not_depend_on_how_the_work_is_sliced(problem, slices):
    start, goal, moving, boxes = problem
    whole = _solved(boxes.free, start, goal, moving)
    sliced = _solved(boxes.free, start, goal, moving, slices * 2000)
    assert sliced.looked == whole.looked
    assert (sliced.path == whole.path).all()


@given(problems(), st.integers(1, 100))
def test_a_slice_of_work_looks_at_about_as_many_poses_as_it_was_given(problem, slice_):
    start, goal, moving, boxes = problem
    search = Detour(ROBOT, boxes.free, start, goal, moving, BOUNDS)
    for turn in range(1, 20):
        search.work(slice_)
        assert search.looked <= turn * slice_ + 8
        assert search.state != "searching" or search.looked >= turn * slice_


@settings(max_examples=40)
@given(problems())
def test_the_mirrored_problem_has_the_mirrored_way(problem):
    start, goal, moving, boxes = problem
    plain = _solved(boxes.free, start, goal, moving)
    mirrored = _solved(boxes.mirrored_free, ROBOT.mirror(start), ROBOT.mirror(goal), moving[ROBOT.mirror_of])
    assert (ROBOT.mirror(mirrored.path) == plain.path).all()


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_a_problem_that_is_its_own_mirror_image_has_a_way_that_is_its_own(seed):
    random = np.random.default_rng(seed)
    start, goal = (_own_image(np.where(MOVING, random.uniform(*BOUNDS), STAND)) for _ in range(2))
    middle = (start + goal) / 2
    boxes = Boxes(LEFT, [middle[LEFT]], 0.3)
    assume(not boxes.depth(np.array([start, goal])).any())
    path = _solved(lambda poses: boxes.free(poses) and boxes.mirrored_free(poses), start, goal).path
    assert len(path) > 2
    assert (ROBOT.mirror(path) == path).all()


def test_a_problem_that_is_its_own_mirror_image_may_have_a_way_that_is_not(monkeypatch):
    """Both arms must not pass the middle at once."""
    monkeypatch.setattr(detour, "_SYMMETRIC_LIMIT", 500)
    start = _own_image(STAND.copy())
    left, right = (ROBOT.index[f"{side}ShoulderPitch"] for side in "LR")
    start[[left, right]], goal = -1.5, start.copy()
    goal[[left, right]] = 1.5
    free = lambda poses: bool((np.abs(poses[:, [left, right]]).max(axis=1) > 0.5).all())  # noqa: E731
    assert _solved(free, start, goal).state == "found"


def _own_image(pose):
    pose = np.where(np.arange(26) > ROBOT.mirror_of, ROBOT.mirror(pose), pose)
    return (pose + ROBOT.mirror(pose)) / 2


def test_a_straight_way_that_is_free_is_taken():
    goal = np.where(MOVING, STAND + 0.2, STAND)
    search = _solved(lambda poses: True, STAND, goal)
    assert len(search.path) == 2
    assert search.looked < 20


def test_where_there_is_nowhere_to_go_the_way_is_there_at_once():
    search = _solved(lambda poses: True, STAND, STAND)
    assert (search.path == STAND).all()


@given(st.lists(st.sampled_from([-1.0, 1.0]), min_size=4, max_size=4))
def test_a_start_at_the_bottom_of_a_cup_is_left(sides):
    """Walls touch the start on one side of each of four joints; the goal is behind all of them."""
    inward = np.array(sides)
    start, goal = np.where(MOVING, 0.0, STAND), np.where(MOVING, 0.0, STAND)
    start[SHOULDERS], goal[SHOULDERS] = 0.2 * inward, -1.3 * inward

    def free(poses):
        inside = (poses - start)[:, SHOULDERS] * inward
        return bool(((inside >= 0.0).all(axis=1) | (np.abs(inside).max(axis=1) > 0.5)).all())

    assert free(np.array([start, goal]))
    assert not free(looks(start, goal))
    assert _solved(free, start, goal).state == "found"


def test_a_goal_that_is_not_free_fails_at_once():
    search = _solved(lambda poses: False, STAND, np.where(MOVING, STAND + 0.2, STAND))
    assert (search.state, search.path, search.looked) == ("failed", None, 1)


def test_a_goal_behind_a_wall_fails_in_the_end(monkeypatch):
    monkeypatch.setattr(detour, "LIMIT", 2000)
    wall = ROBOT.index["LShoulderPitch"]
    start, goal = STAND.copy(), STAND.copy()
    start[wall], goal[wall] = -1.0, 1.0
    search = _solved(lambda poses: bool((np.abs(poses[:, wall]) > 0.1).all()), start, goal)
    assert (search.state, search.path) == ("failed", None)
    assert 2000 <= search.looked < 2500
    search.work(1000)
    assert search.looked < 2500


def test_what_may_not_move_must_be_where_it_should_be():
    with pytest.raises(ValueError, match="may not move"):
        Detour(ROBOT, lambda poses: True, STAND, STAND + 0.1, MOVING, BOUNDS)


def _posture(left_deg, right_deg):
    """ShoulderPitch, ShoulderRoll, ElbowYaw and ElbowRoll of either arm; the rest stands."""
    pose = STAND.copy()
    for side, angles in (("L", left_deg), ("R", right_deg)):
        for joint, angle in zip(("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll"), angles, strict=True):
            pose[ROBOT.index[f"{side}{joint}"]] = np.radians(angle)
    return pose


LEFT_BELOW_RIGHT = _posture((-7, -13, 13, -52), (-13, 12, 28, 52))
LEFT_BEHIND_RIGHT_BEFORE = _posture((117, -8, 32, -75), (36, 6, 19, 82))
LEFT_BEHIND = _posture((117, -8, 26, -65), (41, 12, -11, 56))
LEFT_AT_THE_CHIN = _posture((-46, -1, 16, -76), (31, 12, -1, 56))
HANDS_OVER_THE_HEAD = _posture((-51, 0, -78, -65), (-119, 4, -11, 23))


@pytest.mark.parametrize(
    ("start", "goal"),
    [
        pytest.param(LEFT_BELOW_RIGHT, ROBOT.mirror(LEFT_BELOW_RIGHT), id="crossed forearms change places"),
        pytest.param(LEFT_BEHIND_RIGHT_BEFORE, ROBOT.mirror(LEFT_BEHIND_RIGHT_BEFORE), id="hands change sides"),
        pytest.param(LEFT_BEHIND, LEFT_BELOW_RIGHT, id="from behind the back to below the other hand"),
        pytest.param(LEFT_AT_THE_CHIN, HANDS_OVER_THE_HEAD, id="from the chin to beside the other hand"),
    ],
)
def test_the_robot_finds_the_way_round_itself(start, goal):
    promise = Promise(ROBOT, STAND, False, Rules())
    assert not promise.allowed(looks(start, goal))
    search = _solved(promise.allowed, start, goal, slices=[4000])
    assert search.state == "found"
    assert promise.allowed(search.path)
