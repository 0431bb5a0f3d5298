"""The robot's numbers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from nao_sim.errors import UsageError
from nao_sim.robot import VERSIONS, facts, load_robot
from tests.motions import poses


def test_joints_are_the_26_of_naoqi_in_naoqi_order(robot):
    names = robot.joint_names
    assert len(names) == 26
    assert names[:3] == ("HeadYaw", "HeadPitch", "LShoulderPitch")
    assert names[8] == "LHipYawPitch"
    assert names[14] == "RHipYawPitch"
    assert names[20] == "RShoulderPitch"
    assert names[-1] == "RHand"


@pytest.mark.parametrize("version", VERSIONS)
def test_every_posture_keeps_limits_and_couplings(version):
    robot = load_robot(version)
    for posture in robot.postures.values():
        assert (posture >= robot.lower - 1e-4).all()
        assert (posture <= robot.upper + 1e-4).all()
        for coupling in robot.couplings:
            lower, upper = coupling.bounds(posture[coupling.by])
            assert lower - 1e-4 <= posture[coupling.joint] <= upper + 1e-4


def test_degrees_and_radians_of_the_limits_agree():
    for joint in facts()["joints"]:
        if "lower_deg" in joint:
            assert np.degrees(joint["lower"]) == pytest.approx(joint["lower_deg"], abs=0.012)
            assert np.degrees(joint["upper"]) == pytest.approx(joint["upper_deg"], abs=0.012)


@given(poses())
def test_mirror_of_the_mirror_is_the_pose(pose):
    robot = load_robot()
    assert np.array_equal(robot.mirror(robot.mirror(pose)), pose)


def test_mirror_swaps_sides_and_turns_rolls_and_yaws(robot):
    pose = np.zeros(26)
    pose[[robot.index["LShoulderRoll"], robot.index["HeadYaw"], robot.index["LShoulderPitch"]]] = 0.5, 0.3, -0.2
    mirrored = robot.mirror(pose)
    assert mirrored[robot.index["RShoulderRoll"]] == -0.5
    assert mirrored[robot.index["HeadYaw"]] == -0.3
    assert mirrored[robot.index["RShoulderPitch"]] == -0.2


def test_limits_mirror_but_for_the_documented_leg_rows(robot):
    mirrored = np.sort([robot.mirror(robot.lower), robot.mirror(robot.upper)], axis=0)
    apart = np.abs(mirrored - [robot.lower, robot.upper]).max(axis=0)
    different = {name for name, gap in zip(robot.joint_names, apart, strict=True) if gap > 1e-9}
    assert {name[1:] for name in different} <= {"KneePitch", "AnklePitch", "AnkleRoll"}


def test_limbs_share_out_all_joints(robot):
    assert sorted(np.concatenate(list(robot.limbs.values()))) == list(range(26))
    assert [len(joints) for joints in robot.limbs.values()] == [2, 6, 6, 6, 6]


def test_commands_are_slower_than_motors():
    for version in VERSIONS:
        robot = load_robot(version)
        assert (robot.max_speed < robot.no_load_speed).all()
        assert (robot.max_acceleration > 0).all()


def test_unknown_version_is_refused_with_the_known_ones():
    with pytest.raises(UsageError, match=r"robot 'v3'.*v4, v5, v6"):
        load_robot("v3")


def test_numbers_cannot_be_written_to(robot):
    with pytest.raises(ValueError, match="read-only"):
        robot.lower[0] = 0.0
