"""Every command and all Python that README.md and docs/ show runs, and prints what is shown below it."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from tests.docs.shown import DOCUMENTS, ROOT, Folder, agrees, tidy, to_run
from tests.pictures import needs_gl

WITH_STEPS = [path for path in DOCUMENTS if to_run(path)]
DONE, MADE_SAFE, BAD_INPUT = 0, 1, 2


def name(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.fixture(autouse=True)
def signals_stay(monkeypatch):
    monkeypatch.setattr(signal, "signal", lambda *_: None)


@needs_gl
@pytest.mark.parametrize("document", WITH_STEPS, ids=name)
def test_every_command_of_a_document_runs_and_prints_what_is_shown(document, tmp_path):
    folder = Folder(tmp_path)
    for step in to_run(document):
        status, printed = folder.run(step)
        if "\nnao-sim: " in f"\n{step.shown}":
            allowed = {BAD_INPUT}
        else:
            allowed = {DONE, MADE_SAFE} if " check " in step.command else {DONE}
        assert status in allowed, f"{step}\n{printed}"
        if step.shown:
            assert agrees(step.shown, printed), f"{step}\n{tidy(printed)}\nis not\n{tidy(step.shown)}"


def test_outputs_are_compared_by_whole_lines():
    assert agrees("a 1\n...\nz\n", "a 1  \nb\nc\nz\n") and agrees("took … s\n", "took 3.5 s\n")
    assert agrees("a\n...\n", "a\n")
    assert not agrees("a\n", "a\nb\n") and not agrees("a\n...\n", "b\na\n") and not agrees("a 1\n", "a 2\n")


def test_numbers_may_round_otherwise_and_no_more():
    assert agrees("2.0° in 463 steps\n", "1.9° in 460 steps\n")
    assert not agrees("1.4°\n", "2.0°\n") and not agrees("0 violations\n", "1 violations\n")
    assert not agrees("12 a\n", "a\n") and not agrees("5 of 6\n", "5 of 7\n")
