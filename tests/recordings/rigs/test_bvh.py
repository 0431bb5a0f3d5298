"""BVH: what is read, and what a mistake is told as."""

import gzip
import lzma
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.errors import NaoSimError, RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.rigs import bvh, rig
from nao_sim.recordings.rigs.rig_joints import FACE_NOTE
from nao_sim.recordings.source import Source

# name, parent, offset (cm), of a person with arms out who looks along z
PERSON = (
    ("Hips", -1, (0, 0, 0)),
    ("Spine", 0, (0, 20, 0)),
    ("Neck", 1, (0, 30, 0)),
    ("Head", 2, (0, 12, 0)),
    ("LeftShoulder", 1, (3, 25, 0)),
    ("LeftArm", 4, (15, 0, 0)),
    ("LeftForeArm", 5, (28, 0, 0)),
    ("LeftHand", 6, (25, 0, 0)),
    ("RightShoulder", 1, (-3, 25, 0)),
    ("RightArm", 8, (-15, 0, 0)),
    ("RightForeArm", 9, (-28, 0, 0)),
    ("RightHand", 10, (-25, 0, 0)),
    ("LeftUpLeg", 0, (10, -5, 0)),
    ("LeftLeg", 12, (0, -42, 0)),
    ("LeftFoot", 13, (0, -42, 0)),
    ("LeftToeBase", 14, (0, -8, 14)),
    ("RightUpLeg", 0, (-10, -5, 0)),
    ("RightLeg", 16, (0, -42, 0)),
    ("RightFoot", 17, (0, -42, 0)),
    ("RightToeBase", 18, (0, -8, 14)),
)
NAMES = [name for name, _, _ in PERSON]
POSITIONS = "Xposition Yposition Zposition"
ENDS = {"Head": (0, 20, 0), "LeftHand": (18, 0, 0), "RightHand": (-18, 0, 0)}


def skeleton_text(orders, prefix=""):
    """The hierarchy, with the channels of each joint in `orders`."""
    children = {k: [c for c, (_, parent, _) in enumerate(PERSON) if parent == k] for k in range(-1, len(PERSON))}

    def block(joint, indent):
        name, parent, offset = PERSON[joint]
        channels = orders[joint].split()
        lines = [f"{'ROOT' if parent < 0 else 'JOINT'} {prefix}{name}", "{", "\tOFFSET " + " ".join(map(str, offset))]
        lines += [f"\tCHANNELS {len(channels)} {' '.join(channels)}"] * bool(channels)
        lines = ["\t" * indent + line for line in lines]
        for child in children[joint]:
            lines += block(child, indent + 1)
        if name in ENDS:
            lines += ["End Site", "{", "OFFSET " + " ".join(map(str, ENDS[name])), "}"]
        return [*lines, "\t" * indent + "}"]

    return "\n".join(["HIERARCHY", *block(children[-1][0], 0)])


def text_of(orders, rows, step="0.04", prefix="", frames=None):
    """A BVH file."""
    motion = [f"MOTION\nFrames: {len(rows) if frames is None else frames}\nFrame Time: {step}"]
    motion += [" ".join(f"{value:.10g}" for value in row) for row in rows]
    return "\n".join([skeleton_text(orders, prefix), *motion]) + "\n"


ORDERS = [f"{POSITIONS} Zrotation Yrotation Xrotation"] + ["Zrotation Yrotation Xrotation"] * (len(PERSON) - 1)
ROWS = np.zeros((3, 3 + 3 * len(PERSON)))
ROWS[:, 1] = 100.0
ROWS[:, 3:] = np.random.default_rng(0).uniform(-20.0, 20.0, (3, 3 * len(PERSON)))
GOOD = text_of(ORDERS, ROWS)


