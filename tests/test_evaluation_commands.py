"""evaluate, train and recognise from the outside."""

from __future__ import annotations

import csv
import io
import json
import signal
from pathlib import Path

import numpy as np
import pytest
from gestures.data_sets import holding, moving, write_person, write_set

from nao_sim.cli import main
from nao_sim.gestures.gesture_stream import stream_gestures
from nao_sim.gestures.storage import load_vocabulary
from nao_sim.gestures.vocabulary import built_in
from nao_sim.motion import Skeleton
from nao_sim.recordings import load


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)


def refused(words: list[str], said: str, capsys) -> None:
    """One line on stderr, exit status 2, and nothing written that was not there."""
    before = sorted(Path().rglob("*"))
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("nao-sim: ") and err.count("\n") == 1
    assert said in err
    assert sorted(Path().rglob("*")) == before


def as_csv(vocabulary, person: Skeleton) -> list[list[str]]:
    found = stream_gestures(vocabulary, person)
    return [[f"{each.time:.6g}", each.label, f"{each.confidence:.4f}", f"{each.since:.6g}"] for each in found]


def rows_of(text: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text)))


def test_evaluate_writes_what_it_prints_and_the_same_again(capsys):
    write_set(Path(), ("wave", "side", "none"), range(2))
    texts = []
    for folder in ("one", "two"):
        assert main(["evaluate", "gestures.csv", "-o", folder, "--learner", "k-NN"]) == 0
        report = json.loads(Path(folder, "evaluation.json").read_text(encoding="utf-8"))
        report.pop("timing")
        pictures = [Path(folder, name).read_bytes() for name in sorted(f.name for f in Path(folder).glob("*.png"))]
        texts.append((report, pictures))
    assert texts[0] == texts[1] and len(texts[0][1]) == 5
    out = capsys.readouterr().out
    page = Path("one/evaluation.md").read_text(encoding="utf-8")
    assert "Poses by k-NN" in out and "## Movements by nao_sim: each gesture" in page
    for picture in Path("one").glob("*.png"):
        assert f"({picture.name})" in page
    assert texts[0][0]["poses"]["nao_sim"]["accuracy"] == {"right": 2, "count": 2, "share": 1.0,
                                                          "interval": [0.34238, 1.0]}  # fmt: skip


def test_train_and_recognise_give_what_the_stream_gives(capsys):
    write_set(Path(), ("wave", "clap", "side"), range(3))
    assert main(["train", "gestures.csv", "-o", "my.vocab"]) == 0
    out = capsys.readouterr().out
    assert "100.0 %" in out and "nao-sim recognise FILE --vocabulary my.vocab" in out and "as in side_" in out
    vocabulary = load_vocabulary(Path("my.vocab"))
    assert vocabulary.names == ("side", "clap", "wave")
    assert len(vocabulary.motions["side"]) == 1 and len(vocabulary.motions["wave"]) > 1
    write_person(moving("wave", 7), Path("new.csv"))
    words = ["recognise", "new.csv", "--model", "my.vocab", "--plot", "new.png", "--json", "new.json"]
    assert main([*words, "-o", "labels.csv"]) == 0
    shown = capsys.readouterr().out
    assert "wave" in shown and "new.png" in shown and Path("new.png").read_bytes().startswith(b"\x89PNG")
    written = Path("labels.csv").read_text(encoding="utf-8")
    head, *rows = rows_of(written)
    assert head == ["time", "label", "confidence", "since"]
    assert rows == as_csv(vocabulary, load("new.csv").motion)
    told = json.loads(Path("new.json").read_text(encoding="utf-8"))
    assert [each["label"] for each in told["segments"]] == ["wave"]
    assert main(["recognise", "new.csv", "--model", "my.vocab", "-o", "-"]) == 0
    assert capsys.readouterr().out == written


def test_recognise_knows_the_thesis_poses_by_itself(capsys):
    person = holding("piUp", 3)
    write_person(person, Path("new.csv"))
    assert main(["recognise", "new.csv", "-o", "-"]) == 0
    rows = rows_of(capsys.readouterr().out)[1:]
    assert rows == as_csv(built_in(), load("new.csv").motion) and rows[-1][1] == "piUp"
    assert main(["recognise", "new.csv", "--quiet"]) == 0
    assert capsys.readouterr().out == ""


def test_where_nothing_is_recognised_that_is_said_and_drawn(capsys):
    person = holding("piUp", 3)
    write_person(Skeleton(person.times[:2], person.positions[:2], person.joints), Path("short.csv"))
    assert main(["recognise", "short.csv", "--plot", "short.png"]) == 0
    assert "none recognised of down, forward" in capsys.readouterr().out and Path("short.png").is_file()


@pytest.mark.parametrize("command", [["evaluate"], ["train", "-o", "my.vocab"]])
def test_bad_manifests_end_in_one_line(command, capsys):
    write_set(Path(), ("side",), range(2))
    name, *rest = command
    refused([name, "nothing.csv", *rest], "nothing.csv: no such file", capsys)
    Path("m.csv").write_text("path,label,user\nside_0.csv,side,a\nside_9.csv,side,b\n", encoding="utf-8")
    refused([name, "m.csv", *rest], "m.csv, line 3, column path: no such file", capsys)


def test_bad_words_end_in_one_line(capsys):
    write_set(Path(), ("side",), range(2))
    refused(["recognise", "side_0.csv", "--plot", "a.mp3"], "--plot a.mp3", capsys)
    refused(["recognise", "side_0.csv", "-o", "-", "--json", "-"], "-o - and --json -", capsys)
    refused(["recognise", "side_0.csv", "-o", "side_0.csv"], "would overwrite", capsys)
    refused(["recognise", "side_0.csv", "--model", "side_1.csv"], "side_1.csv", capsys)
    refused(["recognise", "gone.csv"], "gone.csv: no such file", capsys)
    Path("robot.csv").write_text("time,HeadYaw_deg\n0,1\n1,2\n", encoding="utf-8")
    refused(["recognise", "robot.csv"], "robot's joint angles", capsys)
    refused(["train", "gestures.csv", "-o", "gestures.csv"], "would overwrite", capsys)
    for words in (["train", "gestures.csv"], ["recognise", "side_0.csv"]):
        refused([*words, "-o", "gestures.csv/new"], "gestures.csv: cannot make this folder", capsys)


def test_a_single_user_is_learned_from_and_that_is_said(capsys):
    write_set(Path(), ("side", "up"), range(1))
    assert main(["train", "gestures.csv", "-o", "my.vocab", "--no-motions"]) == 0
    assert "takes two users or more" in capsys.readouterr().out
    assert set(load_vocabulary(Path("my.vocab")).motions) == {"side", "up"}  # those that come with nao-sim
    assert np.isfinite(load_vocabulary(Path("my.vocab")).poses.means).all()
