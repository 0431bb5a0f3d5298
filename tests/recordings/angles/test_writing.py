"""Writing joint angles; that they read back are laws in test_joint_csv and test_conversion."""

import numpy as np
import pytest

from nao_sim.errors import UsageError
from nao_sim.motion import JointTrajectory
from nao_sim.recordings import joint_csv_text, load, write_joint_csv, write_motion
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


def test_a_motion_is_written_by_extension_whole_or_not_at_all(tmp_path, motion):
    for name in ("x.csv", "x.motion", "x.npz", "X.PY"):
        write_motion(tmp_path / name, motion)
        assert load(tmp_path / name).motion.given.sum() >= 1
    assert len(list(tmp_path.iterdir())) == 4
    with pytest.raises(UsageError, match=r"extension '.txt'.*expected .csv .*\.motion .*\.npz .*\.py"):
        write_motion(tmp_path / "x.txt", motion)
