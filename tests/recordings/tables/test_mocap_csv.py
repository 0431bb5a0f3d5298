"""Optical motion capture as text: Motive, Vicon Nexus, Qualisys and OpenSim say the same of the same person."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.body import SIDES, twin
from nao_sim.errors import RecordingError
from nao_sim.motion import Skeleton
from nao_sim.recordings import load
from nao_sim.recordings.tables.markers import joints_of
from tests.landmark_files import same_places
from tests.people import in_file, person

RATE = 100.0
AXES = ("+x", "+y", "+z")
# Plug-in Gait's markers, as joints and how far (m: forward, left for the left side, up) a marker is from them.
MARKERS = {"LFHD": ("head", (0.09, 0.07, 0.0)), "RFHD": ("head", (0.09, -0.07, 0.0)),
           "LBHD": ("head", (-0.09, 0.07, 0.0)), "RBHD": ("head", (-0.09, -0.07, 0.0)), "C7": ("neck", (0.0, 0.0, 0.0)),
           "CLAV": ("chest", (0.0, 0.0, 0.0)), "T10": ("spine", (0.0, 0.0, 0.0))}  # fmt: skip
PAIRED = {"SHO": ("shoulder", 0.0), "ELB": ("elbow", 0.0), "WRA": ("wrist", 0.03), "WRB": ("wrist", -0.03),
          "FIN": ("hand", 0.0), "KNE": ("knee", 0.0), "ANK": ("ankle", 0.0), "TOE": ("foot", 0.0), "HEE": ("heel", 0.0),
          "ASI": ("hip", 0.08), "PSI": ("hip", -0.08)}  # fmt: skip
MARKERS |= {f"{side[0].upper()}{name}": (f"{side}_{joint}", (ahead, 0.0, 0.0))
            for side in SIDES for name, (joint, ahead) in PAIRED.items()}  # fmt: skip
PARTS = ("shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "foot", "heel")
JOINTS = ["head", "neck", *(f"{side}_{part}" for side in SIDES for part in PARTS)]


def markers(skeleton):
    """Positions (T, M, 3) mm of `MARKERS`, z up."""
    places = [skeleton.track(joint) + np.array(offset) for joint, offset in MARKERS.values()]
    return np.stack(places, axis=1) * 1000.0


def recorded(frames=8, seed=0, **options):
    skeleton = person(frames, seed, **options)
    return replace(skeleton, times=np.arange(frames) / RATE)


def cells(values, mark=","):
    """Rows of numbers, nan as empty cells."""
    return [
        mark.join("" if np.isnan(value) else repr(value) for value in row)
        for row in values.reshape(len(values), -1).tolist()
    ]


def y_up(values):
    """Motive's axes: x left, y up, z forward, of z-up ones."""
    return values[..., [1, 2, 0]]


def motive(values, names=tuple(MARKERS), kind="Marker", version="1.23", unit="Millimeters", subject="Sub1"):
    full = [f"{subject}:{name}" if subject else name for name in names]
    across = [name for name in full for _ in "xyz"]
    head = [f"Format Version,{version},Take Name,Take, 1,Capture Frame Rate,{RATE},Export Frame Rate,{RATE},"
            f"Total Frames in Take,{len(values)},Rotation Type,Quaternion,Length Units,{unit},Coordinate Space,Global",
            "", ",Type," + ",".join([kind] * len(across)), ",Name," + ",".join(f'"{name}"' for name in across),
            ",ID," + ",".join(["1A:2B"] * len(across)), ",," + ",".join(["Position"] * len(across)),
            "Frame,Time (Seconds)," + ",".join("XYZ" * len(full))]  # fmt: skip
    rows = [f"{i},{i / RATE:.6f},{row}" for i, row in enumerate(cells(y_up(values)))]
    return "\n".join([*head, *rows]) + "\n"


def vicon(values, names=tuple(MARKERS), subject="Sub1", before="", after=""):
    head = ["Trajectories", f"{RATE:g}", ",," + ",".join(f"{subject}:{name},," for name in names),
            "Frame,Sub Frame," + ",".join(["X,Y,Z"] * len(names)),
            ",," + ",".join(["mm,mm,mm"] * len(names))]  # fmt: skip
    rows = [f"{i + 1},0,{row}" for i, row in enumerate(cells(values))]
    return before + "\n".join([*head, *rows]) + "\n" + after


