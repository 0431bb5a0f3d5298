"""Writing joint-angle CSV; that it reads back is a law in test_joint_csv."""

import numpy as np
import pytest

from nao_sim.motion import JointTrajectory
from nao_sim.recordings import joint_csv_text, load, write_joint_csv
from nao_sim.robot import load_robot

ROBOT = load_robot()


@pytest.fixture
def motion():
    positions = np.full((2, 26), np.nan)
    positions[:, ROBOT.index["LElbowRoll"]] = [np.radians(-30.0), -1e-9]
    positions[:, ROBOT.index["LHand"]] = [np.nan, np.inf]
    return JointTrajectory([0.0, 0.02], positions, np.isin(ROBOT.joint_names, ["LElbowRoll", "LHand"]))


def test_text_has_comments_units_and_no_minus_zero(motion):
    assert joint_csv_text(motion, ["why"]) == "# why\ntime,LElbowRoll_deg,LHand\n0,-30.0000,\n0.02,0.0000,inf\n"


def test_a_file_is_replaced_whole(tmp_path, motion):
    path = tmp_path / "x.csv"
    path.write_text("old")
    write_joint_csv(path, motion)
    assert [entry.name for entry in tmp_path.iterdir()] == ["x.csv"]
    assert load(path).frames == 2
