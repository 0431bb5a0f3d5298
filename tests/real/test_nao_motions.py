"""NAO's own motions as Webots ships them."""

from pathlib import Path

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.robot import load_robot

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "recordings" / "nao_motions"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no {FOLDER}")
ROBOT = load_robot()


@pytest.mark.parametrize(
    ("name", "frames", "first", "last", "joints"),
    [("TaiChi", 25, 3.0, 50.0, 26), ("WipeForehead", 18, 0.213, 1.693, 14)],
)
def test_a_motion_of_webots_loads(name, frames, first, last, joints):
    recording = load(FOLDER / f"{name}.motion")
    motion = recording.motion
    assert recording.format == "Webots motion" and recording.frames == frames
    assert (motion.times[0], motion.times[-1]) == (first, last)
    assert motion.given.sum() == joints and np.isfinite(motion.positions[:, motion.given]).all()
    assert recording.notes == ("hand openings are the mean of the hand's phalanges",)


def test_the_motions_are_in_naos_signs_and_radians():
    for name in ("TaiChi", "WipeForehead"):
        motion = load(FOLDER / f"{name}.motion").motion
        positions = motion.positions[:, motion.given]
        over = np.maximum(positions - ROBOT.upper[motion.given], ROBOT.lower[motion.given] - positions)
        assert np.median(over) < 0.0 and over.max() < 0.05


def test_a_frame_is_the_line_it_stands_on():
    motion = load(FOLDER / "WipeForehead.motion").motion
    asked = dict(zip(ROBOT.joint_names, motion.positions[0], strict=True))
    assert (asked["HeadPitch"], asked["RElbowRoll"], asked["LWristYaw"]) == (-0.228, 1.281, 0.387)
    assert asked["LHand"] == pytest.approx(0.132 / 0.999899)


@pytest.mark.parametrize("name", ["adore_Drinking_right.xar", "naomimic_ArmsChor.xar", "../pose_format/example.pose"])
def test_a_format_that_is_not_read_is_told_so(name):
    with pytest.raises(RecordingError, match="expected"):
        load(FOLDER / name)
