"""Landmarks in JSON: every shape of the same frames reads the same, and mistakes are told with frame and landmark."""

import gzip
import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.body import twin
from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.landmarks.pictures import DEPTH
from nao_sim.recordings.skeletons.layouts import builtin
from tests.landmark_files import (
    BODY,
    HANDS,
    PICTURE,
    SHAPES,
    centred,
    dicts,
    in_lines,
    numbers,
    pictured,
    same_directions,
    same_places,
    seen,
)
from tests.people import in_file, person

TRUE = list(dict.fromkeys(BODY))


@pytest.fixture
def write(tmp_path):
    def write(content, name="take.json"):
        path = tmp_path / name
        path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize("shape", SHAPES)
def test_every_shape_of_the_same_landmarks_reads_the_same(write, shape):
    expected = seen(8)
    recording = load(write(SHAPES[shape](numbers(expected))), rate=30.0)
    skeleton = recording.motion
    assert recording.format == "landmarks (JSON)" and "33 landmarks (body)" in recording.reason
    assert len(skeleton) == 8 and not skeleton.planar
    same_places(skeleton, expected, TRUE)
    for joint in TRUE[1:]:
        column = expected.joints.index(joint)
        np.testing.assert_allclose(skeleton.confidence[:, skeleton.joints.index(joint)], expected.confidence[:, column])


@settings(max_examples=15, deadline=None)
@given(
    seed=st.integers(0, 999),
    frames=st.integers(2, 12),
    facing=st.floats(-0.6, 0.6),
    shape=st.sampled_from(list(SHAPES)),
)
def test_what_is_written_is_read(tmp_path_factory, seed, frames, facing, shape):
    expected = seen(frames, seed, facing=facing)
    path = tmp_path_factory.mktemp("law") / "x.json"
    path.write_text(SHAPES[shape](numbers(expected)))
    same_places(load(path, rate=30.0).motion, expected, TRUE)


def test_numbers_may_start_at_one(write):
    expected = seen(6)
    frames = [{str(i): point for i, point in enumerate(dicts(frame), start=1)} for frame in numbers(expected)]
    same_places(load(write(frames)).motion, expected, TRUE)


def test_numbers_of_another_skeleton_than_mediapipes_may_start_at_one(write):
    joints = next(layout.joints for layout in builtin() if layout.name == "Nuitrack (24)")
    expected = person(30)
    values = in_file(expected, joints, 0.001)
    frames = [[{"type": i, "real": dict(zip("xyz", point, strict=True))} for i, point in enumerate(frame, start=1)]
              for frame in values.tolist()]  # fmt: skip
    found = load(write(frames)).motion
    same_places(found, expected, [joint for joint in found.joints if joint in BODY])


def test_a_mirrored_file_gives_the_mirrored_person(write):
    there = numbers(seen(10))
    mirrored = there[:, [BODY.index(twin(joint)) for joint in BODY]] * [-1.0, 1.0, 1.0, 1.0]
    a, b = (load(write({"world_landmarks": [dicts(f) for f in w]})).motion for w in (there, mirrored))
    same_places(b, a.mirrored(), TRUE)


def test_world_landmarks_are_preferred_and_in_metres_with_the_person_facing_the_camera(write):
    expected = seen(10)
    world = numbers(expected)
    frames = [
        {"pose_landmarks": dicts(p), "pose_world_landmarks": dicts(w)}
        for p, w in zip(pictured(world), world, strict=True)
    ]
    recording = load(write(frames))
    same_places(recording.motion, expected, TRUE)
    assert "forward -z, left +x, up -y" in recording.reason and "scaled" not in " ".join(recording.notes)
    forward = (
        recording.motion.track("nose") - (recording.motion.track("left_ear") + recording.motion.track("right_ear")) / 2
    )
    assert (forward[:, 0] > 0.05).all()
    assert (recording.motion.track("left_shoulder")[:, 1] > recording.motion.track("right_shoulder")[:, 1]).all()


