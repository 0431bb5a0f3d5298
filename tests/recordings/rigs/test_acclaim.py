"""Acclaim ASF and AMC: what is read, where the skeleton is found, and what a mistake is told as."""

import lzma
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.errors import NaoSimError, RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.rigs import acclaim
from nao_sim.recordings.rigs.acclaim_skeleton import TYPICAL, skeleton_of
from nao_sim.recordings.rigs.rig_joints import FACE_NOTE
from nao_sim.recordings.source import Source

# name, parent, direction, length, axis, dof: a person with arms out who looks along z
BONES = (
    ("lhipjoint", "root", (0.6, -0.8, 0), 2.0, (0, 0, 0), ""),
    ("rhipjoint", "root", (-0.6, -0.8, 0), 2.0, (0, 0, 0), ""),
    ("lfemur", "lhipjoint", (0, -1, 0), 7.3, (0, 0, 20), "rx ry rz"),
    ("ltibia", "lfemur", (0, -1, 0), 7.7, (0, 0, 20), "rx"),
    ("lfoot", "ltibia", (0, -0.2, 1), 2.2, (-90, 0, 20), "rx rz"),
    ("rfemur", "rhipjoint", (0, -1, 0), 7.3, (0, 0, -20), "rx ry rz"),
    ("rtibia", "rfemur", (0, -1, 0), 7.7, (0, 0, -20), "rx"),
    ("rfoot", "rtibia", (0, -0.2, 1), 2.2, (-90, 0, -20), "rx rz"),
    ("thorax", "root", (0, 1, 0), 7.0, (10, 20, 30), "rx ry rz"),
    ("lowerneck", "thorax", (0, 1, 0), 2.0, (0, 0, 0), "rz rx"),
    ("head", "lowerneck", (0, 1, 0), 2.0, (0, 0, 0), "rx ry rz"),
    ("lclavicle", "thorax", (1, 0, 0), 3.4, (0, 0, 0), "ry rz"),
    ("lhumerus", "lclavicle", (1, 0, 0), 5.1, (180, -30, -90), "rx ry rz"),
    ("lradius", "lhumerus", (1, 0, 0), 3.5, (180, -30, -90), "rx"),
    ("lwrist", "lradius", (1, 0, 0), 1.7, (0, 90, 90), "ry"),
    ("rclavicle", "thorax", (-1, 0, 0), 3.4, (0, 0, 0), "ry rz"),
    ("rhumerus", "rclavicle", (-1, 0, 0), 5.1, (180, 30, 90), "rx ry rz"),
    ("rradius", "rhumerus", (-1, 0, 0), 3.5, (180, 30, 90), "rx"),
    ("rwrist", "rradius", (-1, 0, 0), 1.7, (0, -90, -90), "ry"),
)
DOF = {"root": ["tx", "ty", "tz", "rx", "ry", "rz"], **{name: dof.split() for name, *_, dof in BONES}}


def words(values):
    return " ".join(f"{value:.12g}" for value in values)


def asf_text(length="0.45"):
    """The skeleton."""
    lines = ["# a person", ":version 1.10", ":name test", ":units", "  mass 1.0", f"  length {length}", "  angle deg"]
    lines += [":documentation", "   begin, dof and bones", ":root", "   order TX TY TZ RX RY RZ", "   axis XYZ"]
    lines += ["   position 0 0 0", "   orientation 0 0 0", ":bonedata"]
    for number, (name, _, direction, size, axis, dof) in enumerate(BONES):
        lines += ["  begin", f"     id {number}", f"     name {name}", f"     direction {words(direction)}"]
        lines += [f"     length {size}", f"     axis {words(axis)}   XYZ"]
        if dof:
            limits = ["(-160.0 20.0)"] * len(dof.split())
            lines += [f"    dof {dof}", f"    limits {limits[0]}", *(f"           {limit}" for limit in limits[1:])]
        lines += ["  end"]
    lines += [":hierarchy", "  begin"]
    for parent in dict.fromkeys(parent for _, parent, *_ in BONES):
        lines.append("    " + " ".join([parent, *(name for name, of, *_ in BONES if of == parent)]))
    return "\n".join([*lines, "  end"]) + "\n"


