"""Every command that README.md and docs/ show runs, and prints what is shown below it."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from tests.docs.shown import DOCUMENTS, ROOT, Folder, agrees, blocks, steps, tidy
from tests.docs.stand_ins import elsewhere
from tests.pictures import needs_gl

WITH_STEPS = [path for path in DOCUMENTS if any(not elsewhere(step) for step in steps(path))]
WITH_CODE = [path for path in DOCUMENTS if any(blocks(path.read_text(encoding="utf-8"), "python"))]
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
    for step in steps(document):
        if elsewhere(step):
            continue
        status, printed = folder.run(step)
        if "\nnao-sim: " in f"\n{step.shown}":
            allowed = {BAD_INPUT}
        else:
            allowed = {DONE, MADE_SAFE} if " check " in step.command else {DONE}
        assert status in allowed, f"{step}\n{printed}"
        if step.shown is not None:
            assert agrees(step.shown, printed), f"{step}\n{tidy(printed)}\nis not\n{tidy(step.shown)}"


@needs_gl
@pytest.mark.parametrize("document", WITH_CODE, ids=name)
def test_the_python_of_a_document_runs(document, tmp_path, monkeypatch, capsys):
    Folder(tmp_path)
    monkeypatch.chdir(tmp_path)
    space: dict[str, object] = {}
    for block in blocks(document.read_text(encoding="utf-8"), "python"):
        code = block["text"].replace("fps=50)", 'fps=2, size=(64, 48), quality="draft")')
        exec(compile(code, name(document), "exec"), space)  # one document, one story


def test_outputs_are_compared_by_whole_lines():
    assert agrees("a 1\n...\nz\n", "a 1  \nb\nc\nz\n") and agrees("took … s\n", "took 3.5 s\n")
    assert agrees("a\n...\n", "a\n")
    assert not agrees("a\n", "a\nb\n") and not agrees("a\n...\n", "b\na\n") and not agrees("a 1\n", "a 2\n")