@pytest.fixture
def write(tmp_path):
    def write(content, name="person.bvh"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def points(path, **options):
    return bvh.points_of(Source(path, **options))[0]


def place(found, joint):
    return found.values[:, found.names.index(joint)]


def test_a_file_loads_as_a_person_in_metres_and_seconds(write):
    recording = load(write(GOOD))
    person = recording.motion
    assert recording.format == "BVH" and recording.frames == len(person) == 3
    assert "the first line is HIERARCHY" in recording.reason
    np.testing.assert_allclose(person.times, [0.0, 0.04, 0.08])
    arm = person.track("left_elbow") - person.track("left_shoulder")
    np.testing.assert_allclose(np.linalg.norm(arm, axis=1), 0.28, atol=1e-9)
    assert (person.track("head") - person.track("pelvis"))[:, 2].min() > 0.4
    assert (person.track("left_shoulder") - person.track("right_shoulder"))[:, 1].min() > 0.2


def test_a_child_turns_with_its_parents_about_its_own_axes_first_channel_first(write):
    rows = np.zeros((1, ROWS.shape[1]))
    arm, fore = 3 + 3 * NAMES.index("LeftArm"), 3 + 3 * NAMES.index("LeftForeArm")
    rows[0, arm : arm + 3] = 90.0, 0.0, 90.0  # up, then about the arm's own x, which points up now
    rows[0, fore] = 90.0
    found = points(write(text_of(ORDERS, rows)))
    upper = place(found, "left_elbow") - place(found, "left_shoulder")
    lower = place(found, "left_wrist") - place(found, "left_elbow")
    np.testing.assert_allclose(upper, [[0.0, 28.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(lower, [[0.0, 0.0, 25.0]], atol=1e-9)


def test_the_root_is_where_its_position_channels_say(write):
    rows = np.zeros((2, ROWS.shape[1]))
    rows[:, :3] = [[1.0, 2.0, 3.0], [40.0, 50.0, 60.0]]
    found = points(write(text_of(ORDERS, rows).replace("OFFSET 0 0 0", "OFFSET 7 8 9", 1)))
    np.testing.assert_allclose(place(found, "pelvis"), rows[:, :3])


def test_the_same_person_in_other_words(write):
    expected = points(write(GOOD, "good.bvh"))
    for content in (
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r"),
        GOOD.replace("\t", "    "),
        GOOD.replace("\n{", " {"),
        GOOD.replace("\n", "\n\n"),
        GOOD.replace(" ", "\t").replace("End\tSite", "End Site").replace("Frame\tTime:", "Frame Time:"),
        GOOD.rstrip("\n"),
        GOOD.replace("rotation", "ROTATION").replace("HIERARCHY", "hierarchy").replace("JOINT", "Joint"),
        GOOD.replace("Frames: ", "Frames:\t").replace("Frame Time: 0.04", "Frame Time:4.0e-2"),
        "\ufeff" + GOOD,
        text_of(ORDERS, ROWS, prefix="mixamorig:"),
        text_of(ORDERS, ROWS, prefix="Bip01 "),
    ):
        found = points(write(content))
        assert found.names == expected.names
        np.testing.assert_allclose(found.values, expected.values, atol=1e-9)
        np.testing.assert_allclose(found.times, expected.times)


@pytest.mark.parametrize(("pack", "suffix"), [(gzip.compress, ".gz"), (lzma.compress, ".xz")])
def test_a_compressed_file_is_read(write, pack, suffix):
    found = points(write(pack(GOOD.encode()), f"person.bvh{suffix}"))
    np.testing.assert_array_equal(found.values, points(write(GOOD)).values)


CHANNEL_SETS = st.lists(st.sampled_from("XYZ"), max_size=3, unique=True)


@settings(max_examples=25)
@given(data=st.data())
def test_any_channels_in_any_order_say_the_same_motion(tmp_path_factory, data):
    """Write a motion with random channels, read it, and compare with a slow walk down the tree."""
    turning = [data.draw(CHANNEL_SETS) for _ in PERSON]
    moving = ["before", *(data.draw(st.sampled_from(["", "before", "after"])) for _ in PERSON[1:])]
    orders, random = [], np.random.default_rng(data.draw(st.integers(0, 2**31)))
    values = {}
    for joint, (axes, where) in enumerate(zip(turning, moving, strict=True)):
        turns = " ".join(f"{axis}rotation" for axis in axes)
        orders.append({"": turns, "before": f"{POSITIONS} {turns}", "after": f"{turns} {POSITIONS}"}[where])
        near = np.array(PERSON[joint][2]) + random.uniform(-1.0, 1.0, (2, 3))
        values[joint] = random.uniform(-180.0, 180.0, (2, len(axes))), near
    rows = [np.hstack(ordered(values[joint], moving[joint])) for joint in range(len(PERSON))]
    path = tmp_path_factory.mktemp("law") / "x.bvh"
    path.write_text(text_of(orders, np.hstack(rows)))
    found = points(path)
    slow = slow_walk(turning, moving, values)
    for joint, name in ((6, "left_elbow"), (11, "right_wrist"), (19, "right_foot"), (3, "head")):
        np.testing.assert_allclose(place(found, name), slow[:, joint], atol=1e-6)


def ordered(value, where):
    angles, near = value
    return {"": (angles,), "before": (near, angles), "after": (angles, near)}[where]


def slow_walk(turning, moving, values):
    found = np.zeros((2, len(PERSON), 3))
    for frame in range(2):
        matrices = []
        for joint, (_, parent, offset) in enumerate(PERSON):
            above, start = (np.eye(3), np.zeros(3)) if parent < 0 else (matrices[parent], found[frame, parent])
            angles, near = values[joint]
            found[frame, joint] = start + above @ (near[frame] if moving[joint] else np.array(offset))
            for axis, angle in zip(turning[joint], angles[frame], strict=True):
                about = np.eye(3)["XYZ".index(axis)]
                above = above @ Rotation.from_rotvec(np.radians(angle) * about).as_matrix()
            matrices.append(above)
    return found


def test_bones_keep_their_lengths(write):
    found = points(write(GOOD))
    for start, end, length in (("shoulder", "elbow", 28.0), ("elbow", "wrist", 25.0), ("hip", "knee", 42.0)):
        for side in ("left_", "right_"):
            lengths = np.linalg.norm(place(found, side + end) - place(found, side + start), axis=1)
            np.testing.assert_allclose(lengths, length, atol=1e-9)


def test_positions_of_inner_joints_stand_in_place_of_their_offsets_or_are_added_to_them(write):
    orders = [f"{POSITIONS} Zrotation"] * len(PERSON)
    rest = np.array([offset for _, _, offset in PERSON], float)
    in_place = np.hstack([np.hstack([rest, np.full((len(PERSON), 1), 5.0)]).reshape(1, -1)] * 2).reshape(2, -1)
    added = np.tile(np.hstack([np.zeros_like(rest), np.full((len(PERSON), 1), 5.0)]).reshape(1, -1), (2, 1))
    one, other = (bvh.points_of(Source(write(text_of(orders, rows)))) for rows in (in_place, added))
    np.testing.assert_allclose(one[0].values, other[0].values, atol=1e-9)
    assert one[1] == (FACE_NOTE,) and "added to their OFFSET" in other[1][0]


def test_the_arms_may_be_all_that_there_is(write):
    text = f"HIERARCHY\nROOT LeftArm\n{{\nOFFSET 0 0 0\n{CHANNELS}\nEnd Site\n{{\nOFFSET 1 0 0\n}}\n}}\n"
    assert points(write(text + "MOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n")).names == ("left_shoulder",)


def test_one_of_several_people_is_read(write):
    first, second = (skeleton_text(ORDERS, prefix).removeprefix("HIERARCHY\n") for prefix in ("Ann:", "Bob:"))
    box = "ROOT box\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\nEnd Site\n{\nOFFSET 1 0 0\n}\n}"
    rows = np.hstack([np.zeros((3, 3)), ROWS, ROWS + 10.0])
    motion = text_of(ORDERS, rows).partition("MOTION")[2]
    path = write("\n".join(["HIERARCHY", box, first, second, "MOTION"]) + motion)
    found, notes = bvh.points_of(Source(path))
    np.testing.assert_allclose(place(found, "pelvis"), ROWS[:, :3])
    assert notes == ("2 people: Ann:Hips was read, not Bob:Hips (--person)", FACE_NOTE)
    np.testing.assert_allclose(place(points(path, person="Bob:Hips"), "pelvis"), ROWS[:, :3] + 10.0)
    with pytest.raises(RecordingError, match=r"'box'.*Ann:Hips, Bob:Hips"):
        points(path, person="box")


def test_more_frames_than_announced_are_read_with_a_note(write):
    found, notes = bvh.points_of(Source(write(text_of(ORDERS, ROWS, frames=2))))
    assert len(found.values) == 3 and "3 frames instead of 2" in notes[0]


def test_a_rest_pose_before_the_motion_is_told(write):
    rows = np.tile(ROWS[1], (10, 1)) + np.arange(10)[:, None] * 0.1
    note = "first frame is far from the second"
    assert not any(note in told for told in bvh.points_of(Source(write(text_of(ORDERS, rows))))[1])
    rows[0, 3:] = 0.0
    assert any(note in told for told in bvh.points_of(Source(write(text_of(ORDERS, rows))))[1])


def line_of(text, words):
    return text[: text.index(words)].count("\n") + 1


FIRST = line_of(GOOD, "Frame Time") + 1  # the line of the first row
ROW = GOOD.split("\n")[FIRST - 1]
NECK = line_of(GOOD, "JOINT Neck")
CHANNELS = "CHANNELS 3 Zrotation Yrotation Xrotation"

# What a mistake is told as: (content, line, column, words of what was found and expected)
MISTAKES = {
    "a missing brace": (
        GOOD.replace("JOINT Neck\n\t\t{", "JOINT Neck\n\t\t"),
        NECK + 2,
        None,
        ["'OFFSET'", "'{' after"],
    ),
    "a brace too few": (GOOD.replace("}\nMOTION", "MOTION"), None, None, ["MOTION", "'}' for joint Hips"]),
    "a brace too many": (GOOD.replace("}\nMOTION", "}\n}\nMOTION"), None, None, ["'}'", "ROOT or MOTION"]),
    "two braces": (GOOD.replace("{", "{{", 1), 3, None, ["'{'", "OFFSET"]),
    "an unknown word": (GOOD.replace("JOINT Neck", "BONE Neck"), NECK, None, ["'BONE Neck'", "JOINT"]),
    "no root": (GOOD.replace("ROOT", "JOINT"), 2, None, ["'JOINT Hips'", "ROOT"]),
    "a joint without a name": (GOOD.replace("JOINT Neck", "JOINT"), NECK, None, ["without a name"]),
    "no skeleton": ("HIERARCHY\nMOTION\nFrames: 1\nFrame Time: 1\n0\n", 2, None, ["ROOT"]),
    "the file ends early": ("\n".join(GOOD.split("\n")[:12]), 12, None, ["ends in the hierarchy", "MOTION"]),
    "an offset of two": (GOOD.replace("OFFSET 0 20 0", "OFFSET 0 20", 1), None, "Spine OFFSET", ["2 values", "x y z"]),
    "an offset in words": (
        GOOD.replace("OFFSET 0 20 0", "OFFSET 0 x 0", 1),
        None,
        "Spine OFFSET y",
        ["'x'", "a number"],
    ),
    "an offset of nan": (
        GOOD.replace("OFFSET 0 20 0", "OFFSET 0 nan 0", 1),
        None,
        "Spine OFFSET y",
        ["'nan'", "finite"],
    ),
    "an endless offset": (
        GOOD.replace("OFFSET 0 20 0", "OFFSET 0 1e20 0", 1),
        None,
        "Spine OFFSET y",
        ["1e+20", "below"],
    ),
    "no offset": (GOOD.replace("OFFSET 0 20 0", "", 1), None, None, ["Spine without OFFSET"]),
    "an unknown channel": (GOOD.replace("Xrotation", "Wrotation", 1), 5, "Hips", ["'wrotation'", "Xrotation"]),
    "a channel twice": (GOOD.replace("Yrotation", "zrotation", 1), 5, "Hips", ["'zrotation' twice", "once"]),
    "a channel too few": (GOOD.replace("CHANNELS 3", "CHANNELS 4", 1), None, None, ["'4' and 3 names", "as many"]),
    "channels twice": (GOOD.replace(CHANNELS, f"{CHANNELS}\n{CHANNELS}", 1), None, "Spine", ["CHANNELS twice", "once"]),
    "a skeleton that cannot move": (skeleton_text([""] * len(PERSON)) + "\nMOTION\n", None, None, ["without CHANNELS"]),
    "no frame count": (GOOD.replace("Frames: 3", "Frames 3"), FIRST - 2, None, ["'Frames 3'", "Frames:"]),
    "a count in words": (GOOD.replace("Frames: 3", "Frames: all"), FIRST - 2, None, ["'all' frames", "how many"]),
    "no frames": (GOOD.replace("Frames: 3", "Frames: 0"), FIRST - 2, None, ["'0' frames", "at least one"]),
    "no frame time": (GOOD.replace("Frame Time: 0.04\n", ""), FIRST - 1, None, ["Frame Time: and seconds"]),
    "a frame time in words": (GOOD.replace("0.04", "fast"), FIRST - 1, "Frame Time", ["'fast'", "a number"]),
    "an empty frame time": (GOOD.replace("0.04", ""), FIRST - 1, "Frame Time", ["nothing", "a number"]),
    "a frame time of 0": (GOOD.replace("0.04", "0"), FIRST - 1, "Frame Time", ["0 s", "1e-06"]),
    "a frame time below 0": (GOOD.replace("0.04", "-0.04"), FIRST - 1, "Frame Time", ["-0.04 s"]),
    "a frame time of nan": (GOOD.replace("0.04", "nan"), FIRST - 1, "Frame Time", ["'nan'", "finite"]),
    "nothing after MOTION": (GOOD.partition("MOTION")[0] + "MOTION\n", None, None, ["end of the file", "Frames:"]),
    "rows that are missing": (text_of(ORDERS, ROWS, frames=5), FIRST + 2, None, ["ends after 3 frames", "5 frames"]),
    "no rows": (text_of(ORDERS, [], frames=5), FIRST - 2, None, ["ends after 0 frames", "5 frames"]),
    "a short row": (GOOD.replace(ROW, ROW[: ROW.rindex(" ")]), FIRST, None, ["62 values", "63"]),
    "a row cut in the middle": (GOOD[:-300], None, None, ["values", "63"]),
    "a long row": (GOOD.replace(ROW, ROW + " 1"), FIRST, None, ["64 values", "63"]),
    "text in a row": (GOOD.replace(ROW, "x" + ROW[1:]), FIRST, "Hips Xposition", ["'x'", "a number"]),
    "nan in a row": (GOOD.replace(ROW, "nan" + ROW[1:]), FIRST, "Hips Xposition", ["'nan'", "finite"]),
    "inf in a row": (GOOD.replace(ROW, "0 1e999" + ROW[5:]), FIRST, "Hips Yposition", ["'1e999'", "finite"]),
    "a place beyond the world": (GOOD.replace(ROW, "1e30" + ROW[1:]), FIRST, "Hips Xposition", ["1e+30", "below"]),
    "joints of no person": (
        GOOD.replace("Left", "Front").replace("Right", "Hind"),
        None,
        None,
        ["no known rig", "LeftArm"],
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_what_was_expected(refused, mistake):
    content, line, column, words = MISTAKES[mistake]
    error = refused(content)
    assert line is None or error.line == line, str(error)
    assert error.line is not None or mistake == "joints of no person"
    assert column is None or error.column == column, str(error)
    assert all(word in str(error) for word in words), str(error)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"unit": "rad"}, "degrees"),
        ({"rate": 30.0}, "no rate"),
        ({"rig": "x.asf"}, "none: BVH has its own"),
        ({"person": "Bob"}, "'Bob'"),
    ],
)
def test_an_option_that_says_otherwise_is_refused(refused, options, words):
    assert words in str(refused(GOOD, **options))


def test_a_mistake_deep_in_a_long_file_has_its_own_line(refused, monkeypatch):
    monkeypatch.setattr(rig, "_VALUES", 63 * 10)
    rows = GOOD.split("\n")[FIRST - 1 : FIRST + 2] * 20
    rows[47] = rows[47] + "x"
    content = "\n".join([*GOOD.replace("Frames: 3", "Frames: 60").split("\n")[: FIRST - 1], *rows])
    error = refused(content)
    assert error.line == FIRST + 47 and error.column == "RightToeBase Xrotation"


def test_chunks_make_the_same_motion(write, monkeypatch):
    whole = points(write(GOOD))
    monkeypatch.setattr(rig, "_VALUES", 63)
    np.testing.assert_allclose(points(write(GOOD)).values, whole.values, atol=1e-12)


def test_deep_nesting_is_no_trouble(write, refused):
    def nested(joints):
        opened = "".join(f"JOINT j{k}\n{{\nOFFSET 0 1 0\n" for k in range(joints))
        arm = "JOINT LeftArm\n{\nOFFSET 0 1 0\n}\n"
        return f"HIERARCHY\nROOT Hips\n{{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n{opened}{arm}{'}' * (joints + 1)}\n"

    motion = "MOTION\nFrames: 1\nFrame Time: 0.1\n5\n"
    np.testing.assert_allclose(place(points(write(nested(1500) + motion)), "left_shoulder"), [[5.0, 1501.0, 0.0]])
    assert "more than 2000 joints" in str(refused(nested(100_000) + motion))


@settings(max_examples=60)
@given(data=st.data())
def test_a_damaged_file_is_read_or_refused(tmp_path_factory, data):
    text = GOOD
    for _ in range(data.draw(st.integers(1, 3))):
        start = data.draw(st.integers(0, len(text) - 1))
        end = data.draw(st.integers(start, min(start + 40, len(text))))
        new = data.draw(
            st.sampled_from(["", "\n", "{", "}", " ", "nan", "-", "1e308", "9" * 30, "\0", "é", "JOINT", "MOTION\n"])
        )
        text = text[:start] + new + text[end:]
    path = tmp_path_factory.mktemp("law") / "x.bvh"
    path.write_text(text)
    try:
        assert np.isfinite(load(path).motion.times).all()
    except NaoSimError as error:
        assert "\n" not in str(error)


def test_memory_grows_as_the_result_and_not_as_the_text(write, monkeypatch):
    monkeypatch.setattr(rig, "_VALUES", 63 * 200)
    row = " ".join(f"{value:.12f}" for value in ROWS[0]) + "\n"
    peaks, sizes = [], []
    for frames in (600, 3600):
        path = write(text_of(ORDERS, [], frames=frames) + row * frames)
        tracemalloc.start()
        try:
            found = points(path)
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
        assert len(found.values) == frames
        sizes.append(found.values.nbytes)
    assert peaks[1] - peaks[0] < 2.5 * (sizes[1] - sizes[0])