@pytest.mark.parametrize("about", [{"width": 640, "height": 480}, {"resolution": [640, 480]},
                                   {"metadata": {"video": {"width": 640, "height": 480}}},
                                   {"image_size": {"width": 640, "height": 480}}])  # fmt: skip
def test_a_picture_is_taken_at_its_ratio_and_scaled_to_an_adult(write, about):
    expected = seen(20, height=1.5)
    frames = [{"pose_landmarks": dicts(f)} for f in pictured(numbers(expected))]
    recording = load(write(about | {"frames": frames}))
    same_directions(recording.motion, expected, TRUE)
    notes = " ".join(recording.notes)
    assert "640 x 480" in notes and "scaled to an adult of 1.70 m" in notes
    height = np.linalg.norm(recording.motion.track("left_shoulder") - recording.motion.track("left_elbow"), axis=1)
    assert height == pytest.approx(1.7 * 0.172, rel=0.05)


@pytest.mark.parametrize(("size", "name"), [((640.0, 480.0), "4:3"), ((1280.0, 720.0), "16:9"), ((500.0, 500.0), "1:1"),
                                            ((480.0, 640.0), "3:4"), ((720.0, 1280.0), "9:16")])  # fmt: skip
@pytest.mark.parametrize("depth", [1.0, DEPTH])
def test_the_shape_of_a_picture_of_unknown_size_is_told_by_the_body_in_it_and_said(write, size, name, depth):
    expected = seen(60, arms=0.8)
    values = pictured(numbers(expected), size, 1.0 / depth)
    recording = load(write([{"pose_landmarks": dicts(f)} for f in values]))
    same_directions(recording.motion, expected, TRUE)
    assert any(f"unknown size: taken as {name}" in note for note in recording.notes)
    assert any(f"depth taken times {DEPTH:g}" in note for note in recording.notes) is (depth < 1.0)


def test_pixels_need_no_size(write):
    expected = seen(12)
    values = pictured(numbers(expected)) * [*PICTURE, PICTURE[0], 1.0]
    recording = load(write([{"pose_landmarks": dicts(f)} for f in values]))
    same_directions(recording.motion, expected, TRUE)
    assert not any("unknown size" in note for note in recording.notes)


def hands_in(expected, side, size=PICTURE):
    """A hand in the picture, its depth from its own wrist, a little beside the body's wrist."""
    found = pictured(numbers(expected, HANDS[side]), size)[:, :, :3]
    found[:, :, 2] -= found[:, :1, 2]
    return found + np.array([0.01, 0.01, 0.0])


@pytest.mark.parametrize("keys", [("left_hand", "right_hand"), ("leftHandLandmarks", "rightHandLandmarks"),
                                  ("left_hand_landmarks", "right_hand_landmarks")])  # fmt: skip
def test_hands_are_put_at_the_bodys_wrists(write, keys):
    expected = seen(12)
    body, hands = (
        pictured(numbers(expected)),
        {key: hands_in(expected, side) for key, side in zip(keys, HANDS, strict=True)},
    )
    frames = [
        {"pose": dicts(f)} | {key: points[i].tolist() for key, points in hands.items()} for i, f in enumerate(body)
    ]
    frames[3][keys[0]] = None
    skeleton = load(write({"width": 640, "height": 480, "frames": frames})).motion
    size = np.linalg.norm(skeleton.track("left_shoulder") - skeleton.track("right_shoulder"), axis=1)
    size /= np.linalg.norm(expected.track("left_shoulder") - expected.track("right_shoulder"), axis=1)
    for side, joints in HANDS.items():
        there = [i for i in range(12) if not (side == "left" and i == 3)]
        for joint in joints:
            told = (skeleton.track(joint) - skeleton.track(f"{side}_wrist"))[there]
            true = (expected.track(joint) - expected.track(f"{side}_wrist"))[there]
            np.testing.assert_allclose(told, true * size[there, None], atol=1e-6)
    assert np.isnan(skeleton.track("left_middle_tip")[3]).all()
    assert np.isfinite(skeleton.track("left_wrist")[3]).all() and np.isfinite(skeleton.track("left_index_mcp")[3]).all()


