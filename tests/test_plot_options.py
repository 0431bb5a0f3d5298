"""`--plot`, `--plot-size` and `--html`: the same on every command, and checked before any work."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from nao_sim import options
from nao_sim.cli import COMMANDS, main
from nao_sim.paths import TRAJECTORIES

WAVE, PERSON = str(TRAJECTORIES / "wave.csv"), str(TRAJECTORIES / "person_wave.csv")
NO_PLOT = {"still", "view", "live", "formats", "dictionary", "doctor"}  # they show all themselves, or have nothing to
WORDS = {
    "play": [WAVE], "check": [WAVE], "retarget": [PERSON, "-o", "a.csv"], "convert": [WAVE, "a.csv"],
    "inspect": [WAVE], "compare": [WAVE, WAVE], "teach": ["wave", PERSON, "--into", "a.vocab"], "recognise": [PERSON],
    "train": ["a.csv", "-o", "a.vocab"], "evaluate": ["a.csv"], "reproduce": [],
}  # fmt: skip
HTML = ("play", "check", "compare", "recognise", "evaluate")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)  # the test runner keeps its own handlers
    monkeypatch.setenv("COLUMNS", "200")


def test_every_command_that_has_something_to_show_can_draw_it(capsys):
    told = set()
    for name in COMMANDS:
        assert main([name, "--help"]) == 0
        out = capsys.readouterr().out
        lines = [
            " ".join(line.strip("│ ").split()) for line in out.splitlines() if line.strip("│ ").startswith("--plot")
        ]
        assert bool(lines) == (name in WORDS) == (name not in NO_PLOT), name
        assert ("--html" in out) == (name in HTML), name
        told |= {line for line in lines if line.startswith("--plot ")}
    assert len(told) == 1 and ".svg" in told.pop()


@pytest.mark.parametrize("name", list(WORDS))
def test_a_picture_of_no_kind_is_refused_before_any_work(name, capsys):
    assert main([name, *WORDS[name], "--plot", "a.bmp"]) == 2
    assert "--plot a.bmp: expected a name that ends in .png, .svg or .pdf" in capsys.readouterr().err
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize("name", HTML)
def test_a_page_of_no_kind_is_refused_before_any_work(name, capsys):
    assert main([name, *WORDS[name], "--html", "a.pdf"]) == 2
    assert "--html a.pdf: expected a name that ends in .html or .htm" in capsys.readouterr().err
    assert list(Path().iterdir()) == []


def test_a_check_has_a_page_that_names_no_folder(tmp_path):
    rows = [f"{0.05 * frame:.2f},{80 + 5.0 * frame}" for frame in range(12)]
    recording = tmp_path / "<b>&amp;.csv"
    recording.write_text("\n".join(["time,LShoulderPitch_deg", *rows]) + "\n", encoding="utf-8")
    assert main(["check", str(recording), "-q", "--html", "page/a.html"]) == 1
    text = Path("page/a.html").read_text(encoding="utf-8")
    assert "<h1>&lt;b&gt;&amp;amp;.csv, by a simulated NAO</h1>" in text and str(tmp_path) not in text
    assert "Made safe" in text and "beyond the joint&#39;s limit" in text and text.count("<svg") >= 4
    assert "nao-sim check &#39;&lt;b&gt;&amp;amp;.csv&#39; --html a.html --quiet" in text


def test_two_recordings_have_no_page(capsys):
    assert main(["check", WAVE, PERSON, "--html", "a.html"]) == 2
    assert "--html a.html: shows one recording, and 2 are given" in capsys.readouterr().err


def test_a_page_that_would_overwrite_the_recording_is_refused(capsys):
    Path("a.html").write_text("time,HeadYaw_deg\n0,0\n", encoding="utf-8")
    assert main(["check", "a.html", "--html", "a.html"]) == 2
    assert "would overwrite the recording" in capsys.readouterr().err


def test_the_pages_of_comparison_and_recognition_are_written(tmp_path):
    assert main(["compare", WAVE, WAVE, "--html", "c.html", "--plot", "c.pdf", "--plot-size", "column"]) == 0
    assert main(["recognise", PERSON, "-q", "--html", "r.html"]) == 0
    assert "How alike the robot was" in Path("c.html").read_text(encoding="utf-8")
    page = Path("r.html").read_text(encoding="utf-8")
    assert '<th scope="row">right_piUp</th>' in page and str(TRAJECTORIES) not in page


def test_one_frame_can_be_drawn_as_anything(tmp_path):
    Path("one.csv").write_text("time,HeadYaw_deg,LShoulderPitch_deg\n0,3,70\n", encoding="utf-8")
    for name, words in {"inspect": ["one.csv"], "compare": ["one.csv", "one.csv"], "check": ["one.csv"]}.items():
        assert main([name, *words, "--plot", f"{name}.svg"]) in (0, 1)
        assert Path(f"{name}.svg").stat().st_size > 1000


def test_the_word_of_a_file_is_its_name():
    assert options._word(Path("/home/anna/a.csv")) == "a.csv" and options._word("640x480") == "640x480"
