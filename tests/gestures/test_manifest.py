"""Manifests: what they say, and how they are refused."""

from __future__ import annotations

import tarfile
import zipfile
from pathlib import Path

import numpy as np
import pytest
from gestures.data_sets import holding, moving, write_person
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.gestures.evaluation.data_set import read_examples
from nao_sim.gestures.manifest import Manifest, Row, load_manifest, save_manifest
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.training_table import PATH as THESIS
from nao_sim.recordings import load

TEXT = st.text(st.characters(exclude_categories=("C", "Z"), include_characters=" ,;\"'#é"), max_size=12).map(str.strip)
TIMES = st.floats(0.0, 1e4, allow_subnormal=False)


@st.composite
def rows(draw: st.DrawFn) -> Row:
    start, end = sorted(draw(st.tuples(TIMES, TIMES)))
    given_times = (start, end) if start < end else (None, None)
    path = draw(st.sampled_from(["a.csv", "#b.csv", 'c "d", e.csv', "f g.csv"]))
    split = draw(st.sampled_from(["", "train", "test"]))
    return Row(path, *given_times, draw(TEXT), draw(TEXT), draw(st.sampled_from(["", "kinect_v2"])), split)


@given(found=st.lists(rows(), min_size=1, max_size=5, unique_by=lambda row: (row.path, row.start, row.end)))
def test_what_is_loaded_is_what_was_saved(tmp_path, found):
    for row in found:
        (tmp_path / row.path).touch()
    manifest = Manifest(tmp_path / "m.csv", tuple(found))
    save_manifest(manifest)
    loaded = load_manifest(manifest.path)
    assert loaded == manifest
    assert [row.line for row in loaded.rows] == list(range(2, len(found) + 2))


@pytest.fixture
def folder(tmp_path):
    write_person(holding("up", 1, seconds=2.0), tmp_path / "a.csv")
    (tmp_path / "broken.csv").write_text("hello\n", encoding="utf-8")
    (tmp_path / "robot.csv").write_text("time,HeadYaw_deg\n0,1\n1,2\n", encoding="utf-8")
    (tmp_path / "table.csv").write_bytes(THESIS.read_bytes())
    with zipfile.ZipFile(tmp_path / "packed.zip", "w") as packed:
        packed.write(tmp_path / "a.csv", "in/a.csv")
    return tmp_path


