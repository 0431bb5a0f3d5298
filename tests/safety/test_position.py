"""Position limits."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.robot import VERSIONS, load_robot
from nao_sim.safety.position import LEG_MARGIN_RAD, MARGIN_RAD, command_bounds, limit_excess
from tests.motions import poses


@pytest.mark.parametrize("version", VERSIONS)
def test_commands_are_bounded_by_the_documented_limits_less_the_margin(version):
    robot = load_robot(version)
    lower, upper = command_bounds(robot)
    for i, name in enumerate(robot.joint_names):
        is_leg = any(part in name for part in ("Hip", "Knee", "Ankle"))
        margin = 0.0 if name in ("LHand", "RHand") else LEG_MARGIN_RAD if is_leg else MARGIN_RAD
        slack = np.radians(0.7) if name[1:] in ("KneePitch", "AnklePitch", "AnkleRoll") else 1e-12  # sides differ
        assert -1e-12 <= lower[i] - robot.lower[i] - margin <= slack, name
        assert -1e-12 <= robot.upper[i] - upper[i] - margin <= slack, name
    assert 0.0 < MARGIN_RAD < LEG_MARGIN_RAD < np.radians(1.0)
    assert (lower < upper).all()


@pytest.mark.parametrize("version", VERSIONS)
def test_the_mirrored_robot_has_the_same_bounds(version):
    robot = load_robot(version)
    np.testing.assert_array_equal(np.sort(robot.mirror(np.array(command_bounds(robot))), axis=0), command_bounds(robot))


@given(poses())
def test_a_pose_inside_the_limits_exceeds_none(pose):
    robot = load_robot()
    assert not limit_excess(robot, np.stack([pose, robot.lower, robot.upper])).any()


@given(poses(), st.integers(0, 25), st.floats(1e-9, 10.0), st.booleans())
def test_the_excess_is_how_far_a_joint_is_outside(pose, joint, beyond, above):
    robot = load_robot()
    pose[joint] = robot.upper[joint] + beyond if above else robot.lower[joint] - beyond
    expected = np.where(np.arange(26) == joint, beyond, 0.0)
    np.testing.assert_allclose(limit_excess(robot, pose), expected, rtol=0.0, atol=1e-12)
