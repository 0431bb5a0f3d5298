"""What files call the joints."""

import pytest

from nao_sim.body import joint_called, joints, joints_called


@pytest.mark.parametrize(
    "prefix",
    ["", "JointType.", "JointType_", "JOINT_", "nite::JOINT_", "XN_SKEL_", "K4ABT_JOINT_", "NUI_SKELETON_POSITION_",
     "PoseLandmark.", "mixamorig:"],
)  # fmt: skip
def test_a_joint_is_known_by_its_name_in_every_enumeration(prefix):
    names = [prefix + joint.upper() for joint in joints()]
    assert tuple(map(joint_called, names)) == joints_called(names) == joints()


def test_other_names_are_no_joints():
    assert [joint_called(name) for name in ("joint", "JOINT_NONE", "JointType.", "joint 3", "jointed doll")] == [
        None
    ] * 5