def qualisys(values, names=tuple(MARKERS), columns=True, zero=True):
    head = [f"NO_OF_FRAMES\t{len(values)}", "NO_OF_CAMERAS\t8", f"NO_OF_MARKERS\t{len(names)}", f"FREQUENCY\t{RATE:g}",
            "NO_OF_ANALOG\t0", "ANALOG_FREQUENCY\t0", "DESCRIPTION\t--", "TIME_STAMP\t2022-06-03, 10:47:36\t94247",
            "DATA_INCLUDED\t3D", "MARKER_NAMES\t" + "\t".join(names),
            "TRAJECTORY_TYPES" + "\tMeasured" * len(names)]  # fmt: skip
    rows = cells(np.nan_to_num(values) if zero else values, "\t")
    if columns:
        head.append("\t".join(["Frame", "Time", *(f"{name} {axis}" for name in names for axis in "XYZ")]))
        rows = [f"{i + 1}\t{i / RATE:.5f}\t{row}" for i, row in enumerate(rows)]
    return "\n".join([*head, *rows]) + "\n"


def trc(values, names=tuple(MARKERS), unit="mm", spaced=True):
    numbers = "\t".join(f"{axis}{i}" for i in range(1, len(names) + 1) for axis in "XYZ")
    head = ["PathFileType\t4\t(X/Y/Z)\ttake.trc",
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
            f"{RATE:.2f}\t{RATE:.2f}\t{len(values)}\t{len(names)}\t{unit}\t{RATE:.2f}\t1\t{len(values)}",
            "Frame#\tTime\t" + ("\t\t\t" if spaced else "\t").join(names), "\t\t" + numbers, ""]  # fmt: skip
    rows = [f"{i + 1}\t{i / RATE:.5f}\t{row}" for i, row in enumerate(cells(y_up(values), "\t"))]
    return "\n".join([*head, *rows]) + "\n"


WRITERS = {"Motive CSV": motive, "Vicon Nexus CSV": vicon, "Qualisys TSV": qualisys, "OpenSim TRC": trc}


@pytest.mark.parametrize("kind", WRITERS)
def test_every_program_says_the_same(write, kind):
    expected = recorded()
    recording = load(write(WRITERS[kind](markers(expected))))
    assert recording.format == "optical motion capture" and recording.reason.startswith(f"the header of a {kind}")
    same_places(recording.motion, expected, JOINTS)
    np.testing.assert_allclose(recording.motion.times, expected.times, atol=1e-9)
    assert any("left wrist of LWRA, LWRB" in note for note in recording.notes)


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 999), kind=st.sampled_from(list(WRITERS)), order=st.permutations(list(MARKERS)))
def test_markers_may_come_in_any_order(tmp_path_factory, seed, kind, order):
    expected = recorded(5, seed)
    chosen = [list(MARKERS).index(name) for name in order]
    path = tmp_path_factory.mktemp("law") / "x.csv"
    path.write_text(WRITERS[kind](markers(expected)[:, chosen], tuple(order)))
    same_places(load(path).motion, expected, JOINTS)


@pytest.mark.parametrize("kind", WRITERS)
def test_a_mirrored_file_gives_the_mirrored_person(write, kind):
    expected = recorded()
    mirrored = Skeleton(expected.times, expected.positions * [1.0, -1.0, 1.0], tuple(map(twin, expected.joints)))
    same_places(load(write(WRITERS[kind](markers(mirrored)))).motion, expected.mirrored(), JOINTS)


@pytest.mark.parametrize(
    ("writer", "options"),
    [
        (motive, {"version": "1.25", "unit": "Millimeters"}),
        (motive, {"kind": "Rigid Body Marker"}),
        (motive, {"subject": ""}),
        (qualisys, {"columns": False}),
        (qualisys, {"zero": False}),
        (trc, {"spaced": False}),
        (vicon, {"before": "Devices\n1000\n,,Force\nFrame,Sub Frame,Fx\n,,N\n1,0,3.5\n\n"}),
        (
            vicon,
            {"after": "\nModel Outputs\n100\n,,Sub1:LKneeAngles,,\nFrame,Sub Frame,X,Y,Z\n,,deg,deg,deg\n1,0,1,2,3\n"},
        ),
        (vicon, {"before": "\n\n"}),
    ],
)
def test_variants_of_each_program_read_the_same(write, writer, options):
    same_places(load(write(writer(markers(recorded()), **options))).motion, recorded(), JOINTS)


@pytest.mark.parametrize(("unit", "size"), [("Meters", 1000.0), ("Centimeters", 10.0), ("Millimeters", 1.0)])
def test_the_unit_is_the_headers(write, unit, size):
    same_places(load(write(motive(markers(recorded()) / size, unit=unit))).motion, recorded(), JOINTS)


