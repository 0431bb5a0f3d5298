"""OpenPose: files, folders and lists of frames, and tables of single poses."""

import gzip
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.body import SIDES
from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.landmarks.marks import AXES, BODY_25, HAND, order_of
from tests.landmark_files import flat, same_directions
from tests.people import in_file, person

ORDER = tuple("nose" if joint == "-" else joint for joint in order_of(BODY_25))
JOINTS = tuple(dict.fromkeys(ORDER))
HANDS = {side: tuple(f"{side}_{joint}" for joint in HAND) for side in SIDES}
SCALE = 200.0  # pixels in a metre


def pixels(skeleton, joints, sure=0.9):
    """Keypoints (T, J, 3) in a picture: x y and confidence."""
    places = in_file(skeleton, joints, axes=AXES)[:, :, :2] * SCALE + [320.0, 400.0]
    return np.dstack([places, np.full(places.shape[:2], sure)])


def keypoints(skeleton, hands=True, sure=0.9):
    """People of each frame as OpenPose writes them."""
    body = pixels(skeleton, ORDER, sure)
    found = []
    for frame in range(len(skeleton)):
        told = {"person_id": [-1], "pose_keypoints_2d": body[frame].ravel().tolist(), "face_keypoints_2d": []}
        for side, joints in HANDS.items():
            points = pixels(skeleton, joints)[frame].ravel().tolist() if hands else []
            told[f"hand_{side}_keypoints_2d"] = points
        found.append({**told, "pose_keypoints_3d": [], "hand_left_keypoints_3d": []})
    return found


def frames(*people):
    return [{"version": 1.3, "people": list(here)} for here in zip(*people, strict=True)]


@pytest.fixture
def write(tmp_path):
    def write(content, name="take.json"):
        path = tmp_path / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    return write


@pytest.fixture
def folder(tmp_path):
    def folder(content, numbers=None):
        path = tmp_path / "json"
        path.mkdir()
        for number, frame in zip(numbers or range(len(content)), content, strict=True):
            (path / f"clip_{number:012d}_keypoints.json").write_text(
                frame if isinstance(frame, str) else json.dumps(frame)
            )
        return path

    return folder


def test_a_folder_of_frames_is_a_planar_person_with_hands(folder):
    expected = person(8)
    recording = load(folder(frames(keypoints(expected))))
    skeleton = recording.motion
    assert recording.format == "OpenPose keypoints" and "8 files" in recording.reason
    assert recording.frames == len(skeleton) == 8 and skeleton.planar
    same_directions(skeleton, flat(expected), (*JOINTS, *HANDS["left"], *HANDS["right"]))
    assert any("lifted to the frontal plane" in note for note in recording.notes)
    assert any("30 frames a second" in note for note in recording.notes)
    assert skeleton.confidence[:, skeleton.joints.index("left_elbow")] == pytest.approx(0.9)


def test_frames_are_in_the_order_of_their_numbers_and_missing_ones_are_gaps(folder):
    expected = person(4)
    skeleton = load(folder(frames(keypoints(expected)), numbers=[8, 9, 11, 1000000]), rate=10.0).motion
    np.testing.assert_allclose(skeleton.times, [0.0, 0.1, 0.3, 99999.2])
    same_directions(skeleton, flat(expected), JOINTS)


@pytest.mark.parametrize("shape", ["a list", "JSON lines", "one frame"])
def test_frames_in_one_file(write, shape):
    expected = person(1 if shape == "one frame" else 6)
    content = frames(keypoints(expected))
    text = {"a list": json.dumps(content), "JSON lines": "\n".join(map(json.dumps, content)),
            "one frame": json.dumps(content[0])}[shape]  # fmt: skip
    recording = load(write(text))
    assert recording.format == "OpenPose keypoints"
    same_directions(recording.motion, flat(expected), JOINTS)


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 999), frames_=st.integers(1, 8))
def test_what_is_written_is_read(tmp_path_factory, seed, frames_):
    expected = person(frames_, seed)
    path = tmp_path_factory.mktemp("law") / "x.json"
    path.write_text(json.dumps(frames(keypoints(expected))))
    same_directions(load(path).motion, flat(expected), JOINTS)


