"""What a recording asks for."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest
from hypothesis import given

from nao_sim.motion import JointTrajectory
from nao_sim.robot import load_robot
from nao_sim.safety.assessment import assess, held
from tests.motions import wild_motions

NOTHING = dict.fromkeys(
    ("limit_frames", "coupling_frames", "speed_frames", "self_collision_frames", "nonfinite_frames"), 0
)


@given(wild_motions(seconds=1.0))
def test_held_values_are_the_latest_finite_ones(motion):
    start = load_robot().postures["StandInit"]
    filled = held(motion.positions, start)
    latest = start.copy()
    for row, got in zip(motion.positions, filled, strict=True):
        latest = np.where(np.isfinite(row), row, latest)
        assert np.array_equal(got, latest)


def _asked(robot, changes: list[dict[str, float]], dt: float = 1.0):
    start = robot.postures["StandInit"]
    poses = np.tile(start, (len(changes), 1))
    for pose, change in zip(poses, changes, strict=True):
        for name, value in change.items():
            pose[robot.index[name]] = value
    return asdict(assess(JointTrajectory(dt * np.arange(len(poses)), poses), robot, start))


@pytest.mark.parametrize(
    ("changes", "dt", "expected"),
    [
        ([{}, {}], 1.0, {}),
        ([{}, {"HeadYaw": 2.2}], 1.0, {"limit_frames": 1}),
        ([{"HeadYaw": 2.0857, "HeadPitch": 0.0}], 1.0, {}),
        ([{"HeadYaw": 1.5, "HeadPitch": 0.4}, {}], 1.0, {"coupling_frames": 1}),
        ([{}, {"HeadYaw": 1.0}, {"HeadYaw": 1.0}], 0.1, {"speed_frames": 1}),
        ([{"HeadYaw": np.nan}, {"LHand": np.inf}, {}], 1.0, {"nonfinite_frames": 2}),
        (
            [{"LShoulderPitch": -0.9, "LShoulderRoll": -0.3, "LElbowYaw": -0.3, "LElbowRoll": -1.2}],
            1.0,
            {"self_collision_frames": 1},
        ),
    ],
)
def test_each_kind_of_frame_is_counted_alone(robot, changes, dt, expected):
    assert _asked(robot, changes, dt) == NOTHING | expected
