"""Whatever joint-angle file goes in, these hold on the simulated joints, at every physics step."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim.motion import JointTrajectory
from nao_sim.robot import LEGS
from nao_sim.simulation import measures
from nao_sim.simulation.performance import perform
from tests.motions import wild_motions


def _check(simulator, motion) -> None:
    performance = perform(motion, simulator)
    robot, states = simulator.robot, performance.states
    _, excess = measures.limit_violations(robot, states)
    assert np.degrees(excess) <= 0.1
    assert np.degrees(measures.max_coupling_excess(robot, performance.rollout)) <= 0.5
    assert measures.max_speed_ratio(robot, states) <= 1.02
    assert not set().union(*(state.touching for state in states))
    balance = measures.balance(simulator.model, performance.rollout)
    assert not balance.fell
    assert balance.min_support_margin is None or balance.min_support_margin > 0


@settings(max_examples=6)
@given(motion=wild_motions())
def test_free_standing_whatever_is_asked_the_robot_is_safe_and_stands(simulator, motion):
    _check(simulator("free"), motion)


@settings(max_examples=5)
@given(motion=wild_motions())
def test_pinned_whatever_is_asked_of_all_limbs_the_robot_is_safe(simulator, motion):
    _check(simulator("pinned"), motion)


def _without_legs(motion, robot):
    legs = robot.joints_of(*LEGS)
    return JointTrajectory(motion.times, np.where(legs, np.nan, motion.positions), motion.given & ~legs)


@settings(max_examples=3)
@given(motion=wild_motions(seconds=2.0))
def test_the_mirrored_recording_gives_the_mirrored_motion(simulator, motion):
    robot = simulator("free").robot
    motion = _without_legs(motion, robot)  # the documented limits of hips and knees are not the same on both sides
    plain = perform(motion, simulator("free")).rollout.joint_positions
    mirrored = perform(motion.mirrored(), simulator("free")).rollout.joint_positions
    apart = np.abs(robot.mirror(mirrored) - plain)[:, ~robot.is_hand]
    assert np.degrees(apart.max()) < 0.5


def test_the_same_recording_gives_the_same_motion(simulator):
    from nao_sim.paths import TRAJECTORIES
    from nao_sim.recordings import load

    motion = load(TRAJECTORIES / "gestures/side.csv").motion
    runs = [perform(motion, simulator("free")).rollout.joint_positions for _ in range(2)]
    assert runs[0] == pytest.approx(runs[1], abs=0)
