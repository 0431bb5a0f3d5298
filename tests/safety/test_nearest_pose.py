"""The safe pose nearest to one that is not."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from nao_sim.robot import load_robot
from nao_sim.safety.nearest_pose import nearest_pose
from nao_sim.safety.position import command_bounds
from nao_sim.safety.promise import AIM, Promise
from nao_sim.safety.rules import Rules

ROBOT = load_robot()
START = ROBOT.postures["StandInit"]
BOUNDS = command_bounds(ROBOT)
FREE = ROBOT.joints_of("Head", "LArm", "RArm")
TARGETS, CHANCES = 30, 100


class Watched(Promise):
    """A promise that remembers which poses were safe when it was asked."""

    def __init__(self):
        super().__init__(ROBOT, START, False, Rules())
        self.safe = []

    def findings(self, line, *rest):
        found = super().findings(line, *rest)
        if all(finding.margin.value >= 0.0 for finding in found):
            self.safe.append(line[-1])
        return found

    def clear(self, pose):
        """Whether a pose is safe by as much as is aimed at."""
        return self.allowed(pose[None]) and not super().findings(np.array([pose, pose]), np.ones((2, 26)), 1.0, AIM)


@pytest.fixture(scope="module")
def answers():
    """Targets that are not safe, what was found for them, and the safe poses passed meanwhile."""
    random, promise, answers = np.random.default_rng(0), Watched(), []
    while len(answers) < TARGETS:
        target = np.where(FREE, random.uniform(*BOUNDS), START)
        if not promise.allowed(target[None]):
            promise.safe = []
            answers.append((target, nearest_pose(promise, target, target, BOUNDS, FREE), promise.safe))
    return promise, answers


def test_what_is_found_is_safe_and_moves_only_what_may_move(answers):
    promise, found = answers
    poses = [(target, pose) for target, pose, _ in found if pose is not None]
    assert len(poses) >= 0.9 * TARGETS
    for target, pose in poses:
        assert promise.allowed(pose[None])
        assert np.array_equal(pose[~FREE], target[~FREE])
        assert (pose >= BOUNDS[0]).all()
        assert (pose <= BOUNDS[1]).all()


def test_it_is_the_nearest_of_the_safe_poses_that_were_passed(answers):
    for target, pose, safe in answers[1]:
        assert (pose is None) == (not safe)
        if pose is not None:
            nearest = min(np.linalg.norm(passed - target) for passed in safe)
            assert np.linalg.norm(pose - target) == pytest.approx(nearest, abs=1e-9)


def test_hardly_ever_is_one_of_many_random_poses_around_the_target_safe_and_nearer(answers):
    promise, found = answers
    random = np.random.default_rng(1)
    beaten = [pose is not None and _is_beaten(promise, random, target, pose) for target, pose, _ in found]
    assert sum(beaten) <= 0.1 * TARGETS


def _is_beaten(promise, random, target, pose):
    distance = np.linalg.norm(pose - target)
    shares = random.choice([0.1, 0.3, 1.0], (CHANCES, 1))  # of the joints that are moved
    ways = random.normal(size=(CHANCES, 26)) * (FREE & (random.random((CHANCES, 26)) < shares))
    ways *= distance * random.uniform(0.2, 1.0, (CHANCES, 1)) / np.maximum(np.linalg.norm(ways, axis=1), 1e-9)[:, None]
    chances = np.clip(target + ways, *BOUNDS)
    nearer = chances[np.linalg.norm(chances - target, axis=1) < distance - 1e-6]
    return any(promise.clear(chance) for chance in nearer)


def test_a_safe_target_is_its_own_nearest_pose():
    promise, random = Watched(), np.random.default_rng(2)
    for target in np.where(FREE, random.uniform(*BOUNDS, (60, 26)), START):
        if promise.clear(target):
            assert np.array_equal(nearest_pose(promise, target, target, BOUNDS, FREE), target)


def test_from_another_start_the_way_comes_closer_to_the_target():
    promise = Watched()
    target = np.where(FREE, np.clip(ROBOT.postures["StandZero"], *BOUNDS), START)
    assert promise.clear(target)
    found = nearest_pose(promise, target, START, BOUNDS, FREE)
    np.testing.assert_allclose(found, target, atol=1e-9)
    distances = [np.linalg.norm(pose - target) for pose in promise.safe]
    assert all(after < before for before, after in pairwise(distances))
