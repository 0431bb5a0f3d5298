"""`.pose` files: every version and component, several people, and damage of any kind."""

import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.body import SIDES
from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.landmarks.marks import AXES, HAND
from tests.landmark_files import same_directions
from tests.people import in_file, person

BODY = ("nose", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
        "left_hip", "right_hip")  # fmt: skip
HANDS = {side: tuple(f"{side}_{joint}" for joint in HAND) for side in SIDES}
SIZE, PIXELS = (1000, 800), 250.0  # of the picture; pixels in a metre


def text(word):
    return struct.pack("<H", len(word)) + word.encode()


def component(name, points, form):
    names = b"".join(text(point) for point in points)
    return text(name) + text(form) + struct.pack("<HHH", len(points), 0, 0) + names


def header(version, form, hands=True):
    parts = [component("POSE_LANDMARKS", [joint.upper() for joint in BODY], form),
             component("FACE_LANDMARKS", ["0", "7", "10"], form)]  # fmt: skip
    parts += [
        component(f"{side.upper()}_HAND_LANDMARKS", [joint.upper() for joint in HAND], form) for side in SIDES * hands
    ]
    return struct.pack("<f4H", version, *SIZE, 0, len(parts)) + b"".join(parts)


def points(skeleton, depth, hands=True):
    """Everything of one person (T, N, D + 1) in pixels, confidence last."""
    dimensions = 3 if depth else 2
    order = (*BODY, "nose", "nose", "nose", *(joint for side in SIDES * hands for joint in HANDS[side]))
    places = in_file(skeleton, order, axes=AXES)[:, :, :dimensions] * PIXELS
    places[:, :, :2] += 400.0
    return np.dstack([places, np.full(places.shape[:2], 0.5)]).astype("<f4")


def content(people, version=0.2, depth=True, fps=25, hands=True):
    """A file with people, each (T, N, D + 1)."""
    start = header(version, "XYZC" if depth else "XYC", hands)
    frames = len(people[0])
    if version == 0.0:
        body = struct.pack("<HH", fps, frames)
        for frame in range(frames):
            body += struct.pack("<H", len(people))
            for number, told in enumerate(people):
                body += struct.pack("<h", 10 + number) + told[frame].tobytes()
        return start + body
    values = np.stack(people, axis=1)
    counts = (
        struct.pack("<fIH", fps, frames, len(people))
        if version > 0.15
        else struct.pack("<HHH", fps, frames, len(people))
    )
    return start + counts + values[..., :-1].tobytes() + values[..., -1].tobytes()


@pytest.mark.parametrize("version", [0.0, 0.1, 0.2])
@pytest.mark.parametrize("depth", [True, False])
def test_every_version_reads_the_same(write, version, depth):
    expected = person(7)
    recording = load(write(content([points(expected, depth)], version, depth)))
    skeleton = recording.motion
    assert recording.format == ".pose file" and f"version {version:.1f}" in recording.reason
    np.testing.assert_allclose(skeleton.times, np.arange(7) / 25)
    assert skeleton.planar is not depth and skeleton.confidence == pytest.approx(0.5)
    joints = (*BODY, *HANDS["left"], *HANDS["right"])
    flat = type(expected)(expected.times, expected.positions * [float(depth), 1.0, 1.0], expected.joints)
    same_directions(skeleton, flat, joints)


@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 999), frames=st.integers(1, 9), version=st.sampled_from([0.0, 0.1, 0.2]))
def test_what_is_written_is_read(tmp_path_factory, seed, frames, version):
    expected = person(frames, seed)
    path = tmp_path_factory.mktemp("law") / "x.pose"
    path.write_bytes(content([points(expected, True)], version))
    same_directions(load(path).motion, expected, BODY)


def test_depth_in_fractions_of_the_width_is_brought_to_pixels(write):
    expected = person(30)
    told = points(expected, True)
    told[:, :, 2] /= SIZE[0]
    same_directions(load(write(content([told]))).motion, expected, BODY)


@pytest.mark.parametrize("version", [0.0, 0.1, 0.2])
def test_of_several_people_the_one_tracked_longest_is_read_or_the_one_asked_for(write, version):
    first, second = points(person(9, 1), True), points(person(9, 2), True)
    first[3:, :, -1] = 0.0
    if version == 0.0:
        first[3:, :, :-1] = 0.0
    path = write(content([first, second], version))
    recording = load(path)
    assert any("several people" in note for note in recording.notes)
    same_directions(recording.motion, person(9, 2), BODY)
    name = "10" if version == 0.0 else "1"
    assert len(load(path, person=name).motion) == 3
    with pytest.raises(RecordingError, match="no person 'x'"):
        load(path, person="x")


def test_points_without_confidence_are_missing(write):
    told = points(person(4), True)
    told[2, BODY.index("left_elbow"), -1] = 0.0
    skeleton = load(write(content([told]))).motion
    assert np.isfinite(skeleton.track("left_elbow")).all(axis=1).tolist() == [True, True, False, True]


def test_v01_counts_more_than_65535_frames(write):
    few = points(person(3), False, hands=False)
    many = np.concatenate([few] * 22_000)
    data = content([many[: 65_536 + 5]], 0.2, False, hands=False)
    start = len(header(0.2, "XYC", False))
    data = header(0.1, "XYC", False) + struct.pack("<HHH", 25, 5, 1) + data[start + 10 :]
    assert len(load(write(data)).motion) == 65_541


GOOD = content([points(person(4), True)])


@pytest.mark.parametrize("version", [0.0, 0.1, 0.2])
def test_a_file_cut_off_anywhere_is_one_clear_line(write, version):
    data = content([points(person(3), True)], version)
    for length in np.linspace(20, len(data) - 1, 30).astype(int):
        with pytest.raises(RecordingError) as caught:
            load(write(data[:length]))
        assert "\n" not in str(caught.value)


@settings(max_examples=60, deadline=None)
@given(place=st.integers(0, len(GOOD) - 1), byte=st.integers(0, 255))
def test_a_damaged_byte_is_read_or_refused_in_one_line(tmp_path_factory, place, byte):
    path = tmp_path_factory.mktemp("any") / "x.pose"
    path.write_bytes(GOOD[:place] + bytes([byte]) + GOOD[place + 1 :])
    try:
        load(path)
    except RecordingError as error:
        assert "\n" not in str(error)


def refusal(path):
    with pytest.raises(RecordingError) as caught:
        load(path)
    return str(caught.value)


def test_what_is_wrong_is_said(write):
    assert "damaged file (4 whole frames where the header says 9)" in refusal(
        write(GOOD.replace(struct.pack("<fIH", 25, 4, 1), struct.pack("<fIH", 25, 9, 1)))
    )
    nobody = points(person(3), True)
    nobody[:, :, -1] = 0.0
    assert "nobody in any frame" in refusal(write(content([nobody])))
    assert "bytes after the last frame" in refusal(write(content([points(person(2), True)], 0.0) + b"\0" * 8))
    odd = (
        GOOD.replace(b"POSE_LANDMARKS", b"BALL_LANDMARKS").replace(b"SHOULDER", b"XXXXXXXX").replace(b"ELBOW", b"XXXXX")
    )
    odd = odd.replace(b"WRIST", b"XXXXX").replace(b"_HIP", b"_XXX").replace(b"NOSE", b"XXXX")
    assert "no body among BALL_LANDMARKS" in refusal(write(odd))
