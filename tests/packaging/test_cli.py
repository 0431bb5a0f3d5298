"""The command line's outline: what it imports, and how errors end."""

from __future__ import annotations

import subprocess
import sys
from types import SimpleNamespace

import pytest

import nao_sim
from nao_sim import cli
from nao_sim.errors import NaoSimError, RecordingError, RenderingError

HEAVY = {"mujoco", "dm_control", "scipy", "sklearn", "av", "imageio", "matplotlib"}


def offer(monkeypatch: pytest.MonkeyPatch, function: object) -> None:
    """Make `function` the command `play`."""
    monkeypatch.setattr(cli, "import_module", lambda _: SimpleNamespace(play=function))


@pytest.mark.parametrize("code", ["import nao_sim", "from nao_sim.cli import main; main(['--help'])"])
def test_package_and_help_import_nothing_heavy(code: str) -> None:
    script = f"{code}\nimport sys; print('modules', *sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert HEAVY.isdisjoint(done.stdout.splitlines()[-1].split())


def test_a_replay_without_gestures_imports_none_of_their_room() -> None:
    script = "import nao_sim.replay, sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = done.stdout.split()
    assert not [name for name in loaded if name.startswith("nao_sim.gestures")]
    assert {"scipy", "sklearn"}.isdisjoint(loaded)


@pytest.mark.parametrize("words", [[], ["--help"], ["-h"]])
def test_help_lists_every_command(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(words) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in cli.COMMANDS)


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--version"]) == 0
    assert capsys.readouterr().out == f"nao-sim {nao_sim.__version__}\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--foo"], "nao-sim: No such option: --foo; see nao-sim --help\n"),
        (["plya"], "nao-sim: No such command 'plya'; see nao-sim --help\n"),
        (["play", "--foo"], "nao-sim play: No such option: --foo; see nao-sim play --help\n"),
        (["play", "--speed", "fast"], "nao-sim play: Invalid value for '--speed'"),
    ],
)
def test_words_it_does_not_know_are_one_line_and_status_2(
    words: list[str], message: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def play(speed: float = 1.0) -> None:
        """Play."""

    offer(monkeypatch, play)
    assert cli.main(words) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(message)
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("error", "status"),
    [(RecordingError("a.csv", "no header", "a header", line=1), 2), (RenderingError("two\nlines"), 3)],
)
def test_an_error_of_the_family_is_one_line_and_its_status(
    error: NaoSimError, status: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def play() -> None:
        raise error

    offer(monkeypatch, play)
    assert cli.main(["play"]) == status
    out, err = capsys.readouterr()
    assert (out, err) == ("", f"nao-sim: {str(error).replace(chr(10), ' ')}\n")


def test_ctrl_c_ends_with_130_and_without_a_word(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def play() -> None:
        raise KeyboardInterrupt

    offer(monkeypatch, play)
    assert cli.main(["play"]) == 130
    assert capsys.readouterr() == ("", "")


def test_any_other_exception_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def play() -> None:
        raise ZeroDivisionError

    offer(monkeypatch, play)
    with pytest.raises(ZeroDivisionError):
        cli.main(["play"])


def test_a_commands_own_status_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    def play() -> None:
        raise cli.typer.Exit(4)

    offer(monkeypatch, play)
    assert cli.main(["play"]) == 4
