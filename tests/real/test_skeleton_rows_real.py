"""Kinect recordings of other people: text of numbers without names, read by the right layout."""

from pathlib import Path

import numpy as np
import pytest

from nao_sim.recordings import load

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "recordings"
SIGNS = sorted((FOLDER / "isl_kinect_signs" / "samples").glob("*.txt"))
GESTURES = sorted((FOLDER / "labanotation_kinect" / "samples").glob("*.csv"))
pytestmark = pytest.mark.skipif(not SIGNS or not GESTURES, reason=f"no {FOLDER}")


def _upper_arms(skeleton):
    return [
        np.nanmedian(np.linalg.norm(skeleton.track(f"{side}_elbow") - skeleton.track(f"{side}_shoulder"), axis=1))
        for side in ("left", "right")
    ]


@pytest.mark.parametrize("path", [*SIGNS, *GESTURES], ids=lambda path: path.stem)
def test_a_recording_is_read_by_its_layout_in_metres_facing_forward(path):
    recording = load(path)
    skeleton = recording.motion
    assert ("Kinect v2" if path in GESTURES else "Kinect v1 (head first)") in recording.reason
    assert "unit m (" in recording.reason and "forward -z, left -x, up +y" in recording.reason
    assert recording.frames == sum(1 for line in path.read_text().splitlines() if line.strip())
    assert all(0.18 < length < 0.35 for length in _upper_arms(skeleton))
    across = np.nanmedian(skeleton.track("left_shoulder") - skeleton.track("right_shoulder"), axis=0)
    assert across[1] > 0.2 > abs(across[0]) / 2 and abs(across[2]) < 0.1
    head, pelvis, foot = (np.nanmedian(skeleton.track(joint)[:, 2]) for joint in ("head", "pelvis", "left_foot"))
    assert head > pelvis + 0.4 > foot + 0.8


def test_times_in_ticks_become_seconds_and_states_confidence():
    skeleton = load(GESTURES[0]).motion
    assert skeleton.times[0] == 0.0 and np.median(np.diff(skeleton.times)) == pytest.approx(1.0 / 30.0, rel=0.02)
    assert set(np.unique(np.concatenate([np.unique(load(path).motion.confidence) for path in GESTURES]))) <= {
        0.0,
        0.5,
        1.0,
    }


def test_a_recording_without_times_says_which_rate_it_took():
    assert any("30 frames a second, as usual" in note for note in load(SIGNS[0]).notes)
    assert load(SIGNS[0], rate=15.0).motion.duration == pytest.approx(2.0 * load(SIGNS[0]).motion.duration)
