"""The thesis's poses, learned from its table alone, shown by thousands of strangers in pictures."""

from pathlib import Path

import numpy as np
import pytest

from nao_sim.gestures.directions import readings_of_skeleton
from nao_sim.gestures.poses import PoseRecogniser
from nao_sim.gestures.streaming import segments_of, stream_poses
from nao_sim.gestures.training_table import thesis_table
from nao_sim.recordings import load

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "recordings"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no {FOLDER}")
SHOWN = {"T": "side", "Yoga_UpwardSalute": "up", "Stand": "down", "Traffic_AllStop": "piUp"}


@pytest.fixture(scope="module")
def recogniser():
    table = thesis_table()
    return PoseRecogniser.of_thesis_rows(table.features, table.labels)


def decided(recogniser, name):
    file = FOLDER / "openpose_body25_poses" / f"{name}_body.json.gz"
    return np.array(recogniser.decide(readings_of_skeleton(load(file).motion)).labels)


def test_strangers_are_recognised_and_none_counts_as_wrong(recogniser):
    right = {name: decided(recogniser, name) == pose for name, pose in SHOWN.items()}
    assert all(found.mean() >= 0.96 for found in right.values())
    assert np.concatenate(list(right.values())).mean() >= 0.985


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_a_single_raised_arm_is_not_both(recogniser, side):
    found = decided(recogniser, f"Stand_{side}ArmRaised")
    assert not np.isin(found, ["up", "piUp", "side", "forward"]).any()
    assert np.char.startswith(found.astype(str), side.lower()).mean() > 0.85


def test_gestures_of_others_hardly_ever_announce_a_pose(recogniser):
    found, minutes = [], 0.0
    for path in sorted((FOLDER / "labanotation_kinect" / "samples").glob("Ges*.csv")):
        skeleton = load(path).motion
        minutes += skeleton.duration / 60.0
        found += segments_of(stream_poses(recogniser, skeleton))
    assert len([each for each in found if each.label in ("side", "forward", "piUp", "up")]) / minutes <= 4.0