def test_hands_of_a_picture_are_brought_to_the_size_of_world_landmarks(write):
    expected = seen(12)
    world = numbers(expected)
    frames = [
        {"pose_landmarks": dicts(p), "pose_world_landmarks": dicts(w), "left_hand_landmarks": h.tolist()}
        for p, w, h in zip(pictured(world), world, hands_in(expected, "left"), strict=True)
    ]
    skeleton = load(write({"width": 640, "height": 480, "frames": frames})).motion
    same_places(skeleton, expected, HANDS["left"], 2e-3)


def test_a_holistic_row_of_1662_numbers(write):
    expected = seen(6)
    body, left = pictured(numbers(expected), (1.0, 1.0)), hands_in(expected, "left", (1.0, 1.0))
    rows = [[*f.ravel(), *np.zeros(468 * 3), *h.ravel(), *np.zeros(63)] for f, h in zip(body, left, strict=True)]
    skeleton = load(write(rows)).motion
    assert "left_ring_tip" in skeleton.joints and "right_ring_tip" not in skeleton.joints
    same_directions(skeleton, expected, TRUE)


KINECT = {"left_shoulder": "ShoulderLeft", "right_shoulder": "ShoulderRight", "left_elbow": "ElbowLeft",
          "right_elbow": "ElbowRight", "left_wrist": "WristLeft", "right_wrist": "WristRight", "head": "Head",
          "chest": "SpineShoulder", "pelvis": "SpineBase", "left_hip": "HipLeft", "right_hip": "HipRight",
          "left_knee": "KneeLeft", "right_knee": "KneeRight", "neck": "Neck"}  # fmt: skip


def kinect(expected, frame):
    places = in_file(expected, tuple(KINECT)).tolist()[frame]
    return {
        name: {"Position": dict(zip("XYZ", place, strict=True)), "TrackingState": 2}
        for name, place in zip(KINECT.values(), places, strict=True)
    }


@pytest.mark.parametrize("shape", ["tables", "Joints", "lists", "names in points", "bodies", "tracks"])
def test_joints_by_name(write, shape):
    expected = person(10)
    frames = [kinect(expected, i) for i in range(10)]
    shapes = {
        "tables": frames,
        "Joints": [{"Timestamp": i / 30, "Joints": f} for i, f in enumerate(frames)],
        "lists": [{name: list(p["Position"].values()) for name, p in f.items()} for f in frames],
        "names in points": [[{"name": name, **p["Position"]} for name, p in f.items()] for f in frames],
        "bodies": [{"Bodies": [{"TrackingId": "72", "Joints": f}]} for f in frames],
        "tracks": {name: [list(f[name]["Position"].values()) for f in frames] for name in frames[0]},
    }
    skeleton = load(write(shapes[shape]), rate=None if shape == "Joints" else 30.0).motion
    same_places(skeleton, expected, KINECT)
    np.testing.assert_allclose(skeleton.times, np.arange(10) / 30, atol=1e-9)


def test_tracking_states_are_confidences(write):
    frames = [kinect(person(3), i) for i in range(3)]
    frames[1]["WristLeft"]["TrackingState"] = 1
    frames[2]["WristLeft"]["TrackingState"] = "NotTracked"
    skeleton = load(write(frames)).motion
    assert skeleton.confidence[:, skeleton.joints.index("left_wrist")].tolist() == [1.0, 0.5, 0.0]
    assert np.isnan(skeleton.track("left_wrist")[2]).all()