def test_a_mirrored_picture_of_the_mirrored_names_is_the_mirrored_person(write):
    expected = person(5)
    a, b = (load(write(frames(keypoints(skeleton)))).motion for skeleton in (expected, expected.mirrored()))
    same_directions(b, a.mirrored(), JOINTS)


def test_keypoints_of_the_older_coco_model(write):
    expected = person(5)
    joints = order_of("OpenPose COCO")
    people = [{"pose_keypoints_2d": frame.ravel().tolist()} for frame in pixels(expected, joints)]
    same_directions(load(write(frames(people))).motion, flat(expected), joints)


def test_keypoints_in_three_dimensions_have_depth(write):
    expected = person(6)
    places = in_file(expected, ORDER)
    people = [{"pose_keypoints_2d": [], "pose_keypoints_3d": np.hstack([frame, np.ones((25, 1))]).ravel().tolist()}
              for frame in places]  # fmt: skip
    skeleton = load(write(frames(people))).motion
    assert not skeleton.planar
    for joint in JOINTS[1:]:
        np.testing.assert_allclose(skeleton.track(joint), expected.track(joint), atol=1e-9)


def test_keypoints_that_were_not_found_are_missing(write):
    people = keypoints(person(4))
    people[2]["pose_keypoints_2d"][9:12] = [0, 0, 0]
    skeleton = load(write(frames(people))).motion
    assert np.isfinite(skeleton.track("right_elbow")).all(axis=1).tolist() == [True, True, False, True]


def test_frames_without_people_are_gaps(write):
    content = frames(keypoints(person(5)))
    content[2]["people"] = []
    skeleton = load(write(content)).motion
    assert np.isfinite(skeleton.track("nose")).all(axis=1).tolist() == [True, True, False, True, True]


def two(swapped=True):
    """Two people side by side, the second from frame 2 on, listed in changing order."""
    one, other = keypoints(person(8, 1)), keypoints(person(8, 2))
    for told in other:
        told["pose_keypoints_2d"][::3] = [x + 300.0 for x in told["pose_keypoints_2d"][::3]]
    content = frames(one, other)
    for number, frame in enumerate(content):
        frame["people"] = frame["people"][:1] if number < 2 else frame["people"][:: -1 if swapped and number % 2 else 1]
    return content


def test_of_several_people_the_one_tracked_longest_is_read_or_the_one_asked_for(write):
    recording = load(write(two()))
    same_directions(recording.motion, flat(person(8, 1)), JOINTS)
    assert any("several people: 1 (8 frames), 2 (6 frames)" in note for note in recording.notes)
    assert len(load(write(two()), person="2").motion) == 6
    with pytest.raises(RecordingError, match="no person '3'; expected one of 1"):
        load(write(two()), person="3")


GOOD = frames(keypoints(person(3)))


def spoiled(change):
    content = json.loads(json.dumps(GOOD))
    change(content)
    return content


