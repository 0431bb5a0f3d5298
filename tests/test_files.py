"""Files appear whole or not at all."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from nao_sim.errors import UsageError
from nao_sim.files import beside


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit])
def test_after_any_end_but_success_the_old_file_stays_alone(tmp_path, error):
    target = tmp_path / "a.json"
    target.write_text("old")
    with pytest.raises(error), beside(target) as draft:
        draft.write_text("half")
        raise error
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]


def test_drafts_of_killed_processes_are_cleared_and_others_left(tmp_path):
    gone = subprocess.Popen([sys.executable, "-c", "pass"])
    gone.wait()
    abandoned = tmp_path / f".a-{gone.pid}.mp4"
    mine, other, named = (tmp_path / name for name in (f".a-{os.getppid()}.mp4", f".b-{gone.pid}.mp4", ".a-notes.mp4"))
    for path in (abandoned, mine, other, named):
        path.write_text("")
    with beside(tmp_path / "a.mp4") as draft:
        draft.write_text("new")
    assert not abandoned.exists()
    assert mine.exists()
    assert other.exists()
    assert named.exists()


def test_a_folder_that_is_not_there_is_told(tmp_path):
    with (
        pytest.raises(UsageError, match=r"a\.json: cannot write there: No such file"),
        beside(tmp_path / "x" / "a.json"),
    ):
        pytest.fail("must not get here")