def test_keypoints_in_a_picture_without_depth_are_planar(write):
    expected = seen(10)
    pixels = pictured(numbers(expected)) * [*PICTURE, 1.0, 1.0]
    frames = [
        {
            "keypoints": [
                {"name": j, "x": p[0], "y": p[1], "score": p[3]} for j, p in zip(BODY, f, strict=True) if j in KINECT
            ]
        }
        for f in pixels.tolist()
    ]
    skeleton = load(write(frames)).motion
    assert skeleton.planar and (skeleton.positions[:, :, 0] == 0.0).all()
    flat = replace(expected, positions=expected.positions * [0.0, 1.0, 1.0])
    same_directions(skeleton, flat, [joint for joint in TRUE if joint in KINECT])


# Times


@pytest.mark.parametrize(
    ("about", "each", "times"),
    [
        ({"fps": 25}, {}, [0.0, 0.04, 0.08]),
        ({"metadata": {"frame_rate": "25"}}, {}, [0.0, 0.04, 0.08]),
        ({"fps": 25}, {"frame": [3, 4, 7]}, [0.0, 0.04, 0.16]),
        ({"fps": 25}, {"timestamp_ms": [1000, 1050, 1200]}, [0.0, 0.05, 0.2]),
        ({}, {"timestamp": [12.0, 12.05, 12.1]}, [0.0, 0.05, 0.1]),
        ({}, {"timestamp": [12000, 12050, 12100]}, [0.0, 0.05, 0.1]),
        ({}, {"t": ["2024-05-01T10:00:00.000", "2024-05-01T10:00:00.050", "2024-05-01T10:00:00.1"]}, [0, 0.05, 0.1]),
        ({"timestamps": [0.0, 0.5, 0.7]}, {}, [0.0, 0.5, 0.7]),
        ({}, {"frame": [10, 11, 13]}, [0.0, 1 / 30, 3 / 30]),
        ({}, {}, [0.0, 1 / 30, 2 / 30]),
    ],
)  # fmt: skip
def test_times_are_the_files(write, about, each, times):
    world = numbers(seen(3))
    frames = [{key: values[i] for key, values in each.items()} | {"world": dicts(f)} for i, f in enumerate(world)]
    np.testing.assert_allclose(load(write(about | {"frames": frames})).motion.times, times, atol=1e-6)


def test_the_callers_rate_is_taken_where_the_file_has_none_and_refused_where_it_has(write, refused):
    frames = [dicts(f) for f in numbers(seen(3))]
    np.testing.assert_allclose(load(write(frames), rate=10.0).motion.times, [0.0, 0.1, 0.2])
    assert "a rate of 10 Hz" in str(refused({"fps": 30, "frames": frames}, rate=10.0))


# Several people


def crowd(ids):
    tall, small = numbers(seen(12, 1)), numbers(seen(12, 2, height=1.3))
    small[:, :, 0] += 2.0
    frames = []
    for i in range(12):
        here = [{"world_landmarks": dicts(tall[i])} | ({"id": "first"} if ids else {})]
        here += [{"world_landmarks": dicts(small[i])} | ({"id": "second"} if ids else {})] if i >= 3 else []
        frames.append({"people": here[::-1] if i % 2 else here})
    return frames


@pytest.mark.parametrize("ids", [True, False])
def test_the_person_tracked_longest_is_read_whatever_the_order(write, ids):
    recording = load(write(crowd(ids)))
    same_places(recording.motion, seen(12, 1), TRUE)
    assert any("several people" in note for note in recording.notes)


@pytest.mark.parametrize(("ids", "name"), [(True, "second"), (False, "2")])
def test_a_person_is_picked_by_id(write, refused, ids, name):
    skeleton = load(write(crowd(ids)), person=name).motion
    assert len(skeleton) == 9
    wide = np.linalg.norm(skeleton.track("left_shoulder") - skeleton.track("right_shoulder"), axis=1)
    assert wide == pytest.approx(0.21 * 1.3)
    assert "no person 'ninth'" in str(refused(crowd(ids), person="ninth"))


# What is missing


def test_null_zero_and_nan_are_missing_points(write):
    frames = [dicts(f) for f in numbers(seen(5))]
    frames[1][13] = None
    frames[2][13] = {"x": 0.0, "y": 0.0, "z": 0.0, "visibility": 0.0}
    frames[3][13]["x"] = float("nan")
    skeleton = load(write(frames)).motion
    assert np.isfinite(skeleton.track("left_elbow")).all(axis=1).tolist() == [True, False, False, False, True]


