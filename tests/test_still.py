"""Pictures of single moments."""

from __future__ import annotations

import signal
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from nao_sim.cli import main
from nao_sim.moments import key_poses
from nao_sim.simulation.rollout import Rollout
from tests.pictures import needs_gl

NOD = "time,HeadPitch\n0,0\n0.4,15\n0.8,0\n"
PLAIN = ["--unit", "deg", "--size", "64x48", "--quality", "draft"]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder with a short nod in it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    Path("nod.csv").write_text(NOD, encoding="utf-8")


@given(st.integers(1, 12), st.lists(st.integers(0, 5), min_size=1, max_size=30))
def test_key_poses_are_different_in_order_and_as_many_as_asked_for(count, which):
    kinds = np.random.default_rng(0).uniform(-1.0, 1.0, (6, 26))
    poses = kinds[which]
    chosen = key_poses(poses, count)
    assert list(chosen) == sorted(set(chosen)) and len(chosen) == min(count, len(set(which)))
    assert len({which[place] for place in chosen}) == len(chosen)


@needs_gl
def test_a_still_is_the_films_frame_at_that_moment():
    assert main(["play", "nod.csv", *PLAIN, "--fps", "10", "--video", "f.png", "--rollout", "o.npz", "-q"]) == 0
    frames = sorted(Path("f").iterdir())
    start = Rollout.load("o.npz").motion_start
    number = int(np.ceil((start + 0.3) * 10))
    assert main(["still", "nod.csv", *PLAIN, "--at", str(number / 10 - start), "-o", "s.png", "-q"]) == 0
    still, frame = (np.asarray(Image.open(path)).astype(int) for path in ("s.png", frames[number]))
    assert np.abs(still - frame).max() <= 2
    assert np.abs(still - np.asarray(Image.open(frames[0]))).max() > 20


@needs_gl
def test_a_sheet_has_as_many_pictures_as_asked_for(capsys):
    assert main(["still", "nod.csv", *PLAIN, "--sheet", "3", "-o", "s.png"]) == 0
    assert capsys.readouterr().out == "picture  s.png\n"
    with Image.open("s.png") as image:
        assert image.size[0] > 2 * 64 and image.size[1] > 2 * 48


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--at", "1", "--sheet", "2"], "contradict each other"),
        (["--at", "-1"], "--at -1: expected seconds"),
        (["--at", "nan"], "--at nan: expected seconds"),
        (["--sheet", "0"], "--sheet 0: expected 1 to 100"),
        (["-o", "s.mp4"], r"s.mp4: cannot write '.mp4' pictures; expected .png"),
        (["--camera", "best"], "camera 'best' is not known"),
        (["--size", "big"], "--size big: expected WIDTHxHEIGHT"),
    ],
)
def test_what_cannot_be_is_said_in_one_line_before_any_work(capsys, words, said):
    assert main(["still", "nod.csv", "--unit", "deg", *words]) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1
    assert [path.name for path in Path().iterdir()] == ["nod.csv"]


@needs_gl
def test_a_moment_after_the_end_is_refused_with_how_long_it_lasts(capsys):
    assert main(["still", "nod.csv", *PLAIN, "--at", "99", "-o", "s.png"]) == 2
    assert "--at 99: after the end of the recording; expected 0 to" in capsys.readouterr().err
    assert not Path("s.png").exists()
