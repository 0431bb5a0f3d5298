"""Text of numbers without names: any shape of row, and what a mistake in it is told as."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.skeletons.layouts import Row, builtin
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables import skeleton_rows
from tests.people import in_file, people, person
from tests.refusals import refusal
from tests.skeleton_text import text_of

LAYOUTS = {layout.name: layout for layout in builtin()}
V1, V2 = LAYOUTS["Kinect v1 (SDK order)"], LAYOUTS["Kinect v2"]
ROWS = [
    Row(),
    Row(before=("time",)),
    Row(before=("-", "time")),
    Row(after=("label",)),
    Row(before=("time",), after=("label",)),
    Row(before=("time",), joint=("x", "y", "z", "state")),
    Row(joint=("state", "x", "y", "z")),
    Row(joint=("x", "y", "z", "confidence")),
    Row(order="axis"),
    Row(before=("time",), order="axis"),
    Row(before=("time",), joint=("x", "y", "z", "-", "-", "-", "-")),
    Row(per="joint"),
    Row(per="joint", joint=("x", "y", "z", "confidence")),
    Row(per="joint", before=("time",)),
]


@pytest.fixture
def write(tmp_path):
    def write(text, name="rows.txt"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def refused(path, **options):
    return str(refusal(path, **options))


def assert_same(found, expected):
    for joint in found.joints:
        known = np.isfinite(found.track(joint)).all(axis=1)
        np.testing.assert_allclose(found.track(joint)[known], expected.track(joint)[known], atol=1e-6, err_msg=joint)


@settings(max_examples=60)
@given(
    someone=people(),
    layout=st.sampled_from(builtin()),
    row=st.sampled_from(ROWS),
    unit=st.sampled_from([1.0, 0.01, 0.001]),
    separator=st.sampled_from([" ", "  ", ",", ";", ", ", "\t"]),
    trailing=st.booleans(),
)
def test_whatever_the_row_the_person_is_the_same_or_the_file_is_refused(
    tmp_path_factory, someone, layout, row, unit, separator, trailing
):
    path = tmp_path_factory.mktemp("rows") / "someone.txt"
    times = np.round(500.0 + 1000.0 * someone.times)
    labels = np.repeat([1.0, 2.0], len(someone) // 2)
    asides = {"time": times, "label": labels, "-": np.full(len(someone), 3.25)}
    random = np.random.default_rng(0)
    trust = random.choice([1.0, 2.0], (len(someone), len(layout)))
    trust = trust / 2.0 if "confidence" in row.joint else trust
    path.write_text(text_of(in_file(someone, layout.joints, unit), row, asides, trust, separator, trailing))
    timed = "time" in row.before
    try:
        recording = load(path, rate=None if timed else 30.0)
    except RecordingError as error:
        assert "several layouts" in str(error)
        return
    assert layout.name in recording.reason or {layout.name, "OpenNI (NiTE 1)"} == {
        "Florence 3D Actions",
        "OpenNI (NiTE 1)",
    }
    skeleton = recording.motion
    assert len(skeleton) == len(someone)
    assert_same(skeleton, someone)
    np.testing.assert_allclose(skeleton.times, someone.times, atol=1e-3)
    if row.joint.count("state") or row.joint.count("confidence"):
        scale = {1.0: 0.33, 2.0: 0.67} if layout.states.get(3) else {1.0: 0.5, 2.0: 1.0}
        told = np.vectorize(scale.get)(trust) if "state" in row.joint else trust
        columns = [layout.joints.index(joint) for joint in skeleton.joints]
        np.testing.assert_allclose(skeleton.confidence, told[:, columns])


@settings(max_examples=15)
@given(someone=people(), layout=st.sampled_from(builtin()), seed=st.integers(0, 99))
def test_an_order_that_nobody_knows_is_refused_and_tells_of_layouts(tmp_path_factory, someone, layout, seed):
    order = np.random.default_rng(seed).permutation(len(layout))
    path = tmp_path_factory.mktemp("rows") / "someone.txt"
    path.write_text(text_of(in_file(someone, layout.joints)[:, order], Row()))
    assert "--layout" in refused(path, rate=30.0)


@pytest.mark.parametrize("change", [str, lambda text: text.replace("\n", "\r\n"), lambda text: "# made up\n\n" + text])
def test_line_ends_and_comments_do_not_matter(write, change):
    someone = person(20, 1)
    text = change(text_of(in_file(someone, V1.joints), Row()))
    assert_same(load(write(text)).motion, someone)


def test_cells_that_are_empty_or_nan_are_missing(write):
    someone = person(20, 1)
    lines = text_of(in_file(someone, V1.joints), Row(), separator=",").splitlines()
    cells = lines[4].split(",")
    cells[12:15], cells[15:18] = [""] * 3, ["nan"] * 3
    lines[4] = ",".join(cells)
    skeleton = load(write("\n".join(lines))).motion
    missing = np.argwhere(np.isnan(skeleton.positions[:, :, 0])).tolist()
    assert missing == [[4, 4], [4, 5]] and skeleton.joints[4:6] == ("left_shoulder", "left_elbow")
    assert_same(skeleton, someone)


@pytest.mark.parametrize("separator", [";", "\t", " "])
def test_decimal_commas_are_read_where_nothing_else_makes_numbers(write, separator):
    someone = person(20, 1)
    text = text_of(in_file(someone, V1.joints), Row(), separator=separator).replace(".", ",")
    assert_same(load(write(text)).motion, someone)


def test_what_c_prints_for_nan_is_missing(write):
    someone = person(20, 1)
    lines = text_of(in_file(someone, V1.joints), Row()).splitlines()
    for number, nan in enumerate(["-1.#IND", "1.#QNAN", "-nan(ind)"], start=5):
        cells = lines[number].split()
        cells[12:15] = [nan] * 3
        lines[number] = " ".join(cells)
    skeleton = load(write("\n".join(lines))).motion
    assert np.flatnonzero(np.isnan(skeleton.track("left_shoulder")[:, 0])).tolist() == [5, 6, 7]


def test_counts_above_the_frames_are_left_out(write):
    someone = person(20, 1)
    text = text_of(in_file(someone, V1.joints), Row())
    for above in ("20 20\n", "20\n20\n", "1 20 30\n"):
        assert_same(load(write(above + text)).motion, someone)


def test_a_recording_that_begins_without_anybody_is_read(write):
    someone = person(30, 1)
    lines = text_of(in_file(someone, V1.joints), Row()).splitlines()
    recording = load(write("\n".join([*(["nan " * 60] * 15), *(["0 " * 60] * 15), *lines])))
    assert recording.frames == 30 and "30 frames at the ends without anybody left out" in recording.notes
    assert_same(recording.motion, someone)


def test_a_cell_of_text_is_told_by_line_and_column(write):
    lines = text_of(in_file(person(20, 1), V1.joints), Row(), separator=",").splitlines()
    cells = lines[14].split(",")
    cells[12] = "lost"
    lines[14] = ",".join(cells)
    message = refused(write("\n".join(lines)))
    assert "line 15, column 13 (left_shoulder.x): 'lost'; expected a number" in message


def test_a_line_that_is_too_long_or_too_short_is_told_and_a_last_one_that_breaks_off_is_left_out(write):
    lines = text_of(in_file(person(20, 1), V1.joints), Row()).splitlines()
    assert "line 15: 61 values; expected 60" in refused(write("\n".join([*lines[:14], lines[14] + " 1", *lines[15:]])))
    assert "line 15: 59 values; expected 60" in refused(
        write("\n".join([*lines[:14], lines[14].rpartition(" ")[0], *lines[15:]]))
    )
    recording = load(write("\n".join([*lines[:-1], lines[-1][:200]])))
    assert recording.frames == 19 and "the last frame (line 20) breaks off: left out" in recording.notes


def test_a_frame_of_lines_that_breaks_off_is_left_out(write):
    text = text_of(in_file(person(20, 1), V1.joints), Row(per="joint"))
    recording = load(write("\n".join(text.splitlines()[:-3])))
    assert recording.frames == 19 and "the last frame (line 381) breaks off: left out" in recording.notes


def test_a_lost_line_of_a_frame_is_told_where_lines_say_their_frame(write):
    someone = person(20, 1)
    row = Row(per="joint", before=("frame",))
    lines = text_of(in_file(someone, V1.joints), row, {"frame": np.arange(20.0)}).splitlines()
    del lines[110]
    layout = write(f"joints = {list(V1.joints)}\n[[row]]\nper = 'joint'\nbefore = ['frame']\n", "my.toml")
    message = refused(write("\n".join(lines)), layout=layout)
    assert "line 101, column frame: several frames; expected one in the 20 lines of a frame" in message


def test_repeated_frame_numbers_are_left_out(write):
    someone = person(20, 1)
    numbers = np.arange(20.0) * 2 + 7
    lines = text_of(in_file(someone, V1.joints), Row(before=("frame",)), {"frame": numbers}).splitlines()
    recording = load(write("\n".join([*lines[:6], lines[5], *lines[6:]])))
    assert recording.frames == 20 and "1 frame at the time of the one before left out" in recording.notes
    np.testing.assert_allclose(recording.motion.times, np.arange(20) * 2 / 30.0)


def test_people_line_by_line_are_told_apart(write):
    one, two = person(40, 1), person(40, 2, height=1.4)
    row = Row(before=("frame", "person"))
    texts = [
        text_of(in_file(someone, V2.joints), row, {"frame": np.arange(40.0), "person": np.full(40, number)})
        for someone, number in ((one, 17.0), (two, 4.0))
    ]
    lines = [line for pair in zip(*(text.splitlines() for text in texts), strict=True) for line in pair]
    path = write("\n".join([*lines[:-6], *lines[-6::2]]))
    recording = load(path, rate=30.0)
    assert recording.frames == 40 and any("17, the longest" in note for note in recording.notes)
    assert_same(recording.motion, one)
    second = load(path, rate=30.0, person=4)
    assert second.frames == 37
    np.testing.assert_allclose(second.motion.track("head"), two.track("head")[:37], atol=1e-6)
    assert "no person 9; expected one of 17, 4" in refused(path, rate=30.0, person=9)


def test_a_person_asked_for_in_a_file_that_names_none_is_refused(write):
    path = write(text_of(in_file(person(20), V2.joints), Row()))
    assert "person '3'; expected no --person" in refused(path, rate=30.0, person=3)


def test_takes_one_after_the_other_are_told_apart(write):
    layout = LAYOUTS["Florence 3D Actions"]
    texts = [
        text_of(in_file(person(frames, seed), layout.joints), layout.rows[0], {"take": np.full(frames, seed)})
        for seed, frames in ((1, 20), (2, 35), (3, 25))
    ]
    path = write("".join(texts))
    assert load(path).frames == 35 and load(path, person=3).frames == 25


def test_frames_that_count_their_lines(write):
    someone = person(12, 1)
    values = in_file(someone, V1.joints)
    lines = ["12 20"]
    for number, frame in enumerate(values):
        if number == 5:
            lines.append("0")
            continue
        crowd = 2 if number == 7 else 1
        lines.append(str(40 * crowd))
        for _ in range(crowd):
            for x, y, z in frame:
                lines += [f"{x:.9f} {y:.9f} {z:.9f} 1", "0.1 0.2 9000 1"]
    recording = load(write("\n".join(lines)))
    assert recording.frames == 12 and np.isnan(recording.motion.positions[5]).all()
    assert any("several people in 1 frames" in note for note in recording.notes)
    assert_same(recording.motion, someone)
    lines[1] = "39"
    assert "line 2: '39'; expected how many lines the frame has, 0 or 40" in refused(write("\n".join(lines)))


def test_columns_that_no_pattern_says(write):
    layout = LAYOUTS["CAD-60"]
    someone = person(30, 1)
    values = in_file(someone, layout.joints, 0.001)
    columns = layout.rows[0].columns
    lines = []
    for number, frame in enumerate(values):
        cells = []
        for name in columns:
            joint, _, axis = name.partition(".")
            known = {"frame": number + 1.0, "-": 0.5}
            cells.append(known[name] if name in known else {"confidence": 1.0}.get(axis, 0.0) if axis == "confidence"
                         else frame[layout.joints.index(joint)]["xyz".index(axis)])  # fmt: skip
        lines.append(",".join(f"{cell:.9f}" for cell in cells) + ",")
    recording = load(write("\n".join([*lines, "END"])))
    assert recording.frames == 30 and "CAD-60" in recording.reason
    assert_same(recording.motion, someone)


def test_an_unknown_tracking_state_is_told(write):
    text = text_of(in_file(person(400, 1), V2.joints), Row(joint=("x", "y", "z", "state")))
    lines = text.splitlines()
    lines[301] = lines[301][:-1] + "9"
    message = refused(write("\n".join(lines)))
    assert "line 302, column state of point 25: 9; expected 0, 1, 2" in message


def test_a_layout_of_ones_own_reads_what_nobody_foresaw(write):
    order = [V1.joints[place] for place in np.random.default_rng(3).permutation(20)]
    layout = write(f'name = "mine"\njoints = {order}\nrate = 12.5\n', "my.toml")
    someone = person(30, 1)
    path = write(text_of(in_file(someone, tuple(order)), Row(after=("label",))))
    recording = load(path, layout=layout)
    assert "mine" in recording.reason
    assert_same(recording.motion, someone)
    np.testing.assert_allclose(recording.motion.times, np.arange(30) / 12.5)
    short = write(f"joints = {[joint for joint in order if joint != 'spine']}\n", "short.toml")
    with pytest.raises(RecordingError, match=r"60 numbers a line|61 numbers a line"):
        load(path, layout=short)


def test_what_a_layout_of_ones_own_says_is_done_even_against_appearances(write):
    order = list(V1.joints)
    order[3], order[19] = order[19], order[3]  # head and right foot
    layout = write(
        f"joints = {order}\nunit = 'm'\naxes = {{ forward = '-z', left = '-x', up = '+y' }}\n[[row]]\n", "my.toml"
    )
    someone = person(30, 1)
    recording = load(write(text_of(in_file(someone, V1.joints), Row())), layout=layout, rate=30.0)
    assert any("unlike a body" in note for note in recording.notes)
    np.testing.assert_allclose(recording.motion.track("right_foot"), someone.track("head"), atol=1e-6)


@pytest.mark.parametrize(
    "text",
    [
        "time,LElbowRoll_deg\n0,1\n",
        "1 2 3\n" * 5,
        "1 2 3\n" * 12 + "1 2 3 4\n",
        "a b c " * 20 + "\n",
        "0,1,2\n1,2,3\n",
        "HIERARCHY\nROOT Hips\n",
    ],
)
def test_other_text_is_not_taken(write, text):
    assert skeleton_rows.recognise(Source(write(text))) is None


def test_a_long_file_is_read_in_little_more_memory_than_it_gives(write):
    someone = person(12_000, 1)
    layout = V1
    line = text_of(in_file(someone, layout.joints)[:4000], Row(before=("time",)), {"time": np.arange(4000.0)})
    rows = [row.partition(" ")[2] for row in line.splitlines()]
    path = write("".join(f"{33 * frame} {rows[frame % 4000]}\n" for frame in range(12_000)))
    del line, rows, someone
    load(path)
    tracemalloc.start()
    skeleton = load(path).motion
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    held = skeleton.positions.nbytes + skeleton.times.nbytes
    fixed = 40e6  # a chunk of text, its numbers and the sample
    assert len(skeleton) == 12_000 and peak < 2.5 * held + fixed