def amc_text(frames, header=":FULLY-SPECIFIED\n:DEGREES", first=1):
    """A motion from values (by bone) of each frame."""
    lines = ["#!OML:ASF C:\\test.ASF", header]
    for number, frame in enumerate(frames, start=first):
        lines += [str(number), *(f"{bone} {words(values)}" for bone, values in frame.items())]
    return "\n".join(lines) + "\n"


def some_frames(count, seed=0, size=15.0):
    random = np.random.default_rng(seed)
    return [{bone: random.uniform(-size, size, len(dof)) for bone, dof in DOF.items() if dof} for _ in range(count)]


ASF = asf_text()
FRAMES = some_frames(3)
GOOD = amc_text(FRAMES)


@pytest.fixture
def write(tmp_path):
    def write(content, name="07_01.amc", asf=ASF, asf_name="07.asf"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        if asf is not None:
            skeleton = tmp_path / asf_name
            skeleton.parent.mkdir(parents=True, exist_ok=True)
            skeleton.write_bytes(asf if isinstance(asf, bytes) else asf.encode())
        return path

    return write


def points(path, **options):
    return acclaim.points_of(Source(path, **options))[0]


def place(found, joint):
    return found.values[:, found.names.index(joint)]


def slow_walk(frame):
    """Where each bone begins and ends, by rotation vectors about fixed axes, one frame."""

    def fixed(axes, angles):
        turn = Rotation.identity()
        for axis, angle in zip(axes, angles, strict=True):
            turn = Rotation.from_rotvec(np.radians(angle) * np.eye(3)["xyz".index(axis)]) * turn
        return turn

    turns, ends, starts = {"root": fixed("xyz", frame["root"][3:])}, {"root": np.array(frame["root"][:3])}, {}
    for name, parent, direction, size, axis, dof in BONES:
        about = fixed("xyz", axis)
        own = fixed([word[1] for word in dof.split()], frame.get(name, ()))
        turns[name] = turns[parent] * about * own * about.inv()
        starts[name] = ends[parent]
        ends[name] = ends[parent] + turns[name].apply(np.array(direction) / np.linalg.norm(direction) * size)
    return starts, ends


def test_a_motion_loads_as_a_person_in_metres_and_seconds(write):
    recording = load(write(GOOD))
    person = recording.motion
    assert recording.format == "Acclaim AMC" and recording.frames == len(person) == 3
    np.testing.assert_allclose(person.times, np.arange(3) / 120.0)
    assert any("07.asf" in note for note in recording.notes) and any(
        "120 frames a second" in n for n in recording.notes
    )
    arm = person.track("left_elbow") - person.track("left_shoulder")
    np.testing.assert_allclose(np.linalg.norm(arm, axis=1), 5.1 * 0.0254 / 0.45, atol=1e-9)
    assert (person.track("head") - person.track("pelvis"))[:, 2].min() > 0.4


@settings(max_examples=25)
@given(seed=st.integers(0, 2**31), size=st.sampled_from([10.0, 180.0]))
def test_bones_are_where_the_slow_way_puts_them(tmp_path_factory, seed, size):
    folder, frames = tmp_path_factory.mktemp("law"), some_frames(2, seed, size)
    (folder / "7.asf").write_text(ASF)
    (folder / "7_1.amc").write_text(amc_text(frames))
    found = points(folder / "7_1.amc")
    for k, frame in enumerate(frames):
        starts, ends = slow_walk(frame)
        for joint, where in (
            ("pelvis", ends["root"]),
            ("left_shoulder", starts["lhumerus"]),
            ("right_elbow", starts["rradius"]),
            ("left_wrist", starts["lwrist"]),
            ("head", starts["head"]),
            ("right_ankle", starts["rfoot"]),
        ):
            np.testing.assert_allclose(place(found, joint)[k], where, atol=1e-6)


def test_bones_keep_their_lengths(write):
    found = points(write(GOOD))
    for start, end, length in (("shoulder", "elbow", 5.1), ("elbow", "wrist", 3.5), ("hip", "knee", 7.3)):
        for side in ("left_", "right_"):
            lengths = np.linalg.norm(place(found, side + end) - place(found, side + start), axis=1)
            np.testing.assert_allclose(lengths, length, atol=1e-9)


def test_the_same_motion_in_other_words(write):
    expected = points(write(GOOD)).values
    radians = [
        {bone: [np.radians(v) if dof[0] == "r" else v for v, dof in zip(values, DOF[bone], strict=True)]
         for bone, values in frame.items()}
        for frame in FRAMES
    ]  # fmt: skip
    backwards = [dict(reversed(frame.items())) if k else frame for k, frame in enumerate(FRAMES)]
    for content in (
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\n\n"),
        GOOD.replace(" ", "\t").replace("#!OML:ASF\t", "# "),
        GOOD.rstrip("\n"),
        "\ufeff" + GOOD,
        amc_text(FRAMES, ":fully-specified\n:degrees"),
        amc_text(radians, ":FULLY-SPECIFIED\n:RADIANS"),
        amc_text(backwards),
        amc_text(FRAMES, first=500),
    ):
        np.testing.assert_allclose(points(write(content)).values, expected, atol=1e-6)
    np.testing.assert_allclose(points(write(amc_text(FRAMES, ":FULLY-SPECIFIED")), unit="deg").values, expected)


def test_the_rate_is_the_files_or_the_callers_or_cmus(write):
    path = write(GOOD)
    np.testing.assert_allclose(load(path, rate=30.0).motion.times, np.arange(3) / 30.0)
    path = write(amc_text(FRAMES, ":FULLY-SPECIFIED\n:SAMPLES-PER-SECOND 60\n:DEGREES"))
    for rate in (None, 60.0):
        np.testing.assert_allclose(load(path, rate=rate).motion.times, np.arange(3) / 60.0)
    with pytest.raises(RecordingError, match="60 Hz by the file but 30 Hz"):
        load(path, rate=30.0)


def test_missing_frame_numbers_are_a_gap_in_time(write):
    times = load(write(GOOD.replace("\n3\n", "\n7\n"))).motion.times
    np.testing.assert_allclose(times, np.array([0, 1, 6]) / 120.0)


@pytest.mark.parametrize(
    ("amc", "asf"),
    [
        ("07_01.amc", "07.asf"),
        ("07_01.amc", "07_01.asf"),
        ("07_01.AMC", "07.ASF"),
        ("amc/07_01.amc", "07.asf"),
        ("amc/07_01.amc", "asf/07.asf"),
        ("07_01.amc", "asf/07.asf"),
        ("HDM_bd_01-01_01_120.amc", "HDM_bd.asf"),
        ("07.amc", "07.asf"),
    ],
)
def test_the_skeleton_of_the_subject_is_found_nearby(write, amc, asf):
    for name, pack in ((amc, bytes), (amc + ".xz", lzma.compress)):
        for asf_name, pack_asf in ((asf, bytes), (asf + ".xz", lzma.compress)):
            path = write(pack(GOOD.encode()), name, pack_asf(ASF.encode()), asf_name)
            found, notes = acclaim.points_of(Source(path))
            assert len(found.values) == 3 and notes[0].startswith(f"skeleton {asf_name.split('/')[-1].split('.')[0]}")
            (path.parent / asf_name).unlink(missing_ok=True)


def test_the_callers_skeleton_comes_first(write, tmp_path):
    path = write(GOOD, asf=ASF.replace("length 5.1", "length 6.1"))
    (tmp_path / "other.asf").write_text(ASF)
    found, notes = acclaim.points_of(Source(path, rig=tmp_path / "other.asf"))
    length = np.linalg.norm(place(found, "left_elbow") - place(found, "left_shoulder"), axis=1)
    np.testing.assert_allclose(length, 5.1)
    assert notes == (FACE_NOTE,)


def test_another_subjects_skeleton_is_not_taken(write):
    typical = skeleton_of(Source(TYPICAL))
    frame = {typical.rig.names[joint]: [0.0] * len(dofs) for joint, dofs in typical.dofs.items() if dofs}
    for name in ("17_01.amc", "070_01.amc", "0.amc", "_.amc", ".amc"):
        found, notes = acclaim.points_of(Source(write(amc_text([frame]), name)))
        assert "typical" in notes[0] and "--rig" in notes[0], name
        length = np.linalg.norm(place(found, "left_elbow") - place(found, "left_shoulder"), axis=1)
        assert 4.5 < length[0] < 6.0 and found.unit == pytest.approx(0.0254 / 0.45)


def test_the_typical_skeleton_is_the_same_on_both_sides():
    typical = skeleton_of(Source(TYPICAL))
    rest = {name: typical.rig.rest[joint] for joint, name in enumerate(typical.rig.names)}
    for name, place_ in rest.items():
        sided = name[0] in "lr" and not name.startswith(("lower", "root"))
        twin = {"l": "r", "r": "l"}[name[0]] + name[1:] if sided else name
        np.testing.assert_allclose(place_ * [-1.0, 1.0, 1.0], rest[twin], atol=1e-9)


def test_a_unit_that_no_one_knows_is_left_open(write):
    assert points(write(GOOD)).unit == pytest.approx(0.0254 / 0.45)
    assert points(write(GOOD, asf=asf_text("1.0"))).unit is None


def test_bones_that_the_file_leaves_out_do_not_turn(write):
    frames = [{bone: values for bone, values in frame.items() if bone != "lwrist"} for frame in FRAMES]
    found, notes = acclaim.points_of(Source(write(amc_text(frames))))
    np.testing.assert_allclose(
        found.values, points(write(GOOD)).values, atol=1e-9
    )  # the wrist begins, and ends the arm
    assert "not in the file, and not turned: lwrist" in notes


def test_a_skeleton_alone_is_refused_with_advice(write):
    with pytest.raises(RecordingError, match=r"no motion; expected its motion: give the \.amc file"):
        load(write(ASF, "07_01.asf"))


FIRST = GOOD.split("\n").index("1") + 1  # the line of the first frame's number
BONE = next(line for line in GOOD.split("\n") if line.startswith("lradius"))
HERE = GOOD.split("\n").index(BONE) + 1

# What a mistake is told as: (content, line, column, words of what was found and expected)
MISTAKES = {
    "no frames": (GOOD[: GOOD.index("\n1\n") + 1], FIRST - 1, None, ["no frames", "at least one"]),
    "no unit": (GOOD.replace(":DEGREES\n", ""), None, None, ["no unit", ":DEGREES", "--unit"]),
    "two units": (GOOD.replace(":DEGREES", ":DEGREES\n:RADIANS"), None, None, ["one unit"]),
    "a bone before the first frame": (GOOD.replace("\n1\n", "\n"), FIRST, None, ["'root", "number of the first frame"]),
    "a frame twice": (GOOD.replace("\n2\n", "\n1\n"), FIRST + len(FRAMES[0]) + 1, None, ["frame 1", "above 1"]),
    "frames backwards": (GOOD.replace("\n3\n", "\n0\n"), FIRST + 2 * len(FRAMES[0]) + 2, None, ["frame 0", "above 2"]),
    "an endless frame number": (GOOD.replace("\n3\n", "\n" + "9" * 5000 + "\n"), None, None, ["frame 999", "above 2"]),
    "an unknown bone": (GOOD.replace("lradius", "ltail"), HERE, None, ["'ltail'", "07.asf", "--rig"]),
    "a bone that cannot turn": (GOOD.replace("lradius", "lhipjoint"), HERE, None, ["'lhipjoint'", "can turn"]),
    "a value too many": (GOOD.replace(BONE, BONE + " 1"), HERE, "lradius", ["2 values", "1 (lradius rx)", "07.asf"]),
    "no value": (GOOD.replace(BONE, "lradius"), HERE, "lradius", ["0 values", "lradius rx"]),
    "text for a value": (GOOD.replace(BONE, "lradius x"), HERE, "lradius rx", ["'x'", "a number"]),
    "nan for a value": (GOOD.replace(BONE, "lradius nan"), HERE, "lradius rx", ["'nan'", "finite"]),
    "inf for a value": (GOOD.replace(BONE, "lradius inf"), HERE, "lradius rx", ["'inf'", "finite"]),
    "a decimal comma": (GOOD.replace(BONE, "lradius 1,5"), HERE, "lradius rx", ["'1,5'", "decimal point"]),
    "no root": (amc_text([{"lradius": [1.0]}]), FIRST, None, ["without root"]),
    "a root beyond the world": (amc_text([FRAMES[0] | {"root": [1e20] * 6}]), FIRST + 1, "root tx", ["1e+20", "below"]),
    "a bone that is missing later": (amc_text([FRAMES[0], dict(list(FRAMES[1].items())[:-1])]), None, None, ["rwrist"]),
    "a bone that comes twice": (GOOD.replace("\nlwrist", "\nlradius", 1), None, None, ["each once"]),
    "a bone that comes later": (amc_text([{"root": [0.0] * 6}, FRAMES[1]]), None, None, ["lfemur", "first frame"]),
    "a rate in words": (
        GOOD.replace(":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND fast"),
        4,
        None,
        ["'fast'", "a number"],
    ),
    "a rate of 0": (GOOD.replace(":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 0"), 4, None, ["0 Hz", "1 to"]),
}


def refusal(path, **options):
    with pytest.raises(RecordingError) as caught:
        load(path, **options)
    assert "\n" not in str(caught.value)
    return caught.value


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_what_was_expected(write, mistake):
    content, line, column, expected = MISTAKES[mistake]
    path = write(content)
    error = refusal(path)
    assert error.path == path
    assert line is None or error.line == line, str(error)
    assert column is None or error.column == column, str(error)
    assert all(word in str(error) for word in expected), str(error)


def test_an_option_that_contradicts_the_file_is_refused(write):
    assert "one unit" in str(refusal(write(GOOD), unit="rad"))
    assert "one person" in str(refusal(write(GOOD), person="2"))


def asf_line(words_):
    return ASF[: ASF.index(words_)].count("\n") + 1


# The same for the skeleton
SKELETON_MISTAKES = {
    "another kind of file": ("time,LHand\n0,1\n", 1, None, ["'time,LHand'", "ASF skeleton"]),
    "empty": ("# nothing\n", None, None, ["no :root"]),
    "no root": (ASF.replace(":root", ":roots"), None, None, ["unknown bone 'root'"]),
    "no bones": (ASF[: ASF.index(":bonedata")], None, None, ["no bones", ":bonedata"]),
    "cut in a bone": (ASF[: ASF.index("name lradius")], None, None, ["ends in a block", "'end'"]),
    "cut in the hierarchy": (ASF[: ASF.rindex("    lradius lwrist")], None, None, ["ends in a block"]),
    "a bone in a bone": (ASF.replace("  end\n", "", 1), None, None, ["'begin'", "'end'"]),
    "an end too many": (ASF.replace("  end\n", "  end\n  end\n", 1), None, None, ["'end'", "'begin'"]),
    "a section in a bone": (ASF.replace("  end\n", ":hierarchy\n", 1), None, None, [":hierarchy", "'end' before"]),
    "words between bones": (ASF.replace("  end\n", "  end\n  length 3\n", 1), None, None, ["'length 3'", "'begin'"]),
    "a bone without name": (ASF.replace("     name lfemur\n", ""), None, None, ["without name"]),
    "a bone without length": (ASF.replace("     length 7.3\n", "", 1), None, None, ["without length"]),
    "a bone without axis": (ASF.replace("     axis 0 0 20   XYZ\n", "", 1), None, None, ["without axis"]),
    "a bone twice": (ASF.replace("name ltibia", "name lfemur"), None, None, ["lfemur twice", "once"]),
    "a length in words": (ASF.replace("length 7.3", "length long", 1), None, "lfemur length", ["'long'", "a number"]),
    "a length below 0": (ASF.replace("length 7.3", "length -7.3", 1), None, "lfemur", ["-7.3", "from 0"]),
    "no direction": (ASF.replace("direction 0 -1 0", "direction 0 0 0", 1), None, "lfemur", ["a direction"]),
    "two numbers for a direction": (
        ASF.replace("direction 0 -1 0", "direction 0 -1", 1),
        None,
        None,
        ["2 values", "x y z"],
    ),
    "an axis order": (ASF.replace("axis 0 0 20   XYZ", "axis 0 0 20 XYX", 1), None, "lfemur", ["XYX", "order"]),
    "an axis of two": (ASF.replace("axis 0 0 20   XYZ", "axis 0 20 XYZ", 1), None, "lfemur axis", ["2 values"]),
    "an unknown freedom": (
        ASF.replace("dof rx ry rz", "dof rx ry l", 1),
        asf_line("dof rx"),
        "lfemur",
        ["'l'", "rx, ry, rz"],
    ),
    "a freedom twice": (ASF.replace("dof rx ry rz", "dof rx ry rx", 1), None, "lfemur", ["'rx'", "each once"]),
    "an unknown bone": (ASF.replace("lradius lwrist", "lradius lpaw"), None, None, ["'lpaw'", ":bonedata"]),
    "a bone on two": (ASF.replace("lradius lwrist", "lradius lwrist rwrist"), None, None, ["second parent for rwrist"]),
    "a bone on none": (ASF.replace("lradius lwrist", "lradius"), None, None, ["lwrist without a parent"]),
    "bones in a ring": (
        ASF.replace("root lhipjoint rhipjoint thorax", "root lhipjoint rhipjoint").replace(
            "lradius lwrist", "lradius lwrist thorax"
        ),
        None,
        None,
        ["thorax hangs on itself"],
    ),
    "an angle unit": (ASF.replace("angle deg", "angle grad"), 7, "angle", ["'grad'", "deg or rad"]),
    "no person": (ASF.replace("humerus", "fin"), None, None, ["no known person", "LeftArm"]),
}


@pytest.mark.parametrize("mistake", SKELETON_MISTAKES)
def test_a_mistake_in_the_skeleton_blames_the_skeleton(write, mistake):
    content, line, column, expected = SKELETON_MISTAKES[mistake]
    path = write(GOOD, asf=content)
    error = refusal(path)
    assert error.path.name == "07.asf"
    assert line is None or error.line == line, str(error)
    assert column is None or error.column == column, str(error)
    assert all(word in str(error) for word in expected), str(error)


def test_a_skeleton_that_is_no_file_is_told(write, tmp_path):
    path = write(GOOD)
    assert "no such file" in str(refusal(path, rig=tmp_path / "none.asf"))
    assert "an ASF skeleton" in str(refusal(path, rig=tmp_path))
    (tmp_path / "a.png").write_bytes(b"\x89PNG\0")
    assert "an ASF skeleton" in str(refusal(path, rig=tmp_path / "a.png"))


@settings(max_examples=60)
@given(data=st.data())
def test_damaged_files_are_read_or_refused(tmp_path_factory, data):
    texts = [GOOD, ASF]
    for _ in range(data.draw(st.integers(1, 3))):
        which = data.draw(st.integers(0, 1))
        text = texts[which]
        start = data.draw(st.integers(0, len(text) - 1))
        end = data.draw(st.integers(start, min(start + 40, len(text))))
        new = data.draw(
            st.sampled_from(["", "\n", ":", " ", "nan", "-", "1e308", "9" * 30, "é", "begin", "end\n", "root"])
        )
        texts[which] = text[:start] + new + text[end:]
    folder = tmp_path_factory.mktemp("law")
    (folder / "7.asf").write_text(texts[1] or "\n")
    (folder / "7_1.amc").write_text(texts[0] or "\n")
    try:
        assert np.isfinite(load(folder / "7_1.amc").motion.times).all()
    except NaoSimError as error:
        assert "\n" not in str(error)


def test_chunks_make_the_same_motion(write, monkeypatch):
    path = write(amc_text(some_frames(7)))
    whole = points(path)
    monkeypatch.setattr(acclaim, "CHUNK", 3)
    np.testing.assert_allclose(points(path).values, whole.values, atol=1e-12)


def test_memory_grows_as_the_result_and_not_as_the_text(write, monkeypatch):
    monkeypatch.setattr(acclaim, "CHUNK", 100)
    block = "\n".join(f"{bone} {words(values)}" for bone, values in FRAMES[0].items())
    peaks, sizes = [], []
    for frames in (300, 1500):
        path = write(":FULLY-SPECIFIED\n:DEGREES\n" + "".join(f"{k}\n{block}\n" for k in range(frames)))
        tracemalloc.start()
        try:
            found = points(path)
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
        assert len(found.values) == frames
        sizes.append(found.values.nbytes)
    assert peaks[1] - peaks[0] < 2.5 * (sizes[1] - sizes[0])
