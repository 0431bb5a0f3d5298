"""Landmarks, keypoints and tables of points that other people recorded."""

import json
import tarfile
from pathlib import Path

import numpy as np
import pytest

from nao_sim.errors import RecordingError
from nao_sim.recordings import load

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "recordings"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason=f"no {FOLDER}")


@pytest.fixture(scope="module")
def signs(tmp_path_factory):
    """All Turkish signs of the archive."""
    folder = tmp_path_factory.mktemp("signs")
    with tarfile.open(FOLDER / "turkish_signs" / "landmarks_60words.tar.xz") as archive:
        archive.extractall(folder, filter="data")
    return sorted(folder.rglob("*.json"))


def length(skeleton, start, end):
    return np.nanmedian(np.linalg.norm(skeleton.track(end) - skeleton.track(start), axis=1))


def test_all_turkish_signs_load_as_people_who_face_the_camera(signs):
    assert len(signs) == 57
    for path in signs:
        recording = load(path)
        skeleton = recording.motion
        assert recording.format == "landmarks (JSON)" and len(skeleton) == recording.frames == 30
        assert recording.labels[0].name == json.loads(path.read_text())["word_tr"]
        shoulders = (skeleton.track("left_shoulder") + skeleton.track("right_shoulder")) / 2
        nose = (skeleton.track("nose") - shoulders).mean(axis=0)
        assert 0.08 < nose[0] < 0.25 and abs(nose[1]) < 0.08 and 0.1 < nose[2] < 0.3, path.name
        assert (skeleton.track("left_shoulder") - skeleton.track("right_shoulder")).mean(axis=0)[1] > 0.2
        assert 0.24 < length(skeleton, "left_shoulder", "right_shoulder") < 0.4
        for side in ("left", "right"):
            assert 0.2 < length(skeleton, f"{side}_shoulder", f"{side}_elbow") < 0.36, path.name


def test_the_square_pictures_of_the_signs_are_told_by_the_bodies_in_them(signs):
    told = [note for path in signs for note in load(path).notes if "unknown size" in note]
    assert sum("taken as 1:1" in note for note in told) >= 54 and len(told) == 57


def test_the_hands_of_the_signs_are_at_their_wrists(signs):
    for path in signs[::8]:
        skeleton = load(path).motion
        reach = np.linalg.norm(skeleton.track("right_middle_mcp") - skeleton.track("right_wrist"), axis=1)
        assert np.isfinite(reach).any() and 0.04 < np.nanmedian(reach) < 0.14, path.name


# Median directions of the right upper arm and forearm (left, up), as the collection's notes give them.
POSES = {
    "T_body": ((-0.98, -0.18), (-0.99, 0.09)),
    "Traffic_AllStop_body": ((-0.98, -0.16), (-0.06, 0.99)),
    "Yoga_UpwardSalute_body": ((0.0, 1.0), (0.25, 0.96)),
    "Stand_body": (None, None),
    "Stand_LeftArmRaised_body": (None, None),
    "Stand_RightArmRaised_body": (None, None),
}


def direction(skeleton, start, end):
    way = np.nanmedian(skeleton.track(end) - skeleton.track(start), axis=0)
    return way / np.linalg.norm(way)


@pytest.mark.parametrize("name", POSES)
def test_body_25_poses_are_upright_and_planar_with_the_directions_of_the_notes(name):
    recording = load(FOLDER / "openpose_body25_poses" / f"{name}.json.gz")
    skeleton = recording.motion
    assert recording.format == "table of BODY_25 poses" and skeleton.planar and len(skeleton) > 490
    assert recording.labels[0].name == name.removesuffix("_body")
    assert np.nanmedian(skeleton.track("neck")[:, 2] - skeleton.track("pelvis")[:, 2]) > 0.3
    for way, start, end in zip(POSES[name], ("shoulder", "elbow"), ("elbow", "wrist"), strict=True):
        if way is not None:
            np.testing.assert_allclose(direction(skeleton, f"right_{start}", f"right_{end}")[1:], way, atol=0.08)


def test_raised_arms_are_on_the_side_of_their_name():
    for side, other in (("Left", "right"), ("Right", "left")):
        skeleton = load(FOLDER / "openpose_body25_poses" / f"Stand_{side}ArmRaised_body.json.gz").motion
        assert direction(skeleton, f"{side.lower()}_shoulder", f"{side.lower()}_wrist")[2] > 0.5
        assert direction(skeleton, f"{other}_shoulder", f"{other}_wrist")[2] < -0.5


@pytest.mark.parametrize(
    ("name", "frames", "planar", "rate"),
    [("mediapipe", 170, False, 24.0), ("openpose", 93, True, 24.0), ("example", 66, True, 24.0)],
)
def test_pose_files_load(name, frames, planar, rate):
    recording = load(FOLDER / "pose_format" / f"{name}.pose")
    skeleton = recording.motion
    assert (recording.format, recording.frames, skeleton.planar) == (".pose file", frames, planar)
    assert 1.0 / np.diff(skeleton.times).mean() == pytest.approx(rate)
    assert (
        np.nanmedian(skeleton.track("left_shoulder")[:, 1]) > np.nanmedian(skeleton.track("right_shoulder")[:, 1])
    ).all()
    assert "left_elbow" in skeleton.joints and "right_index_tip" in skeleton.joints
    assert 0.15 < length(skeleton, "left_shoulder", "left_elbow") < 0.4
    assert skeleton.confidence.min() >= 0.0 and 0.5 < skeleton.confidence.max() <= 1.0


def test_two_hands_of_nite_are_in_front_of_the_sensor():
    for path in sorted((FOLDER / "nite_hri_hands").glob("*.csv")):
        recording = load(path)
        skeleton = recording.motion
        assert recording.format == "table of two hands" and skeleton.joints == ("left_hand", "right_hand")
        assert 0.5 < -np.nanmedian(skeleton.positions[:, :, 0]) < 4.0
    first = load(FOLDER / "nite_hri_hands" / "train_1.csv").motion
    assert np.nanmedian(first.track("left_hand")[:, 1]) > 0.0 > np.nanmedian(first.track("right_hand")[:, 1])


def test_features_without_places_are_told_with_their_variables():
    with pytest.raises(RecordingError, match=r"DataBySeq\{1\}.X \(382 x 12\)"):
        load(FOLDER / "cmu_mocap6" / "mocap6.mat")


def test_json_that_is_no_recording_is_told_so():
    with pytest.raises(RecordingError, match="JSON with the keys 1, 2, 3"):
        load(FOLDER / "nite_hri_hands" / "signs.json")