MISTAKES = {
    "a number too few": (lambda c: c[1]["people"][0]["pose_keypoints_2d"].pop(), ["frame 2", "person 1", "of 74"]),
    "a model with other keypoints": (
        lambda c: c[0]["people"][0].update(pose_keypoints_2d=[1.0] * 30), ["frame 1", "10 keypoints", "25, 18"]),
    "a text": (lambda c: c[2]["people"][0]["pose_keypoints_2d"].__setitem__(5, "x"), ["frame 3", "'x'"]),
    "a person of text": (lambda c: c[2].update(people=["me"]), ["frame 3", "person 1 is 'me'"]),
    "people of text": (lambda c: c[2].update(people="all"), ["frame 3", "without people"]),
    "a frame of numbers": (lambda c: c.__setitem__(1, [1, 2]), ["frame 2"]),
    "nobody": (lambda c: [frame.update(people=[]) for frame in c], ["without people"]),
    "nothing but zeros": (
        lambda c: [f["people"][0].update(pose_keypoints_2d=[0] * 75) for f in c], ["all zero", "a person"]),
    "models that change": (
        lambda c: c[2]["people"][0].update(pose_keypoints_2d=[1.0] * 54), ["frame 3", "18 landmarks", "25"]),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_frame(write, mistake):
    change, words = MISTAKES[mistake]
    with pytest.raises(RecordingError) as caught:
        load(write(spoiled(change)))
    assert all(word in str(caught.value) for word in words), str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_broken_file_of_a_folder_is_named(folder):
    path = folder([*GOOD[:2], '{"version": 1.3, "people": ['])
    with pytest.raises(RecordingError) as caught:
        load(path)
    assert "clip_000000000002_keypoints.json, line 1" in str(caught.value) and "broken JSON" in str(caught.value)


def test_an_empty_file_of_a_folder_is_named(folder):
    with pytest.raises(RecordingError, match=r"clip_000000000001_keypoints.json: an empty file"):
        load(folder([GOOD[0], ""]))


def test_frames_of_two_films_in_one_folder_are_refused(folder):
    path = folder(GOOD)
    (path / "other_000000000001_keypoints.json").write_text(json.dumps(GOOD[0]))
    with pytest.raises(RecordingError, match="a second frame 1"):
        load(path)


def test_a_folder_of_other_files_is_no_recording(tmp_path):
    (tmp_path / "a.json").write_text("{}")
    with pytest.raises(RecordingError, match="a folder"):
        load(tmp_path)


# Tables of single poses


def table(skeleton, sure=0.8, **more):
    places = in_file(skeleton, ORDER, axes=("+z", "+x", "+y"))[:, :, :2] / 1.7
    poses = [{"detection_accuracy": 25 * sure, "x": p[:, 0].tolist(), "y": p[:, 1].tolist(), **more} for p in places]
    return {"info": {"label": "T", "BODY25_Mapping": {"0": "Nose"}}, "data": poses}


def test_a_table_of_poses_is_upright_with_one_pose_a_second(write, tmp_path):
    expected = person(4)
    path = tmp_path / "T_body.json.gz"
    path.write_bytes(gzip.compress(json.dumps(table(expected)).encode()))
    recording = load(path)
    same_directions(recording.motion, flat(expected), JOINTS)
    assert recording.motion.planar and recording.motion.times.tolist() == [0.0, 1.0, 2.0, 3.0]
    assert recording.labels[0].name == "T" and recording.notes[0] == "single poses, no motion"
    assert recording.motion.confidence == pytest.approx(0.8)
    assert load(path, rate=2.0).motion.times.tolist() == [0.0, 0.5, 1.0, 1.5]


def test_the_confidence_of_each_keypoint_is_taken_where_there_is_one(write):
    sure = np.linspace(0.1, 0.9, 25).tolist()
    skeleton = load(write(table(person(2), a=sure))).motion
    assert skeleton.confidence[0, skeleton.joints.index("left_wrist")] == pytest.approx(sure[ORDER.index("left_wrist")])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t: t["data"][1]["x"].pop(), ["frame 2", "x is a list of 24", "a list of 25"]),
        (lambda t: t["data"][1]["y"].__setitem__(3, "up"), ["frame 2", "'up'"]),
        (lambda t: t["data"].__setitem__(0, 5), ["frame 1", "5"]),
        (lambda t: t.update(data=[]), ["data"]),
        (lambda t: t.update(data="none"), ["'none'"]),
        (lambda t: t["data"][0].update(detection_accuracy="good"), ["frame 1", "'good'"]),
    ],
)
def test_a_mistake_in_a_table_of_poses_is_told(write, change, words):
    content = json.loads(json.dumps(table(person(2))))
    change(content)
    with pytest.raises(RecordingError) as caught:
        load(write(content))
    assert all(word in str(caught.value) for word in words), str(caught.value)
