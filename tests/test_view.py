"""`nao-sim view` from the outside."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from nao_sim.cli import main
from nao_sim.viewing.keys import KEYS


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """An empty folder without a display, with a short motion that is safe, one that is damaged, and none."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)  # the test runner keeps its own handlers
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    rows = [f"{0.05 * frame:.2f},{80.0 - 0.5 * frame}" for frame in range(10)]
    Path("safe.csv").write_text("\n".join(["time,LShoulderPitch_deg", *rows]) + "\n", encoding="utf-8")
    Path("damaged.csv").write_text("time,LShoulderPitch_deg\n0.0,oops\n", encoding="utf-8")
    Path("empty.csv").write_text("", encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["missing.csv", "--export", "p.html"], "missing.csv"),
        (["damaged.csv", "--export", "p.html"], "damaged.csv, line 2"),
        (["empty.csv", "--export", "p.html"], "empty.csv"),
        (["safe.csv", "--export", "p.html", "--match", "hands"], "--match hands"),
        (["safe.csv", "--export", "p.html", "--look", "moon"], "look 'moon' is not known"),
        (["safe.csv", "--export", "p.html", "--theme", "moon"], "theme 'moon' is not known"),
        (["safe.csv", "--export", "p.html", "--web"], "--web and --export contradict each other"),
        (["safe.csv", "--export", "p.pdf"], "expected a name that ends in .html"),
        (["safe.csv", "--port", "80"], "expected --web with it"),
        (["safe.csv", "--web", "--port", "70000"], "expected 0 to 65535"),
        (["safe.csv", "--web", "--host", ""], "--host"),
        (["safe.csv", "--web", "--host", "no such host", "--port", "0"], "--host no such host"),
        (["safe.csv", "--speed", "nan", "--web"], "--speed"),
    ],
)
def test_what_cannot_be_is_one_line_and_status_2_and_nothing_is_written(words, message, capsys):
    before = sorted(Path().iterdir())
    assert main(["view", *words]) == 2
    out, err = capsys.readouterr()
    assert message in err and err.count("\n") == 1 and out == "" and sorted(Path().iterdir()) == before


def test_without_a_display_one_line_says_how_else_to_look_and_the_status_is_3(capsys):
    assert main(["view", "safe.csv"]) == 3
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and "there is no display" in err and "--web" in err and "--export" in err


def test_an_export_writes_one_page_and_says_where(capsys):
    assert main(["view", "safe.csv", "--export", "pages/safe.html"]) == 0
    out, _ = capsys.readouterr()
    assert "pages/safe.html" in out and "asked" in out and "took" not in out
    assert [path.name for path in Path("pages").glob("[!.]*")] == ["safe.html"]
    assert Path("pages/safe.html").read_bytes().startswith(b"<!doctype html>")


def test_help_tells_every_key(capsys):
    assert main(["view", "--help"]) == 0
    out = capsys.readouterr().out
    assert all(f"{key.name:<5}" in out and key.does in out for key in KEYS)