@pytest.mark.parametrize("kind", WRITERS)
def test_a_marker_that_was_not_seen_is_missing(write, kind):
    values = markers(recorded())
    values[3, list(MARKERS).index("LELB")] = np.nan
    values[4, list(MARKERS).index("LWRB")] = np.nan
    skeleton = load(write(WRITERS[kind](values))).motion
    assert np.isnan(skeleton.track("left_elbow")[3]).all() and np.isfinite(skeleton.track("left_elbow")[4]).all()
    assert np.isnan(skeleton.track("left_wrist")[4]).all(), "not half a hand beside where it was"


BONES = {"Hip": "pelvis", "Ab": "spine", "Neck": "neck", "Head": "head", "LUArm": "left_shoulder",
         "LFArm": "left_elbow", "LHand": "left_wrist", "RUArm": "right_shoulder", "RFArm": "right_elbow",
         "RHand": "right_wrist", "LThigh": "left_hip", "LShin": "left_knee", "LFoot": "left_ankle", "LToe": "left_foot",
         "RThigh": "right_hip", "RShin": "right_knee", "RFoot": "right_ankle", "RToe": "right_foot"}  # fmt: skip


def test_a_skeleton_of_motive_is_read_where_its_bones_begin_and_not_at_its_collarbones(write):
    expected = recorded()
    places = in_file(expected, tuple(BONES.values()), axes=AXES)
    collar = {side: (expected.track("chest") + expected.track(f"{side}_shoulder"))[:, None] / 2 for side in SIDES}
    values = np.concatenate([places, collar["left"], collar["right"]], axis=1) * 1000.0
    text = motive(values, (*BONES, "LShoulder", "RShoulder"), "Bone", subject="Skeleton 001")
    recording = load(write(text))
    same_places(recording.motion, expected, [joint for joint in BONES.values() if joint in recording.motion.joints])
    assert {"left_shoulder", "left_elbow", "left_wrist", "right_knee", "head"} <= set(recording.motion.joints)


def test_turns_and_errors_between_the_positions_are_skipped(write):
    expected = recorded(3)
    places = y_up(in_file(expected, tuple(BONES.values()), axes=AXES))
    columns = (
        [("Rotation", axis) for axis in "XYZW"] + [("Position", axis) for axis in "XYZ"] + [("Mean Marker Error", "")]
    )
    head = ["Format Version,1.21,Take Name,x,Capture Frame Rate,100,Length Units,Meters", "",
            ",Type," + ",".join("Bone" for _ in BONES for _ in columns),
            ",Name," + ",".join(f"S:{name}" for name in BONES for _ in columns),
            ",,"+ ",".join(kind for _ in BONES for kind, _ in columns),
            "Frame,Time (Seconds)," + ",".join(axis for _ in BONES for _, axis in columns)]  # fmt: skip
    rows = [",".join([str(i), str(i / 100), *(repr(v) for p in frame for v in [0.1, 0.2, 0.3, 0.9, *p, 0.001])])
            for i, frame in enumerate(places.tolist())]  # fmt: skip
    skeleton = load(write("\n".join([*head, *rows]))).motion
    same_places(skeleton, expected, ["left_elbow", "right_wrist", "left_knee"])


def test_joints_by_name_in_a_trc_file(write):
    names = {"Neck": "neck", "RShoulder": "right_shoulder", "RElbow": "right_elbow", "RWrist": "right_wrist",
             "LShoulder": "left_shoulder", "LElbow": "left_elbow", "LWrist": "left_wrist", "midHip": "pelvis",
             "RHip": "right_hip", "LHip": "left_hip", "RKnee": "right_knee", "LKnee": "left_knee"}  # fmt: skip
    expected = recorded()
    text = trc(in_file(expected, tuple(names.values()), axes=AXES), tuple(names), unit="m")
    same_places(load(write(text)).motion, expected, names.values())


def test_of_several_subjects_the_one_tracked_longest_is_read_or_the_one_asked_for(write):
    first, second = markers(recorded(8, 1)), markers(recorded(8, 2)) + np.array([1500.0, 0.0, 0.0])
    first[5:] = np.nan
    names = tuple(f"{who}:{name}" for who in ("Sub1", "Sub2") for name in MARKERS)
    path = write(motive(np.concatenate([first, second], axis=1), names, subject=""))
    recording = load(path)
    assert any("Sub1 (5 frames), Sub2 (8 frames)" in note for note in recording.notes) and len(recording.motion) == 8
    first = replace(recorded(8, 1), times=np.arange(5) / RATE, positions=recorded(8, 1).positions[:5], confidence=1.0)
    same_places(load(path, person="Sub1").motion, first, JOINTS)
    with pytest.raises(RecordingError, match="no person 'Sub9'"):
        load(path, person="Sub9")