HEAD = "path,label,user,start,end,layout,split"
BAD = {  # the manifest, the blamed line, the column, and what the message says
    "no rows": (f"{HEAD}\n", 1, None, "no rows"),
    "no header": ("# nothing\n", None, None, "only blank lines"),
    "another header": ("a,b\n1,2\n", 1, None, "no column path, label, user"),
    "a missing column": ("path,label\na.csv,up\n", 1, None, "no column user"),
    "an unknown column": ("path,label,user,age\na.csv,up,ann,7\n", 1, "age", "unknown column"),
    "a column twice": ("path,label,user,user\na.csv,up,ann,ann\n", 1, "user", "twice"),
    "a cell too few": (f"{HEAD}\n\na.csv,up,ann\n", 3, None, "3 values"),
    "no path": (f"{HEAD}\n,up,ann,,,,\n", 2, "path", "an empty cell"),
    "no file": (f"{HEAD}\na.csv,up,ann,,,,\nb.csv,up,ann,,,,\n", 3, "path", "no such file"),
    "no number": (f"{HEAD}\na.csv,up,ann,soon,,,\n", 2, "start", "'soon'"),
    "a comma for a point": ("path;label;user;start\na.csv;up;ann;0,5\n", 2, "start", "decimal point"),
    "no finite number": (f"{HEAD}\na.csv,up,ann,,inf,,\n", 2, "end", "'inf'"),
    "an end before the start": (f"{HEAD}\na.csv,up,ann,1.5,1.0,,\n", 2, "end", "end 1"),
    "an unknown layout": (f"{HEAD}\na.csv,up,ann,,,octopus,\n", 2, "layout", "unknown layout 'octopus'"),
    "an unknown split": (f"{HEAD}\na.csv,up,ann,,,,both\n", 2, "split", "'both'"),
    "a stretch twice": (f"{HEAD}\na.csv,up,ann,,,,\na.csv,up,ann,,,,\n", 3, None, "as in line 2"),
    "two labels of a stretch": (f"{HEAD}\na.csv,up,ann,,,,\na.csv,down,ann,,,,\n", 3, None, "labelled up and down"),
    "open quotation marks": (f'{HEAD}\n"a.csv,up,ann,,,,\n', 2, None, "quotation marks"),
    "a start after the recording": (f"{HEAD}\na.csv,up,ann,7,,,\n", 2, "start", "7 is outside a.csv"),
    "an end after the recording": (f"{HEAD}\na.csv,up,ann,1,7,,\n", 2, "end", "7 is outside a.csv"),
    "a start before the recording": (f"{HEAD}\na.csv,up,ann,-1,1,,\n", 2, "start", "-1 is outside a.csv"),
    "a stretch between two frames": (f"{HEAD}\na.csv,up,ann,0.501,0.505,,\n", 2, "start", "no frame of a.csv"),
    "no label anywhere": (f"{HEAD}\na.csv,,ann,,,,\n", 2, "label", "no label"),
    "an unreadable recording": (f"{HEAD}\na.csv,up,ann,,,,\nbroken.csv,up,ann,,,,\n", 3, "path", "broken.csv"),
    "a robot's recording": (f"{HEAD}\nrobot.csv,up,ann,,,,\n", 2, "path", "robot's joint angles"),
    "a posture that is not there": (f"{HEAD}\ntable.csv,,ann,1,99,,\n", 2, "end", "99"),
    "half a posture": (f"{HEAD}\ntable.csv,,ann,1.5,2,,\n", 2, "start", "1.5"),
    "no member of an archive": (f"{HEAD}\npacked.zip/b.csv,up,ann,,,,\n", 2, "path", "not in packed.zip"),
    "a file taken for an archive": (f"{HEAD}\na.csv/b.csv,up,ann,,,,\n", 2, "path", "cannot be unpacked"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_line_is_named_with_what_was_found_and_expected(folder, case):
    text, line, column, said = BAD[case]
    (folder / "m.csv").write_text(text, encoding="utf-8")
    with pytest.raises(RecordingError) as caught:
        read_examples(load_manifest(folder / "m.csv"))
    assert (caught.value.line, caught.value.column) == (line, column)
    message = str(caught.value)
    assert message.startswith(str(folder / "m.csv")) and said in message and "; expected " in message
    assert "\n" not in message


@pytest.mark.parametrize("content", [b"", b"\x00\x01", b"\xff\xfe\x00"])
def test_what_is_no_text_is_refused(tmp_path, content):
    (tmp_path / "m.csv").write_bytes(content)
    with pytest.raises(RecordingError, match=r"m\.csv"):
        load_manifest(tmp_path / "m.csv")
    with pytest.raises(RecordingError, match="a folder"):
        load_manifest(tmp_path)


def test_rows_cut_the_recording_and_it_is_read_once(folder, monkeypatch):
    calls = []
    real = read_examples.__globals__["read"]
    monkeypatch.setitem(read_examples.__globals__, "read", lambda source: calls.append(source) or real(source))
    (folder / "m.csv").write_text(f"{HEAD}\na.csv,up,ann,0.5,1.0,,\na.csv,none,bob,1.2,,,\n", encoding="utf-8")
    first, second = read_examples(load_manifest(folder / "m.csv")).examples
    assert (first.label, first.user, second.label, second.user) == ("up", "ann", NONE, "bob")
    assert first.known and not second.known and len(calls) == 1
    assert first.person.times[0] >= 0.5 and first.person.times[-1] <= 1.0 and len(first.person) == 16
    whole = load(folder / "a.csv").motion
    assert np.array_equal(first.person.positions, whole.positions[15:31])


def test_a_table_of_postures_has_labels_and_rows_of_its_own(folder):
    (folder / "m.csv").write_text(f"{HEAD}\ntable.csv,,ann,1,5,,\ntable.csv,,bob,6,,,\n", encoding="utf-8")
    data = read_examples(load_manifest(folder / "m.csv"))
    assert data.labels == ("down", "forward", "piUp", "side", "up") and len(data.examples) == 28
    assert [each.user for each in data.examples].count("ann") == 5
    assert all(each.held and not each.moves and len(each.pose) == 1 for each in data.examples)


@pytest.mark.parametrize("kind", ["zip", "tar", "tar.xz", "tar.gz"])
def test_a_recording_in_an_archive_is_the_one_outside(folder, kind):
    name = folder / f"set.{kind}"
    if kind == "zip":
        with zipfile.ZipFile(name, "w") as packed:
            packed.write(folder / "a.csv", "deep/in/a.csv")
    else:
        with tarfile.open(name, f"w:{kind.partition('.')[2]}") as packed:
            packed.add(folder / "a.csv", "./deep/in/a.csv")
    (folder / "m.csv").write_text(f"{HEAD}\n{name.name}/deep/in/a.csv,up,ann,,,,\na.csv,up,ann,,,,\n", "utf-8")
    one, other = read_examples(load_manifest(folder / "m.csv")).examples
    assert np.array_equal(one.person.positions, other.person.positions)


def test_a_member_of_an_archive_stays_in_the_folder_that_is_unpacked_to(folder):
    outside = folder / "evil.csv"
    with tarfile.open(folder / "evil.tar", "w") as packed:
        packed.add(folder / "a.csv", "../evil.csv")
    (folder / "m.csv").write_text(f"{HEAD}\nevil.tar/../evil.csv,up,ann,,,,\n", encoding="utf-8")
    assert len(read_examples(load_manifest(folder / "m.csv")).examples) == 1
    assert not outside.exists()


def test_unreadable_recordings_are_left_out_only_where_that_is_asked_for(folder):
    (folder / "m.csv").write_text(f"{HEAD}\na.csv,up,ann,,,,\nbroken.csv,up,ann,,,,\n", encoding="utf-8")
    data = read_examples(load_manifest(folder / "m.csv"), skip_unreadable=True)
    assert len(data.examples) == 1 and len(data.skipped) == 1
    assert "line 3" in data.skipped[0] and "broken.csv" in data.skipped[0]
    (folder / "m.csv").write_text(f"{HEAD}\nbroken.csv,up,ann,,,,\n", encoding="utf-8")
    with pytest.raises(RecordingError):
        read_examples(load_manifest(folder / "m.csv"), skip_unreadable=True)


def test_pictures_are_examples_of_their_own(tmp_path):
    person = moving("clap", 1)
    pictures = type(person)(np.arange(len(person)) * 0.7, person.positions, person.joints)
    write_person(pictures, tmp_path / "p.csv")
    (tmp_path / "m.csv").write_text("path,label,user\np.csv,clap,\n", encoding="utf-8")
    examples = read_examples(load_manifest(Path(tmp_path / "m.csv"))).examples
    assert len(examples) == len(person) and all(len(each.person) == 1 and each.held for each in examples)
