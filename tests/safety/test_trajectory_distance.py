"""Self-distance along a whole motion."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim.safety import trajectory_distance
from nao_sim.safety.self_distance import HORIZON, SelfDistance
from nao_sim.safety.trajectory_distance import smallest_distances


@pytest.fixture(params=["one process", "all cores"])
def any_way(request, monkeypatch) -> None:
    """Pieces of seven poses, in this process or in others."""
    monkeypatch.setattr(trajectory_distance, "PIECE", 7)
    monkeypatch.setattr(trajectory_distance, "LONG", 1000 if request.param == "one process" else 0)


@pytest.mark.parametrize("horizon", [0.0, HORIZON])
@pytest.mark.parametrize("count", [0, 1, 7, 40])
def test_each_pose_has_the_distance_of_its_nearest_pair(robot, any_way, horizon, count):
    poses = np.random.default_rng(count).uniform(robot.lower, robot.upper, (count, 26))
    told: list[tuple[int, int]] = []
    distances = smallest_distances(poses, horizon, lambda *done: told.append(done))
    one_by_one = SelfDistance(horizon)
    assert distances.tolist() == [one_by_one.nearest(pose).distance for pose in poses]
    assert told == [(min(done, count), count) for done in range(7, count + 7, 7)]


def test_some_poses_overlap_and_some_do_not(robot):
    poses = np.random.default_rng(0).uniform(robot.lower, robot.upper, (200, 26))
    assert 0 < (smallest_distances(poses, 0.0) < 0.0).sum() < 200
