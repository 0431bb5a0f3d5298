"""Tables of points: every way to name the columns reads the same, and mistakes are told with line and column."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.body import twin
from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.tables.column_names import columns_of, parts_and_keys
from tests.landmark_files import BODY, PICTURE, numbers, pictured, same_places, seen
from tests.people import in_file, person

KINECT = {"head": "Head", "neck": "Neck", "chest": "SpineShoulder", "pelvis": "SpineBase",
          "left_shoulder": "ShoulderLeft",
          "right_shoulder": "ShoulderRight", "left_elbow": "ElbowLeft", "right_elbow": "ElbowRight",
          "left_wrist": "WristLeft", "right_wrist": "WristRight", "left_hip": "HipLeft", "right_hip": "HipRight",
          "left_knee": "KneeLeft", "right_knee": "KneeRight"}  # fmt: skip
JOINTS = tuple(KINECT)
# How to write a joint and an axis: name of the joint (Kinect's, words), axis x, y or z.
SPELLINGS = {
    "ShoulderLeft_x": lambda kinect, joint, axis: f"{kinect}_{axis}",
    "left_shoulder.X": lambda kinect, joint, axis: f"{joint}.{axis.upper()}",
    "Left Shoulder X": lambda kinect, joint, axis: f"{joint.replace('_', ' ').title()} {axis.upper()}",
    "x_ShoulderLeft": lambda kinect, joint, axis: f"{axis}_{kinect}",
    "ShoulderLeftX": lambda kinect, joint, axis: f"{kinect}{axis.upper()}",
    "ShoulderLeft:X": lambda kinect, joint, axis: f"{kinect}:{axis.upper()}",
    "ShoulderLeft.Position.X": lambda kinect, joint, axis: f"{kinect}.Position.{axis.upper()}",
    "pos_x_ShoulderLeft": lambda kinect, joint, axis: f"pos_{axis}_{kinect}",
    "LEFT_SHOULDER_x": lambda kinect, joint, axis: f"{joint.upper()}_{axis}",
    "leftshoulderx": lambda kinect, joint, axis: joint.replace("_", "") + axis,
    "ShoulderLeft [x]": lambda kinect, joint, axis: f"{kinect} [{axis}]",
}


def table(skeleton, spell=SPELLINGS["ShoulderLeft_x"], unit=1.0, mark=",", time="time", before="", joints=JOINTS):
    """A table with a header of spelled names."""
    names = [spell(KINECT[joint], joint, axis) for joint in joints for axis in "xyz"]
    values = in_file(skeleton, joints, unit).reshape(len(skeleton), -1)
    columns = np.column_stack([skeleton.times, values]) if time else values
    head = mark.join([time, *names] if time else names)
    return before + head + "\n" + "".join(mark.join(map(repr, row)) + "\n" for row in columns.tolist())


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_every_way_to_name_the_columns_reads_the_same(write, spelling):
    expected = person(6)
    recording = load(write(table(expected, SPELLINGS[spelling])))
    assert recording.format == "table of points" and recording.frames == 6
    same_places(recording.motion, expected, JOINTS)
    np.testing.assert_allclose(recording.motion.times, expected.times, atol=1e-12)


@settings(max_examples=20, deadline=None)
@given(
    seed=st.integers(0, 999),
    spelling=st.sampled_from(list(SPELLINGS)),
    unit=st.sampled_from([1.0, 0.01, 0.001]),
    mark=st.sampled_from([",", ";", "\t"]),
    order=st.permutations(range(len(JOINTS))),
)
def test_columns_may_come_in_any_order_unit_and_separator(tmp_path_factory, seed, spelling, unit, mark, order):
    expected = person(5, seed)
    joints = tuple(JOINTS[place] for place in order)
    path = tmp_path_factory.mktemp("law") / "x.csv"
    path.write_text(table(expected, SPELLINGS[spelling], unit, mark, joints=joints))
    same_places(load(path).motion, expected, JOINTS)


def test_a_mirrored_file_gives_the_mirrored_person(write):
    expected = person(8)
    text = table(expected)
    swapped = ",".join(["time", *(f"{KINECT[twin(joint)]}_{axis}" for joint in JOINTS for axis in "xyz")])
    rows = [line.split(",") for line in text.splitlines()[1:]]
    mirrored = [[v if i % 3 != 1 else repr(-float(v)) for i, v in enumerate(row)] for row in rows]
    content = "\n".join([swapped, *(",".join(row) for row in mirrored)])
    same_places(load(write(content)).motion, load(write(text)).motion.mirrored(), JOINTS)


@pytest.mark.parametrize("name", ["Head X (mm)", "Head_X_mm", "Head X [mm]", "X Head (mm)"])
def test_a_unit_in_the_names_is_taken(write, name):
    def spell(kinect, joint, axis):
        return name.replace("Head", kinect).replace("X", axis.upper())

    same_places(load(write(table(person(4), spell, 0.001))).motion, person(4), JOINTS)


@pytest.mark.parametrize("comment", ["# unit: mm\n", "# Units = millimetres\n", "# made by me\n# units: mm\n\n"])
def test_a_unit_in_a_comment_is_taken(write, comment):
    same_places(load(write(table(person(4), unit=0.001, before=comment))).motion, person(4), JOINTS)


@pytest.mark.parametrize(
    ("column", "values", "times"),
    [
        ("time", [1.5, 1.6, 1.8], [0.0, 0.1, 0.3]),
        ("timestamp", [1500, 1533, 1600], [0.0, 0.033, 0.1]),
        ("Timestamp (ms)", [0, 2000, 5000], [0.0, 2.0, 5.0]),
        ("Time (Seconds)", [0, 2, 5], [0.0, 2.0, 5.0]),
        ("timestamp", [636000000000000000, 636000000000333333, 636000000001000000], [0.0, 0.0333, 0.1]),
        ("Frame", [7, 8, 11], [0.0, 1 / 30, 4 / 30]),
        ("time", ["10:00:00.0", "10:00:00.1", "10:00:00.3"], [0.0, 0.1, 0.3]),
        ("time", ["10:00:00", "10:00:02", "10:00:05"], [0.0, 2.0, 5.0]),
        ("timestamp_ms", ["2024-01-01T10:00:00Z", "2024-01-01T10:00:01Z", "2024-01-01T10:00:03Z"], [0.0, 1.0, 3.0]),
        ("Time", ["1/2/2024 11:59:59 PM", "1/3/2024 12:00:00 AM", "1/3/2024 12:00:02 AM"], [0.0, 1.0, 3.0]),
        ("timestamp", ["2024-01-01 10:00:00", "2024-01-01 10:00:00.100", "2024-01-01 10:00:00.300"], [0.0, 0.1, 0.3]),
    ],
)
def test_times_are_read_in_every_unit(write, column, values, times):
    head, *rows = table(person(3), time="").splitlines()
    content = "\n".join([f"{column},{head}", *(f"{value},{row}" for value, row in zip(values, rows, strict=True))])
    np.testing.assert_allclose(load(write(content)).motion.times, times, atol=1e-3)


def test_a_table_without_times_has_the_callers_rate_or_the_usual_one(write):
    path = write(table(person(3), time=""))
    np.testing.assert_allclose(load(path, rate=10.0).motion.times, [0.0, 0.1, 0.2])
    assert any("30 frames a second" in note for note in load(path).notes)
    commented = load(write(table(person(3), time="", before="# fps: 20\n")))
    np.testing.assert_allclose(commented.motion.times, [0.0, 0.05, 0.1])


def with_beside(skeleton, name, cell):
    """A table with one more column for each joint."""
    names = [
        text for joint in JOINTS for text in (*(f"{KINECT[joint]}_{axis}" for axis in "xyz"), f"{KINECT[joint]}{name}")
    ]
    places = in_file(skeleton, JOINTS).tolist()
    rows = [
        [text for j, p in enumerate(frame) for text in (*map(repr, p), cell(i, j))] for i, frame in enumerate(places)
    ]
    return "\n".join([",".join(names), *(",".join(row) for row in rows)])


@pytest.mark.parametrize(
    ("name", "cells", "confidences"),
    [
        ("_visibility", ("0.25", "1"), (0.25, 1.0)),
        ("_score", ("25", "100"), (0.25, 1.0)),
        ("_TrackingState", ("1", "2"), (0.5, 1.0)),
        (".TrackingState", ("Inferred", "Tracked"), (0.5, 1.0)),
        ("_tracked", ("0.5", "1"), (0.5, 1.0)),
        ("_inferred", ("1", "0"), (0.5, 1.0)),
        ("_inferred", ("True", "False"), (0.5, 1.0)),
        ("_confidence", ("1", "3"), (1 / 3, 1.0)),
    ],
)
def test_states_and_confidences_of_every_kind(write, name, cells, confidences):
    text = with_beside(person(3), name, lambda frame, joint: cells[0] if frame == 1 and joint == 9 else cells[1])
    skeleton = load(write(text)).motion
    told = skeleton.confidence[:, skeleton.joints.index(JOINTS[9])]
    np.testing.assert_allclose(told, [confidences[1], confidences[0], confidences[1]])
    same_places(skeleton, person(3), JOINTS)


def test_a_state_of_the_hands_alone_is_no_confidence(write):
    head, *rows = table(person(3)).splitlines()
    content = "\n".join([head + ",HandLeftState,HandRightState", *(row + ",4,3" for row in rows)])
    recording = load(write(content))
    assert (recording.motion.confidence == 1.0).all()


def test_turns_and_speeds_are_left_out_and_said_so(write):
    head, *rows = table(person(3)).splitlines()
    extra = "Head_qx,Head_qy,Head_RotZ,Head.Orientation.W,Head_vel_x,FloorPlane"
    recording = load(write("\n".join([f"{head},{extra}", *(row + ",1,2,3,4,5,6" for row in rows)])))
    same_places(recording.motion, person(3), JOINTS)
    assert any("columns left out: Head_qx, Head_qy" in note for note in recording.notes)


# MediaPipe's tables


def mediapipe(values, spell):
    names = [spell(i, axis) for i in range(values.shape[1]) for axis in "xyzv"]
    rows = values.reshape(len(values), -1).tolist()
    return "\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows)])


NUMBERED = {
    "x0": lambda i, a: f"{a}{i}",
    "x1": lambda i, a: f"{a}{i + 1}",
    "landmark_0_x": lambda i, a: f"landmark_{i}_{a}",
    "0_x": lambda i, a: f"{i}_{a}",
    "x[0]": lambda i, a: f"{a}[{i}]",
    "pose_0_x": lambda i, a: f"pose_{i}_{a}",
    "P0X": lambda i, a: f"P{i}{a.upper()}",
}


@pytest.mark.parametrize("spelling", NUMBERED)
def test_points_by_number_are_mediapipes(write, spelling):
    expected = seen(6)
    skeleton = load(write(mediapipe(numbers(expected), NUMBERED[spelling]))).motion
    same_places(skeleton, expected, BODY)
    column = skeleton.joints.index("left_knee")
    np.testing.assert_allclose(
        skeleton.confidence[:, column], expected.confidence[:, expected.joints.index("left_knee")]
    )


def test_mediapipes_names_in_a_picture_are_scaled_to_an_adult(write):
    from nao_sim.recordings.landmarks.marks import MEDIAPIPE, order_of

    names = [joint if joint != "-" else f"mouth_left_{i}" for i, joint in enumerate(order_of(MEDIAPIPE))]
    names[1] = "left_eye_inner"
    expected = seen(10)
    content = mediapipe(
        pictured(numbers(expected), (1.0, 1.0)), lambda i, a: f"{names[i]}_{'visibility' if a == 'v' else a}"
    )
    recording = load(write(content))
    told = recording.motion.track("left_wrist") - recording.motion.track("left_shoulder")
    true = expected.track("left_wrist") - expected.track("left_shoulder")
    cosine = (told * true).sum(axis=1) / np.linalg.norm(told, axis=1) / np.linalg.norm(true, axis=1)
    np.testing.assert_allclose(cosine, 1.0, atol=1e-6)
    assert any("scaled to an adult" in note for note in recording.notes)


def test_tables_without_depth_are_planar(write):
    expected = seen(6)
    pixels = pictured(numbers(expected)) * [*PICTURE, 1.0, 1.0]
    chosen = [BODY.index(joint) for joint in JOINTS if joint in BODY]
    head = ",".join(f"{BODY[i]}_{axis}" for i in chosen for axis in "xy")
    rows = [",".join(map(repr, frame[chosen, :2].ravel().tolist())) for frame in pixels]
    skeleton = load(write("\n".join([head, *rows]))).motion
    assert skeleton.planar
    assert (skeleton.track("left_shoulder")[:, 1] > skeleton.track("right_shoulder")[:, 1]).all()
    assert (skeleton.track("left_shoulder")[:, 2] > skeleton.track("left_hip")[:, 2]).all()


def test_markers_are_joints(write):
    expected = person(6)
    spell = {"left_shoulder": "LSHO", "right_shoulder": "RSHO", "left_elbow": "LELB", "right_elbow": "RELB",
             "left_wrist": "LWRA", "right_wrist": "RWRA", "left_hip": "LASI", "right_hip": "RASI", "neck": "C7",
             "left_knee": "LKNE", "right_knee": "RKNE"}  # fmt: skip
    joints = tuple(spell)
    recording = load(write(table(expected, lambda _, j, a: f"{spell[j]}:{a.upper()}", 0.001, joints=joints)))
    same_places(recording.motion, expected, [joint for joint in joints if joint in recording.motion.joints])
    assert {"left_wrist", "left_shoulder", "left_elbow", "neck"} <= set(recording.motion.joints)


# People, labels, layouts


def test_rows_of_the_person_tracked_longest_or_asked_for_are_read(write):
    first, second = (table(person(8, seed)).splitlines() for seed in (1, 2))
    rows = [f"second,{second[i]}\nfirst,{first[i]}" if i > 3 else f"first,{first[i]}" for i in range(1, 9)]
    path = write("\n".join([f"person,{first[0]}", *rows]))
    recording = load(path)
    same_places(recording.motion, person(8, 1), JOINTS)
    assert any("several people: first (8 frames), second (5 frames)" in note for note in recording.notes)
    assert len(load(path, person="second").motion) == 5
    with pytest.raises(RecordingError, match="no person 'ninth'"):
        load(path, person="ninth")


def test_a_column_of_labels_makes_stretches(write):
    head, *rows = table(person(6)).splitlines()
    words = ["wave", "wave", "", "bow", "bow", "wave"]
    content = "\n".join([f"{head},label", *(f"{row},{word}" for row, word in zip(rows, words, strict=True))])
    labels = load(write(content)).labels
    assert [(label.name, round(label.start * 30), round(label.end * 30)) for label in labels] == [
        ("wave", 0, 1), ("bow", 3, 4), ("wave", 5, 5)]  # fmt: skip


def test_the_users_own_layout_names_the_columns(write, tmp_path):
    own = {"left_shoulder": "P_sL", "right_shoulder": "P_sR", "head": "P_top", "left_elbow": "P_eL",
           "right_elbow": "P_eR", "left_wrist": "P_wL", "right_wrist": "P_wR", "pelvis": "P_mid"}  # fmt: skip
    layout = tmp_path / "mine.toml"
    layout.write_text('name = "mine"\nunit = "mm"\n[names]\n' + "".join(f'{j} = "{n}"\n' for j, n in own.items()))
    path = write(table(person(4), lambda _, j, a: f"{own[j]}_{a}", 0.001, joints=tuple(own)))
    same_places(load(path, layout=layout).motion, person(4), own)
    with pytest.raises(RecordingError, match="names"):
        load(path)


def test_two_hands_alone_are_read_and_said_to_be_all(write):
    rows = [[1, -300.0, 200.0, 1800.0, 310.0, 220.0, 1700.0], [2, -200.0, 100.0, 1500.0, 0.0, 0.0, 0.0]]
    recording = load(
        write("class,leftX,leftY,leftZ,rightX,rightY,rightZ\n" + "\n".join(",".join(map(str, r)) for r in rows))
    )
    skeleton = recording.motion
    assert skeleton.joints == ("left_hand", "right_hand") and recording.format == "table of two hands"
    np.testing.assert_allclose(skeleton.positions[0], [[-1.8, 0.3, 0.2], [-1.7, -0.31, 0.22]])
    assert np.isnan(skeleton.positions[1, 1]).all()
    assert [label.name for label in recording.labels] == ["1", "2"]
    assert "no robot can be moved" in recording.notes[0]


# What is missing, and mistakes


@pytest.mark.parametrize("cell", ["", " ", "nan", "NaN", "NA", "null", "None", "inf", "0"])
def test_a_cell_without_a_number_is_a_missing_point(write, cell):
    head, *rows = table(person(4)).splitlines()
    cells = rows[2].split(",")
    cells[1:4] = [cell] * 3
    rows[2] = ",".join(cells)
    skeleton = load(write("\n".join([head, *rows]))).motion
    assert np.isfinite(skeleton.track("head")).all(axis=1).tolist() == [True, True, False, True]
    assert np.isfinite(skeleton.track("neck")).all()


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: "\ufeff" + text,
        lambda text: text.replace(",", ";").replace(".", ","),
        lambda text: text.replace(",", "\t").replace(".", ",").replace("\n", "\t\r\n"),
        lambda text: text.replace(",", ";").replace(".", ",").replace("0,0", "00:00:00,000", 1),
        lambda text: text.replace("\n", ",\n"),
        lambda text: text.replace(",", " , "),
        lambda text: "# made by me\n\n" + text + "\n\n",
        lambda text: '"' + text.replace("\n", '"\n"').replace(",", '","').removesuffix('"'),
        lambda text: text.replace(",", " "),
        lambda text: "\n".join("," * bool(i) + line if i else "," + line for i, line in enumerate(text.splitlines())),
    ],
)
def test_every_way_to_write_a_table_reads_the_same(write, change):
    same_places(load(write(change(table(person(4))))).motion, person(4), JOINTS)


def changed(row, column, cell):
    lines = table(person(4)).splitlines()
    cells = lines[row].split(",")
    cells[column] = cell
    lines[row] = ",".join(cells)
    return "\n".join(lines)


MISTAKES = {
    "text in a cell": (changed(2, 5, "left"), 3, "Neck_y", ["'left'", "a number"]),
    "commas for thousands": (changed(2, 5, "1,000,0").replace(",", ";").replace("1;000;0", "1,000,0"), 3, "Neck_y",
                             ["'1,000,0'"]),
    "a number with underscores": (changed(2, 5, "1_0"), 3, "Neck_y", ["'1_0'"]),
    "a short row": (table(person(3)).rstrip().rpartition(",")[0], 4, None, ["42 values", "43 values, as"]),
    "a long row": (table(person(3)).rstrip() + ",7,8", 4, None, ["45 values", "43 values"]),
    "a header and no rows": (table(person(3)).splitlines()[0] + "\n", 1, None, ["no rows"]),
    "a column twice": (changed(0, 4, "Head_x"), 1, "Head_x", ["twice"]),
    "units that differ": (changed(0, 4, "Neck_x_mm").replace("Neck_y", "Neck_y_cm"), 1, None, ["units mm and cm"]),
    "times that go back": (changed(3, 0, "0.001"), 4, "time", ["0.001", "after"]),
    "a state that none knows": (with_beside(person(3), "_state", lambda i, j: "7" if j == 3 else "2"), 2,
                                "SpineBase_state", ["7", "a state 0, 1 or 2"]),
    "a confidence below zero": (with_beside(person(3), "_score", lambda i, j: "-1" if i == 1 else "1"), 3,
                                "Head_score", ["-1", "0 to 1"]),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place(refused, mistake):
    content, line, column, words = MISTAKES[mistake]
    error = refused(content)
    assert (error.line, error.column) == (line, column), str(error)
    assert all(word in str(error) for word in words), str(error)


def test_names_of_no_joint_are_told(refused):
    text = "A_x,A_y,A_z,B_x,B_y,B_z,C_x,C_y,C_z\n" + "1,2,3,4,5,6,7,8,9\n" * 3
    assert "A, B, C" in str(refused(text)) and "--layout" in str(refused(text))


def test_points_that_are_never_there_are_told(refused):
    head, *rows = table(person(3)).splitlines()
    empty = [",".join([row.split(",")[0], *["0"] * (3 * len(JOINTS))]) for row in rows]
    assert "expected" in str(refused("\n".join([head, *empty])))


@pytest.mark.parametrize("header", ["time,LElbowRoll_deg", "RSR,RSP,RER,REY,RH,LSR,LSP,LER,LEY,LH", "a,b,c", "x,y,z"])
def test_other_tables_are_not_taken(write, header):
    path = write(header + "\n" + ",".join(["0.5"] * (header.count(",") + 1)) + "\n")
    try:
        assert load(path, rate=10.0 if "time" in header else None).format not in (
            "table of points",
            "table of two hands",
        )
    except RecordingError as error:
        assert "\n" not in str(error)


@settings(max_examples=80, deadline=None)
@given(names=st.lists(st.text(st.sampled_from("xyzXYZ_.: ()[]mLefthand0Spos"), max_size=10), max_size=8))
def test_any_header_is_understood_or_not_without_a_fault(names):
    found = columns_of(names)
    parts_and_keys(list(found.points))
    places = [column for columns in found.points.values() for column in columns.values()] + list(found.row.values())
    assert len(places) == len(set(places))


def test_a_long_recording_loads_in_memory_of_the_order_of_its_numbers(write):
    row = table(person(1), time="").splitlines()
    path = write(row[0] + "\n" + (row[1] + "\n") * 20_000)
    tracemalloc.start()
    try:
        skeleton = load(path).motion
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(skeleton) == 20_000 and peak < 8 * skeleton.positions.nbytes + 30e6
