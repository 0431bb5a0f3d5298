"""NAO's own motions: as Webots ships them, and Choregraphe timelines of other people."""

from pathlib import Path

import numpy as np
import pytest

from nao_sim.recordings import Source, load
from nao_sim.recordings.angles.conversion import convert
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


@pytest.mark.parametrize(
    ("name", "box", "keys", "joints", "first"),
    [("adore_Drinking_right", "Drinking (right)", 6, 14, 0.96), ("naomimic_ArmsChor", "ArmsChor", 3, 12, 1.16)],
)
def test_a_timeline_of_choregraphe_loads(name, box, keys, joints, first):
    recording = load(FOLDER / f"{name}.xar")
    motion = recording.motion
    assert recording.format == "Choregraphe timeline" and recording.frames == keys
    assert (motion.times[0], motion.times[-1]) == (first, 5.96) and recording.labels[0].name == box
    assert motion.given.sum() == joints and np.isfinite(motion.positions[:, motion.given]).all()
    inside = (motion.positions > ROBOT.lower - 0.01) & (motion.positions < ROBOT.upper + 0.01)
    assert inside[:, motion.given].all()
    assert np.diff(motion.times).max() < 0.0201


def test_a_key_is_hit_at_its_frame_and_the_way_between_is_smooth():
    motion = load(FOLDER / "naomimic_ArmsChor.xar").motion
    pitch = motion.positions[:, ROBOT.index["LShoulderPitch"]]
    for frame, degrees in ((30, 84.2307), (90, -19.355), (150, 84.2307)):
        assert pitch[motion.times == (frame - 1) / 25.0] == pytest.approx(np.radians(degrees), abs=1e-12)
    assert pitch.min() >= np.radians(-19.3551) and pitch.max() <= np.radians(84.2308)  # no overshoot
    way = np.radians(84.2307 + 19.355)
    assert np.abs(np.diff(pitch)).max() * 50.0 == pytest.approx(
        1.5 * way / 2.4, rel=0.01
    )  # of a curve flat at its ends
    mirrored = motion.mirrored().positions[:, ROBOT.index["LShoulderPitch"]]
    np.testing.assert_allclose(mirrored, pitch, atol=1e-12)


@pytest.mark.parametrize(
    "name", ["TaiChi.motion", "WipeForehead.motion", "adore_Drinking_right.xar", "naomimic_ArmsChor.xar"]
)
@pytest.mark.parametrize("extension", [".csv", ".motion", ".npz", ".py"])
def test_a_motion_is_converted_without_a_loss_of_angles_or_times(tmp_path, name, extension):
    before, after, loss = convert(Source(FOLDER / name), tmp_path / f"out{extension}")
    assert {text[:24] for text in loss.told} <= {"names of poses or gesture"[:24]}
    np.testing.assert_allclose(after.motion.positions, before.motion.positions, atol=1e-12)
    np.testing.assert_allclose(after.motion.times, before.motion.times, atol=1e-12)
