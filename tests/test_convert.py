"""The command `convert`: words in, lines out, exit status."""

import pytest

from nao_sim.cli import main
from nao_sim.recordings import load


@pytest.fixture
def wave(tmp_path):
    path = tmp_path / "wave.csv"
    path.write_text("time,HeadYaw_deg,LHand\n0,1,0\n0.0101,2,1\n")
    return path


def test_it_says_what_it_read_wrote_and_lost(wave, tmp_path, capsys):
    target = tmp_path / "wave.motion"
    assert main(["convert", str(wave), str(target)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        f"read     {wave}: joint-angle CSV, 2 frames, 0.01 s",
        f"written  {target}: Webots motion, 2 frames, 0.01 s",
        "lost     times moved by up to 0.1 ms",
    ]
    assert load(target).frames == 2


def test_nothing_lost_is_said_and_quiet_says_nothing(wave, tmp_path, capsys):
    assert main(["convert", str(wave), str(tmp_path / "a.npz")]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "lost     nothing"
    assert main(["convert", str(wave), str(tmp_path / "b.npz"), "--quiet"]) == 0
    assert capsys.readouterr().out == ""


def test_unit_and_rate_are_passed_on_and_notes_are_printed(tmp_path, capsys):
    bare = tmp_path / "bare.csv"
    bare.write_text("HeadYaw\n10\n20\n")
    assert main(["convert", str(bare), str(tmp_path / "out.py"), "--unit", "deg", "--rate", "10"]) == 0
    assert "note: no time column: 10 frames a second, as told" in capsys.readouterr().out
    assert load(tmp_path / "out.py").motion.times.tolist() == [0.0, 0.1]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["wave.csv", "wave.csv"], "would overwrite the recording"),
        (["wave.csv", "out.xar"], "extension '.xar' is not one that is written"),
        (["none.csv", "out.npz"], "no such file"),
        (["wave.csv"], "Missing argument"),
    ],
)
def test_a_mistake_is_one_line_and_status_2(wave, tmp_path, monkeypatch, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    assert main(["convert", *words]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and message in err
    assert [path.name for path in tmp_path.iterdir()] == ["wave.csv"]
