"""Layouts: the built-in ones, what a mistake in one's own is told as, and what docs/layouts.md says of them."""

import re
from pathlib import Path

import numpy as np
import pytest

from nao_sim import body
from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.skeletons.layout_file import read_layout
from nao_sim.recordings.skeletons.layouts import FOLDER, SKIP, Row, builtin, swapped
from nao_sim.recordings.tables.row_shapes import plan
from tests.people import in_file, person
from tests.skeleton_text import text_of

DOCS = Path(__file__).resolve().parents[3] / "docs" / "layouts.md"
GOOD = 'joints = ["head", "left_shoulder", "right_shoulder", "pelvis"]\n'


@pytest.fixture
def write(tmp_path):
    def write(text, name="my.toml"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


@pytest.mark.parametrize("layout", builtin(), ids=lambda layout: layout.name)
def test_a_built_in_layout_is_of_known_joints_with_a_source(layout):
    assert layout.source and layout.path is None
    assert set(layout.columns) <= set(body.joints())
    assert {"left_shoulder", "right_shoulder", "left_elbow", "right_elbow"} <= set(layout.columns)
    assert set(swapped(tuple(layout.columns))) == set(layout.columns)
    assert all(len(points) == 1 for points in layout.columns.values())
    for row in layout.rows:
        found = plan(layout, row)
        known = found.places[[joint != SKIP for joint in layout.joints]]
        assert (known[:, :2] >= 0).all() and len(np.unique(known[known >= 0])) == (known >= 0).sum()


def test_no_two_built_in_layouts_are_the_same():
    names = [layout.name for layout in builtin()]
    assert len(set(names)) == len(names) == len(list(FOLDER.glob("*.toml")))
    orders = [layout.joints for layout in builtin()]
    assert len(set(orders)) == len(orders)


def test_everything_a_layout_says_is_read(write):
    layout = read_layout(
        write(
            GOOD
            + 'name = "mine"\nunit = 0.5\ntime_unit = "frame"\nrate = 25\nheader = 2\nseparator = ";"\nend = "END"\n'
            'zeros = "points"\nsides = "viewer"\naxes = { forward = "y", left = "-x", up = "z" }\n'
            'states = { 0 = 0.0, "1.5" = 1 }\n[[row]]\nbefore = ["time", "-"]\njoint = ["state", "x", "y"]\n'
            'after = ["label"]\norder = "axis"\n[[row]]\nper = "joint"\nbetween = 1\ncounted = "yes"\nheader = 0\n'
        )
    )
    assert layout.joints == ("head", "right_shoulder", "left_shoulder", "pelvis")
    assert (layout.unit, layout.time_unit, layout.rate, layout.header) == (0.5, 0.0, 25.0, 2)
    assert (layout.separator, layout.end, layout.zeros_missing) == (";", "END", False)
    assert layout.axes == ("+y", "-x", "+z") and layout.states == {0.0: 0.0, 1.5: 1.0}
    assert layout.rows == (
        Row(before=("time", "-"), joint=("state", "x", "y"), after=("label",), order="axis"),
        Row(per="joint", between=1, counted=True, header=0),
    )
    assert layout.rows[0].width(4) == 15 and layout.rows[1].width(4) == 3


def test_points_may_be_called_as_devices_call_them(write):
    layout = read_layout(write('joints = ["Head", "ShoulderLeft", "RShoulder", "SpineBase", "-", "SpineBase"]'))
    assert layout.joints == ("head", "left_shoulder", "right_shoulder", "pelvis", "-", "pelvis")
    assert layout.columns["pelvis"] == [3, 5]


ROW = GOOD + "[[row]]\n"
MISTAKES = {
    "no joints": ('name = "x"', "no joints"),
    "no shoulders": ('joints = ["head"]', "column joints: no left_shoulder and right_shoulder"),
    "unknown joint": ('joints = ["left_shoulder", "right_shoulder", "tail"]', "column joints: 'tail'"),
    "joints are no list": ("joints = 3", "column joints: 3; expected a list"),
    "unknown key": (GOOD + "untis = 3", "column untis: unknown key (did you mean unit?)"),
    "unknown unit": (
        GOOD + 'unit = "mile"',
        "column unit: 'mile'; expected m, dm, cm, mm, in, ft or a number of metres",
    ),
    "negative unit": (GOOD + "unit = -1", "column unit: -1; expected"),
    "true unit": (GOOD + "unit = true", "column unit: True"),
    "infinite rate": (GOOD + "rate = inf", "column rate: inf"),
    "unknown time": (GOOD + 'time_unit = "fortnight"', "column time_unit"),
    "axis twice": (
        GOOD + 'axes = { forward = "x", left = "-x", up = "z" }',
        "column axes: +x, -x, +z; expected x, y and z once",
    ),
    "axis missing": (GOOD + 'axes = { forward = "x", up = "z" }', "column axes: no left"),
    "axis unknown": (GOOD + 'axes = { forward = "w", left = "y", up = "z" }', "column axes.forward: 'w'"),
    "axes no table": (GOOD + 'axes = "xyz"', "column axes: 'xyz'; expected a table"),
    "header": (GOOD + "header = -1", "column header: -1; expected a whole number"),
    "separator": (GOOD + 'separator = "|"', "column separator: '|'; expected comma or semicolon or tab or space"),
    "sides": (GOOD + 'sides = "mine"', "column sides: 'mine'; expected person or viewer"),
    "state": (GOOD + "states = { 0 = 2.0 }", "column states.0: 2.0; expected a confidence"),
    "state name": (GOOD + "states = { tracked = 1.0 }", "state 'tracked'"),
    "zeros": (GOOD + "zeros = 0", "column zeros: 0; expected missing or points"),
    "row no table": (GOOD + "row = 1", "column row: 1; expected tables [[row]]"),
    "row column": (ROW + 'before = ["clock"]', "column row 1.before: 'clock'; expected time, frame"),
    "row column twice": (ROW + 'before = ["time", "time"]', "column row 1.before: 'time' twice"),
    "row without x": (ROW + 'joint = ["y", "z"]', "column row 1.joint: 0 columns x"),
    "row key": (ROW + "befor = []", "column row 1.befor: unknown key (did you mean before?)"),
    "row order": (ROW + 'order = "x"', "column row 1.order: 'x'; expected joint or axis"),
    "row between": (ROW + "between = 1", "column row 1.per"),
    "columns joint": (ROW + 'columns = "nose.x nose.y"', "column row 1.columns: 'nose.x'"),
    "columns word": (ROW + 'columns = "clock"', "column row 1.columns: 'clock'"),
    "columns missing": (ROW + 'columns = "time head.x head.y"', "column row 1.columns: no left_shoulder.x"),
    "columns times": (ROW + 'columns = "many*-"', "column row 1.columns: 'many*-'"),
    "names": ("[names]\nleft_wrist = 3", "column names.left_wrist: 3"),
    "names joint": ('[names]\ntail = "T"', "column names.tail: 'tail'"),
    "no TOML": ("joints = [", "no TOML"),
    "no text": (b"\xff\xfe\x00", "bytes that are not UTF-8"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_key(write, mistake):
    content, words = MISTAKES[mistake]
    path = write(content)
    with pytest.raises(RecordingError) as caught:
        read_layout(path)
    assert str(caught.value).startswith(str(path)) and words in str(caught.value)
    assert "; expected " in str(caught.value) and "\n" not in str(caught.value)


def test_a_layout_that_is_not_there(tmp_path):
    with pytest.raises(RecordingError, match="no such file"):
        read_layout(tmp_path / "none.toml")
    with pytest.raises(RecordingError, match="cannot be read"):
        read_layout(tmp_path)


def _blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)


def test_the_worked_example_of_the_docs_reads_its_file(write):
    (toml,) = _blocks("toml")
    layout_path = write(toml, "lab.toml")
    layout = read_layout(layout_path)
    someone = person(50, 4)
    values = in_file(someone, layout.joints, 0.01, layout.axes)
    states = np.random.default_rng(0).choice([0.0, 1.0, 2.0], (50, len(layout)), p=[0.1, 0.3, 0.6])
    text = text_of(values, layout.rows[0], {"time": np.round(12040 + someone.times * 1000)}, states, ";")
    recording = load(write("LabTracker 3 export\n" + text, "lab.txt"), layout=layout_path)
    assert "LabTracker 3" in recording.reason and recording.frames == 50
    np.testing.assert_allclose(recording.motion.times, someone.times, atol=1e-3)
    for place, joint in enumerate(layout.columns):
        known = states[:, place] > 0.0
        np.testing.assert_allclose(recording.motion.track(joint)[known], someone.track(joint)[known], atol=1e-6)
        assert np.isnan(recording.motion.track(joint)[~known]).all()
        confidence = np.array([0.0, 0.4, 1.0])[states[:, place].astype(int)]
        np.testing.assert_array_equal(recording.motion.confidence[:, place], confidence)


def test_the_docs_know_every_key_and_every_layout(write):
    text = DOCS.read_text(encoding="utf-8")
    with pytest.raises(RecordingError) as caught:
        read_layout(write(GOOD + "nonsense = 1"))
    with pytest.raises(RecordingError) as of_row:
        read_layout(write(ROW + "nonsense = 1"))
    for error in (caught.value, of_row.value):
        assert all(f"| `{key}` |" in text for key in error.expected.split(", "))
    assert all(f"`{path.name}`" in text for path in FOLDER.glob("*.toml"))
    for joint in body.joints():
        part = joint.removeprefix("left_").removeprefix("right_")
        family = part.partition("_")[0] + "_"
        assert f"`{part}`" in text or f"`{family}`" in text, joint
