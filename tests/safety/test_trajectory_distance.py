"""Self-distance along a whole motion."""

from __future__ import annotations

import os
import signal
from concurrent.futures.process import BrokenProcessPool

import numpy as np
import pytest

from nao_sim.safety import trajectory_distance
from nao_sim.safety.self_distance import HORIZON, SelfDistance
from nao_sim.safety.trajectory_distance import forked, smallest_distances


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


def test_processes_that_help_do_not_do_what_this_one_would_when_told_to_end():
    told = []
    before = signal.signal(signal.SIGTERM, lambda number, frame: told.append(number))
    try:
        with forked(1) as pool:
            helper = pool.submit(os.getpid).result()
            assert helper != os.getpid()
            assert pool.submit(signal.getsignal, signal.SIGTERM).result() == signal.SIG_DFL
            assert pool.submit(signal.getsignal, signal.SIGINT).result() == signal.SIG_IGN
            assert pool.submit(signal.pthread_sigmask, signal.SIG_BLOCK, ()).result() == set()
            with pytest.raises(BrokenProcessPool):  # and who waits for one that was killed does not wait for ever
                pool.submit(os.kill, helper, signal.SIGTERM).result()
        assert not told and signal.SIGTERM not in signal.pthread_sigmask(signal.SIG_BLOCK, ())
    finally:
        signal.signal(signal.SIGTERM, before)
