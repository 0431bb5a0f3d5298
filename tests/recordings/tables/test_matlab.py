"""MATLAB's `.mat` files: every order of axes reads the same, and what is no person is told with its variables."""

import io
import itertools
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat
from scipy.sparse import csc_array

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.recordings.tables.matlab_tags import check_tags
from tests.people import in_file, person

UTD = next(layout.joints for layout in builtin() if layout.name == "UTD-MHAD")
KINECT_2 = next(layout.joints for layout in builtin() if layout.name == "Kinect v2")


@pytest.fixture
def write(tmp_path):
    def write(variables, **options):
        path = tmp_path / "take.mat"
        savemat(path, variables, **options)
        return path

    return write


def told(path, **options):
    with pytest.raises(RecordingError) as caught:
        load(path, **options)
    message = str(caught.value)
    assert message.startswith(str(path)) and "\n" not in message
    return message


def kinect(skeleton, joints=UTD):
    """Numbers (T, J, 3) of a Kinect, metres."""
    return in_file(skeleton, joints)


def same_places(found, expected, joints, within=1e-9):
    for joint in joints:
        if joint != "-":
            np.testing.assert_allclose(found.track(joint), expected.track(joint), atol=within, err_msg=joint)


@pytest.mark.parametrize("order", list(itertools.permutations(range(3))))
def test_axes_may_come_in_any_order(write, order):
    expected = person(50)
    recording = load(write({"d_skel": np.transpose(kinect(expected), order)}))
    assert recording.format == "MATLAB .mat" and recording.frames == 50
    assert "variable d_skel" in recording.reason and "coordinates" in recording.reason
    same_places(recording.motion, expected, UTD)


@settings(max_examples=10, deadline=None)
@given(
    seed=st.integers(0, 999),
    frames=st.sampled_from([1, 9, 41]),
    order=st.permutations(range(3)),
    unit=st.sampled_from([1.0, 0.001]),
)
def test_what_is_written_is_read(tmp_path_factory, seed, frames, order, unit):
    expected = person(frames, seed)
    path = tmp_path_factory.mktemp("law") / "x.mat"
    savemat(path, {"skeleton": np.transpose(kinect(expected) / unit, order)})
    same_places(load(path).motion, expected, UTD)


@pytest.mark.parametrize("rows", ["joint by joint", "axis by axis"])
@pytest.mark.parametrize("turned", [False, True])
def test_tables_of_a_frame_a_row_or_a_column(write, rows, turned):
    expected = person(50)
    values = kinect(expected) if rows == "joint by joint" else np.swapaxes(kinect(expected), 1, 2)
    table = values.reshape(50, -1)
    recording = load(write({"X": table.T if turned else table}))
    same_places(recording.motion, expected, UTD)


def test_a_table_may_have_times_or_confidences(write):
    expected = person(50, rate=20.0)
    flat = kinect(expected).reshape(50, -1)
    recording = load(write({"X": np.column_stack([expected.times + 7.0, flat])}))
    same_places(recording.motion, expected, UTD)
    np.testing.assert_allclose(recording.motion.times, expected.times, atol=1e-9)
    states = np.where(np.arange(50)[:, None] == 4, 0.0, np.full((50, len(UTD)), 2.0))
    found = load(write({"X": np.dstack([kinect(expected), states]).reshape(50, -1)})).motion
    assert np.isnan(found.positions[4]).all() and np.isfinite(found.positions[5:]).all()


def test_the_number_of_frames_may_be_that_of_joints_of_another_skeleton(write):
    expected = person(25)
    same_places(load(write({"d": np.transpose(kinect(expected), (1, 2, 0))})).motion, expected, UTD)


def test_compressed_and_uncompressed_files_read_the_same(write):
    values = kinect(person(30))
    for compressed in (True, False):
        assert len(load(write({"d": values}, do_compression=compressed)).motion) == 30


def test_a_struct_with_the_rate_and_a_cell_of_frames(write):
    expected = person(20)
    cells = np.empty(20, object)
    for frame, values in enumerate(kinect(expected)):
        cells[frame] = values
    recording = load(write({"S": {"frames": cells, "fps": 15.0, "subject": "a"}}))
    same_places(recording.motion, expected, UTD)
    np.testing.assert_allclose(recording.motion.times, np.arange(20) / 15.0)


def test_times_of_the_file(write):
    times = np.cumsum(np.full(20, 0.05))
    recording = load(write({"pos": kinect(person(20)), "time": times}))
    np.testing.assert_allclose(recording.motion.times, times - times[0])


def test_a_track_for_each_joint(write):
    expected = person(20)
    joints = (
        "head",
        "left_shoulder",
        "right_shoulder",
        "left_elbow",
        "right_elbow",
        "left_wrist",
        "right_wrist",
        "pelvis",
    )
    names = ("Head", "ShoulderLeft", "ShoulderRight", "ElbowLeft", "ElbowRight", "WristLeft", "WristRight", "SpineBase")
    places = in_file(expected, joints)
    tracks = {name: places[:, i].T if i % 2 else places[:, i] for i, name in enumerate(names)}
    same_places(load(write({"body": tracks, "subject": 3.0})).motion, expected, joints)
    same_places(load(write(tracks)).motion, expected, joints)