def test_markers_without_a_name_do_not_matter(write):
    values = np.concatenate([markers(recorded()), np.full((8, 2, 3), np.nan)], axis=1)
    values[2:4, -1] = 0.5
    same_places(
        load(write(motive(values, (*MARKERS, "Unlabeled 1200", "Unlabeled 7"), subject=""))).motion, recorded(), JOINTS
    )


@pytest.mark.parametrize(
    "names",
    [
        ["LSHO", "RSHO", "LELB", "RELB", "LWRA", "LWRB"],
        ["Q_LShoulderTop", "Q_RShoulderTop", "Q_LElbowOut", "Q_RElbowOut", "Q_HeadL", "Q_HeadR", "Q_Chest"],
        ["L.Acromium", "R.Acromium", "L.Elbow", "R.Elbow", "Top.Head", "V.Sacral"],
        [
            "r_shoulder_study",
            "L_shoulder_study",
            "r_lelbow_study",
            "r_melbow_study",
            "L_lelbow_study",
            "L_melbow_study",
        ],
        ["Sub1:LSHO", "Sub1:RSHO", "Sub1:LELB", "Sub1:RELB"],
    ],
)
def test_marker_sets_are_known(names):
    joints = joints_of(names)
    assert {"left_shoulder", "right_shoulder", "left_elbow", "right_elbow"} <= set(joints)
    assert re.sub(r".*:|Q_", "", names[joints["left_shoulder"][0]]).startswith("L")


def test_names_of_joints_are_no_marker_set():
    assert joints_of(["Head", "Neck", "Hip", "LHand", "RHand"]) == {}


def without(text, line):
    return "\n".join(row for i, row in enumerate(text.splitlines(), start=1) if i != line)


def changed(text, line, old, new):
    rows = text.splitlines()
    assert old in rows[line - 1]
    rows[line - 1] = rows[line - 1].replace(old, new, 1)
    return "\n".join(rows)


GOOD = markers(recorded(4))
MISTAKES = {
    "a Motive file without its columns": (without(motive(GOOD), 7), 1, ["Frame,Time (Seconds)"]),
    "a Motive file without types": (without(motive(GOOD), 3), None, ["expected"]),
    "a Motive file of an unknown unit": (changed(motive(GOOD), 1, "Millimeters", "Furlongs"), 1, ["unit 'Furlongs'"]),
    "a Vicon file without trajectories": ("Model Outputs\n100\n,,A:X\nFrame,Sub Frame,X\n,,deg\n1,0,3\n", None,
                                          ["no section Trajectories"]),
    "a Vicon file that breaks off": ("Trajectories\n100\n,,A:LSHO,,\n", 1, ["breaks off"]),
    "a Vicon file in degrees": (vicon(GOOD).replace("mm,mm,mm", "deg,deg,deg"), 5, ["unit 'deg'"]),
    "a Vicon file without units": (without(vicon(GOOD), 5), 5, ["units ", "one unit"]),
    "a Qualisys file of something else": (qualisys(GOOD).replace("\t3D", "\t6D"), None, ["DATA_INCLUDED 6D"]),
    "a Qualisys file with a name too few": (qualisys(GOOD).replace("\tLSHO\t", "\t", 1), 13, ["for each marker"]),
    "a TRC file without names": ("PathFileType\t4\t(X/Y/Z)\tx.trc\nDataRate\n100\n", 1, ["no line Frame#"]),
    "text among the numbers": (changed(vicon(GOOD), 7, "2,0,", "2,0,x"), 7, ["LFHD X"]),
    "a row too long": (changed(trc(GOOD), 8, "\t", "\t1\t2\t3\t4\t"), 8, ["values, as in the header"]),
    "no rows": ("\n".join(trc(GOOD[:1]).splitlines()[:6]) + "\n", 5, ["no rows"]),
    "times that go back": (changed(motive(GOOD), 10, "2,0.020000", "2,0.001"), 10, ["after"]),
    "nothing seen": (motive(np.full_like(GOOD, np.nan)), None, ["expected"]),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_line(write, mistake):
    content, line, words = MISTAKES[mistake]
    with pytest.raises(RecordingError) as caught:
        load(write(content))
    message = str(caught.value)
    assert "\n" not in message and all(word in message for word in words), message
    assert line is None or caught.value.line == line, message


@pytest.mark.parametrize("kind", WRITERS)
def test_a_file_cut_off_anywhere_is_read_or_refused_in_one_line(write, kind):
    text = WRITERS[kind](GOOD)
    for length in np.linspace(5, len(text) - 1, 40).astype(int):
        try:
            load(write(text[:length]))
        except RecordingError as error:
            assert "\n" not in str(error)