def test_frames_without_anybody_are_gaps(write):
    frames = [{"pose_landmarks": dicts(f)} for f in numbers(seen(6))]
    frames[2] = {"pose_landmarks": None}
    frames[3] = {"pose_landmarks": []}
    frames[4] = {}
    skeleton = load(write(frames)).motion
    assert len(skeleton) == 6 and np.isfinite(skeleton.track("nose")).all(axis=1).tolist() == [1, 1, 0, 0, 0, 1]


def test_some_of_mediapipes_landmarks_by_number_are_still_mediapipes(write):
    expected = seen(8)
    numbers_kept = [0, 11, 12, 13, 14, 15, 16, 23, 24]
    frames = [{"pose": {str(i): f[i, :3].tolist() for i in numbers_kept}} for f in numbers(expected)]
    skeleton = load(write({"frames": frames})).motion
    assert set(skeleton.joints) == {BODY[i] for i in numbers_kept}
    same_places(skeleton, expected, skeleton.joints)


def test_the_users_own_layout_says_what_the_points_are(write, tmp_path):
    joints = (
        "left_wrist",
        "left_elbow",
        "left_shoulder",
        "head",
        "right_shoulder",
        "right_elbow",
        "right_wrist",
        "pelvis",
    )
    layout = tmp_path / "mine.toml"
    layout.write_text(f'name = "mine"\njoints = {list(joints)}\nunit = "cm"\n'.replace("'", '"'))
    expected = person(6)
    path = write([{"points": frame} for frame in in_file(expected, joints, 0.01).tolist()])
    same_places(load(path, layout=layout).motion, expected, joints)


def test_a_label_of_the_file_is_kept(write):
    frames = [dicts(f) for f in numbers(seen(4))]
    (label,) = load(write({"label": "wave", "fps": 10, "frames": frames})).labels
    assert (label.name, label.start, label.end) == ("wave", 0.0, pytest.approx(0.3))


def test_one_frame_is_a_recording(write):
    assert len(load(write({"pose_world_landmarks": dicts(numbers(seen(1))[0])})).motion) == 1


def test_a_compressed_file_and_a_byte_order_mark(write, tmp_path):
    text = json.dumps([dicts(f) for f in numbers(seen(4))])
    path = tmp_path / "x.json.gz"
    path.write_bytes(gzip.compress(text.encode()))
    assert len(load(path).motion) == 4
    assert len(load(write("\ufeff" + text)).motion) == 4


# Mistakes

GOOD = [dicts(frame) for frame in numbers(seen(5))]


def spoiled(change):
    frames = json.loads(json.dumps(GOOD))
    change(frames)
    return frames


