"""`nao-sim live` refuses what cannot work in one line, before anything starts."""

from __future__ import annotations

import signal

import pytest

from nao_sim.cli import main


@pytest.fixture(autouse=True)
def own_handlers(monkeypatch):
    monkeypatch.setattr(signal, "signal", lambda *_: None)  # the test runner keeps its own handlers


def _refusal(capsys, *words: str) -> str:
    assert main(["live", *words]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.splitlines()) == 1
    return err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--loop"], "expected --replay FILE with it"),
        (["--record", "nowhere/out.csv"], "a folder that is there"),
        (["--record", "out.json"], "ends in .csv"),
        (["--layout", "xbox"], "expected one of azure_kinect"),
        (["--replay", "nothing.csv"], "nothing.csv"),
        (["--port", "70000"], "less than or equal to 65535"),
        (["--max-speed", "7"], "expected a share"),
    ],
)
def test_options_that_cannot_be_honoured_are_one_line_and_status_2(capsys, words, said):
    assert said in _refusal(capsys, *words)