def test_names_beside_an_array_are_its_joints(write):
    expected = person(20)
    joints = ("left_wrist", "left_elbow", "left_shoulder", "neck", "right_shoulder", "right_elbow", "right_wrist",
              "head", "pelvis")  # fmt: skip
    names = np.array(["LWri", "LElb", "LSho", "Neck", "RSho", "RElb", "RWri", "Head", "Hips"], object)
    names[[0, 6]] = ["LWrist", "RWrist"]
    recording = load(write({"joint_names": names, "data": in_file(expected, joints)}))
    same_places(recording.motion, expected, joints)


def test_several_people_are_named_and_one_is_picked(write):
    path = write({"first": kinect(person(30, 1)), "second": kinect(person(30, 2)), "note": "x"})
    message = told(path)
    assert "several people" in message and "first as" in message and "second as" in message and "--person" in message
    same_places(load(path, person="second").motion, person(30, 2), UTD)
    assert "no variable 'ninth'" in told(path, person="ninth")


def test_other_arrays_beside_the_person_do_not_matter(write):
    noise = np.random.default_rng(0).normal(size=(20, 3, 30))
    recording = load(
        write({"d_skel": np.transpose(kinect(person(30)), (1, 2, 0)), "other": noise, "labels": np.arange(30)})
    )
    assert "variable d_skel" in recording.reason


def test_what_is_no_person_is_told_with_its_variables(write):
    message = told(write({"DataBySeq": {"X": np.zeros((382, 12)), "name": "a"}, "Names": np.array(["a", "b"], object)}))
    assert "DataBySeq.X (382 x 12)" in message and "Names (2 words)" in message
    assert "no variables" in told(write({}))
    noise = np.random.default_rng(0).normal(size=(20, 3, 30))
    assert "noise as 20 x 3 x 30" in told(write({"noise": noise}))


def test_the_newer_format_is_refused_with_advice(tmp_path):
    path = tmp_path / "x.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM" + b"\0" * 400)
    assert "v7.3" in told(path) and "'-v7'" in told(path)
    path.write_bytes(b"\x89HDF\r\n\x1a\n" + b"\0" * 100)
    assert "HDF5" in told(path) and "'-v7'" in told(path)


def test_a_file_cut_off_anywhere_is_one_clear_line(write):
    whole = write({"d": kinect(person(10)), "s": {"a": 1.0}}).read_bytes()
    for length in np.linspace(130, len(whole) - 1, 25).astype(int):
        path = write({"x": 1.0})
        path.write_bytes(whole[:length])
        try:
            load(path)
        except RecordingError as error:
            assert "\n" not in str(error)


@settings(max_examples=60, deadline=None)
@given(place=st.integers(0, 2000), byte=st.integers(0, 255))
def test_a_damaged_byte_is_read_or_refused_in_one_line(tmp_path_factory, place, byte):
    path = tmp_path_factory.mktemp("any") / "x.mat"
    savemat(path, {"d": kinect(person(2)), "s": {"a": 1.0}}, do_compression=bool(zlib.crc32(bytes([byte])) % 2))
    data = bytearray(path.read_bytes())
    data[place % len(data)] = byte
    path.write_bytes(bytes(data))
    try:
        load(path)
    except RecordingError as error:
        assert "\n" not in str(error)


@pytest.mark.parametrize("kind", [0, 8, 14, 20, 97])
def test_an_array_of_a_type_that_does_not_exist_is_refused_before_it_ends_the_program(tmp_path, kind):
    path = tmp_path / "x.mat"
    savemat(path, {"d": kinect(person(2))})
    data = bytearray(path.read_bytes())
    assert data[184:188] == b"\t\0\0\0"  # the type of the numbers: double
    data[184] = kind
    path.write_bytes(bytes(data))
    with pytest.raises(RecordingError, match="damaged"):
        load(path)


@pytest.mark.parametrize("compressed", [False, True])
def test_whatever_is_written_as_it_should_be_has_tags_as_they_should_be(compressed):
    file = io.BytesIO()
    cells = np.empty((2, 2), object)
    cells[:] = [[np.eye(3), "words"], [{"deep": {"deeper": 1j}}, np.array([])]]
    everything = {"cells": cells, "sparse": csc_array(np.eye(4) * 2j), "words": ["a", "bcd"], "whole": np.uint8([1, 2]),
                  "true": np.array([True]), "complex": np.ones((2, 3)) * 1j, "empty": np.zeros((0, 3))}  # fmt: skip
    savemat(file, everything, do_compression=compressed, long_field_names=True)
    check_tags(file.getvalue())