MISTAKES = {
    "a text for a coordinate": (spoiled(lambda f: f[2][4].update(x="left")), ["frame 3", "landmark 4", "'left'"]),
    "true for a coordinate": (spoiled(lambda f: f[2][4].update(x=True)), ["frame 3", "landmark 4", "true"]),
    "a list for a coordinate": (spoiled(lambda f: f[2][4].update(z=[1])), ["frame 3", "landmark 4", "a list of 1"]),
    "a text for a visibility": (spoiled(lambda f: f[0][0].update(visibility="ok")), ["frame 1", "visibility", "'ok'"]),
    "a text for a landmark": (spoiled(lambda f: f[1].__setitem__(32, "gone")), ["frame 2", "landmark 32", "'gone'"]),
    "a landmark too few": (spoiled(lambda f: f[3].pop()), ["frame 4", "32 landmarks", "33, as in frame 1"]),
    "a frame of text": (spoiled(lambda f: f.__setitem__(2, "lost")), ["frame 3", "'lost'"]),
    "a number so large": (spoiled(lambda f: f[1][0].update(x=10**400)), ["frame 2", "landmark 0"]),
    "nothing but null": ([[None] * 33] * 3, ["landmarks"]),
    "hands and no body": ([{"left_hand": GOOD[0][:21]}] * 3, ["only 21 landmarks (left)", "body"]),
    "points of no layout": ([f[:9] for f in GOOD], ["9 points", "--layout"]),
    "package.json": ({"name": "x", "version": "1", "main": {"a": "b"}}, ["keys name, version, main"]),
    "an empty list": ([], ["a list of 0"]),
    "an empty table": ({}, ["an empty table"]),
    "a list of numbers": ([1, 2, 3], ["a list of 3"]),
    "a list of texts": (["a", "b"], ["a list of 2 (first 'a')"]),
    "parts of different lengths": ({"pose_landmarks": GOOD, "left_hand": [GOOD[0][:21]]}, ["5 pose_landmarks"]),
    "a rate of text": ({"fps": "fast", "frames": GOOD}, ["frame rate is 'fast'"]),
    "a time of text": ([{"time": "soon", "landmarks": f} for f in GOOD], ["frame 1", "time is 'soon'"]),
    "times that go back": ([{"time": -i, "landmarks": f} for i, f in enumerate(GOOD)], ["after"]),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_frame_and_landmark(refused, mistake):
    content, words = MISTAKES[mistake]
    message = str(refused(content))
    assert all(word in message for word in words), message
    assert len(message) < 700


@pytest.mark.parametrize(
    ("text", "line", "column", "words"),
    [
        ('[{"x": 1, "y": 2}\n {"x": 1}]', 2, 2, ["broken JSON", "delimiter"]),
        ('{"frames": [[', 1, 14, ["ends in the middle"]),
        ('[\n{"pose": [\n1,,2]}]', 3, 3, ["broken JSON"]),
        ('{"a": 1}\n{"b" 2}\n', 2, 6, ["broken JSON"]),
        ('{"a": tru}', 1, 7, ["broken JSON"]),
        ('["' + "a" * 50, 1, 2, ["broken JSON"]),
    ],
)
def test_broken_json_is_told_with_line_and_column(refused, text, line, column, words):
    error = refused(text)
    assert (error.line, error.column) == (line, column) and all(word in str(error) for word in words)


def test_json_cut_off_anywhere_is_one_clear_line(refused):
    text = json.dumps(GOOD[:2])
    for place in np.linspace(3, len(text) - 1, 40).astype(int):
        assert "broken JSON" in str(refused(text[:place]))


def test_json_that_is_nested_without_end_is_refused(refused):
    assert "nested too deeply" in str(refused("[" * 100_000))


def test_bytes_that_are_not_text(tmp_path):
    path = tmp_path / "x.json"
    path.write_bytes(b'[{"name": "Zo\xeb"}\n]')
    with pytest.raises(RecordingError, match=r"line 1: bytes that are not UTF-8 text"):
        load(path)


@settings(max_examples=60, deadline=None)
@given(
    content=st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(max_size=4),
        lambda inner: (
            st.lists(inner, max_size=6)
            | st.dictionaries(
                st.sampled_from(["x", "y", "pose", "frames", "left_hand", "people", "0", "11", "id"]), inner
            )
        ),
        max_leaves=30,
    )
)
def test_any_json_is_read_or_refused_in_one_line(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("any") / "x.json"
    path.write_text(json.dumps(content))
    try:
        load(path)
    except RecordingError as error:
        assert "\n" not in str(error)


def test_a_line_of_json_lines_is_blamed(refused):
    documents = [{"landmarks": frame} for frame in json.loads(json.dumps(GOOD))]
    documents[3]["landmarks"][7]["y"] = "low"
    error = refused(in_lines(documents))
    assert error.line == 4 and "landmark 7" in str(error)


def test_centred_people_are_what_the_tests_say():
    hips = centred(person(3))
    np.testing.assert_allclose((hips.track("left_hip") + hips.track("right_hip")) / 2, 0.0, atol=1e-12)
