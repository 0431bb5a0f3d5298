"""`./run`, with an interpreter that answers questions truly but only pretends to install."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ("bash", "cat", "cksum", "dirname", "env", "find", "ln", "mkdir", "readlink", "rm", "sh", "sleep", "tail")

FAKE_PYTHON = r"""#!/bin/sh
# FAKE_VERSION, FAKE_NO_VENV, FAKE_GL, FAKE_PIP: what this interpreter, its graphics and its pip are like.
real='{real}'
case $1 in
-c)
    case $2 in *choose_backend*)
        echo probe >>"$FAKE_LOG"
        [ -e "$FAKE_GL_FILE" ]
        exit ;;
    esac
    exec "$real" -I -c '
import importlib.util, os, sys
sys.executable = sys.argv[2]
sys.version_info = tuple(map(int, os.environ.get("FAKE_VERSION", "3.12.1").split(".")))
if os.environ.get("FAKE_NO_VENV"):
    importlib.util.find_spec = lambda name: None
exec(sys.argv[1])' "$2" "$0" ;;
-m)
    shift
    echo "$@" >>"$FAKE_LOG"
    case $1 in
    venv)
        mkdir -p "$2/bin"
        ln -s "$0" "$2/bin/python"
        printf '#!/bin/sh\necho "in $(pwd)"\nfor word do echo "word $word"; done\nexit ${{FAKE_PLAY:-0}}\n' \
            >"$2/bin/nao-sim"
        printf '#!/bin/sh\necho "ruff $* in $(pwd)"\nexit ${{FAKE_RUFF:-0}}\n' >"$2/bin/ruff"
        printf '#!/bin/sh\necho "mypy $*"\n' >"$2/bin/mypy"
        "$real" -I -c 'import os, sys; [os.chmod(p, 0o755) for p in sys.argv[1:]]' \
            "$2/bin/nao-sim" "$2/bin/ruff" "$2/bin/mypy" ;;
    pip)
        sleep "${{FAKE_PIP_TIME:-0}}"
        [ -z "${{FAKE_PIP:-}}" ] || echo "ERROR: no such package"
        exit ${{FAKE_PIP:-0}} ;;
    pytest)
        echo "=== closing line ==="
        exit ${{FAKE_PYTEST:-0}} ;;
    esac ;;
esac
"""


@dataclass
class Machine:
    """A folder with spaces that holds a checkout, a PATH with nothing but fakes and a few tools, and their trace."""

    home: Path
    environment: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.repo = self.home / "my robots" / "nao sim"
        self.bin = self.home / "bin"
        self.log = self.home / "log"
        self.gl = self.home / "gl works"
        (self.repo / ".ci").mkdir(parents=True)
        self.bin.mkdir()
        self.gl.touch()
        for name in ("run", ".ci/run", "pyproject.toml"):
            shutil.copy(ROOT / name, self.repo / name)
        (self.repo / "requirements.lock").write_text("numpy==2.4.6\n")
        for name in TOOLS:
            tool = shutil.which(name)
            assert tool, name
            (self.bin / name).symlink_to(tool)
        self.command("id", "echo 1000")
        self.python("python3")

    def command(self, name: str, body: str) -> Path:
        path = self.bin / name
        path.write_text(f"#!/bin/sh\n{body}\n")
        path.chmod(0o755)
        return path

    def python(self, name: str) -> Path:
        path = self.bin / name
        path.write_text(FAKE_PYTHON.format(real=os.path.realpath(sys.executable)))
        path.chmod(0o755)
        return path

    def start(
        self, *words: str, script: str = "run", cwd: Path | None = None, **environment: str
    ) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [self.repo / script, *words],
            cwd=cwd or self.home,
            env={"PATH": str(self.bin), "FAKE_LOG": str(self.log), "FAKE_GL_FILE": str(self.gl), **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(
        self, *words: str, script: str = "run", cwd: Path | None = None, **environment: str
    ) -> tuple[int, str, str]:
        """(Exit status, stdout, stderr)."""
        process = self.start(*words, script=script, cwd=cwd, **environment)
        out, err = process.communicate(timeout=30)
        return process.returncode, out, err

    def trace(self) -> list[str]:
        """What was done since the last look: `venv`, `lock`, `project`, `probe`, `apt-get ...`."""
        lines = self.log.read_text().splitlines() if self.log.exists() else []
        self.log.unlink(missing_ok=True)
        return [_short(line) for line in lines]


def _short(line: str) -> str:
    if line.startswith("pip"):
        return "lock" if "requirements.lock" in line else "project"
    return "venv" if line.startswith("venv") else line


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


@pytest.mark.parametrize("shell", ["sh", "dash", "bash"])
def test_every_posix_shell_can_read_it(shell: str) -> None:
    if not shutil.which(shell):
        pytest.skip(f"no {shell} here")
    assert subprocess.run([shell, "-n", ROOT / "run"], check=False).returncode == 0


def test_shellcheck_finds_nothing() -> None:
    if not shutil.which("shellcheck"):
        pytest.skip("no shellcheck here")
    done = subprocess.run(["shellcheck", "run", ".ci/run"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout == ""


@pytest.mark.parametrize("words", [[], ["--help"], ["-h"]])
def test_usage_needs_no_environment(machine: Machine, words: list[str]) -> None:
    status, out, err = machine.run(*words)
    assert (status, err) == (0, "")
    assert "./run play [RECORDING]" in out
    assert "./run test" in out
    assert not (machine.repo / ".venv").exists()


def test_too_old_a_python_gets_one_line_and_status_2(machine: Machine) -> None:
    status, out, err = machine.run("play", FAKE_VERSION="3.9.18")
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert "needs Python 3.11 or newer; python3 is 3.9" in err
    assert not (machine.repo / ".venv").exists()


def test_no_python_at_all_gets_one_line_and_status_2(machine: Machine) -> None:
    (machine.bin / "python3").unlink()
    status, _, err = machine.run("play")
    assert status == 2
    assert err.count("\n") == 1
    assert "python3 does not run" in err


def test_a_python_without_venv_gets_debians_remedy_and_status_2(machine: Machine) -> None:
    status, out, err = machine.run("play", FAKE_NO_VENV="1")
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert "apt-get install python3-venv" in err
    machine.python("python3.12")
    assert "apt-get install python3.12-venv" in machine.run("play", FAKE_NO_VENV="1", PYTHON="python3.12")[2]


def test_a_newer_python_is_found_beside_an_old_python3(machine: Machine) -> None:
    machine.command("python3", 'FAKE_VERSION=3.9.18 exec python3.12 "$@"')
    machine.python("python3.12")
    assert machine.run("play")[0] == 0


def test_a_named_python_is_the_only_one_tried(machine: Machine) -> None:
    status, _, err = machine.run("play", PYTHON="python3.12")
    assert status == 2
    assert "python3.12 does not run" in err


def test_paths_are_the_users_own_and_the_exit_status_is_plays(machine: Machine) -> None:
    status, out, _ = machine.run("play", "my wave.csv", "--out", "a b", FAKE_PLAY="3")
    assert status == 3
    assert out.splitlines() == [f"in {machine.home}", "word play", "word my wave.csv", "word --out", "word a b"]


def test_the_first_call_sets_up_and_says_so_and_the_second_only_runs(machine: Machine) -> None:
    _, _, err = machine.run("play")
    assert err == "Setting up .venv (first run, about a minute) ...\n"
    assert machine.trace() == ["venv", "lock", "project", "probe"]
    start = time.monotonic()
    status, _, err = machine.run("play")
    assert (status, err) == (0, "")
    assert machine.trace() == []
    assert time.monotonic() - start < 1.0


def test_it_is_found_through_a_link(machine: Machine) -> None:
    link = machine.home / "nao"
    link.symlink_to(machine.repo / "run")
    done = subprocess.run(
        [link, "play"],
        env={"PATH": str(machine.bin), "FAKE_LOG": str(machine.log), "FAKE_GL_FILE": str(machine.gl)},
        check=False,
    )
    assert done.returncode == 0
    assert (machine.repo / ".venv").is_dir()


def test_what_changed_decides_what_is_done_again(machine: Machine) -> None:
    machine.run("play")
    machine.trace()

    with (machine.repo / "pyproject.toml").open("a") as file:
        file.write("# changed\n")
    machine.run("play")
    assert machine.trace() == ["project", "probe"]

    (machine.repo / "requirements.lock").write_text("numpy==2.4.7\n")
    machine.run("play")
    assert machine.trace() == ["venv", "lock", "project", "probe"]

    machine.run("play", FAKE_VERSION="3.13.0")
    assert machine.trace() == ["venv", "lock", "project", "probe"]

    moved = machine.repo.with_name("moved")
    machine.repo.rename(moved)  # a venv's scripts name its folder
    machine.repo = moved
    machine.run("play", FAKE_VERSION="3.13.0")
    assert machine.trace() == ["venv", "lock", "project", "probe"]


def test_a_venv_stays_with_the_interpreter_it_was_made_with(machine: Machine) -> None:
    machine.python("python3.12")
    machine.run("play", PYTHON="python3.12")
    machine.trace()
    machine.run("play")
    assert machine.trace() == []
    machine.run("play", PYTHON="python3")
    assert machine.trace() == ["venv", "lock", "project", "probe"]


def test_a_failed_first_call_shows_pips_words_and_the_next_call_repairs(machine: Machine) -> None:
    status, _, err = machine.run("play", FAKE_PIP="1")
    assert status == 1
    assert "ERROR: no such package" in err
    machine.trace()
    assert machine.run("play")[0] == 0
    assert machine.trace() == ["venv", "lock", "project", "probe"]


def test_a_killed_first_call_is_repaired_by_the_next(machine: Machine) -> None:
    first = machine.start("play", FAKE_PIP_TIME="1")
    while not (machine.log.exists() and "pip" in machine.log.read_text()):
        time.sleep(0.02)
    first.kill()
    first.communicate()
    machine.trace()
    assert machine.run("play")[0] == 0
    assert machine.trace() == ["venv", "lock", "project", "probe"]


def test_of_two_first_calls_at_once_one_sets_up_and_the_other_waits(machine: Machine) -> None:
    both = [machine.start("play", FAKE_PIP_TIME="0.5") for _ in range(2)]
    errors = sorted(process.communicate(timeout=30)[1] for process in both)
    assert [process.returncode for process in both] == [0, 0]
    assert [error.split()[0] for error in errors] == ["Setting", "Waiting"]
    assert machine.trace() == ["venv", "lock", "project", "probe"]


def test_without_opengl_and_without_rights_it_prints_the_command_and_goes_on(machine: Machine) -> None:
    machine.gl.unlink()
    machine.command("apt-get", 'echo "apt-get" >>"$FAKE_LOG"')
    status, out, err = machine.run("play")
    assert status == 0
    assert "word play" in out
    assert err.endswith("  sudo apt-get install libegl1 libegl-mesa0 libgl1\n")
    assert "apt-get" not in machine.trace()
    assert machine.run("play")[2] == ""


def test_without_opengl_root_gets_debians_packages(machine: Machine) -> None:
    machine.gl.unlink()
    machine.command("id", "echo 0")
    # The first install finds no package lists; after an update it works.
    machine.command(
        "apt-get",
        'for last do :; done; echo "apt-get $last" >>"$FAKE_LOG"; lists=${FAKE_LOG%log}lists\n'
        'if [ "$last" = update ]; then echo >"$lists"; exit; fi\n'
        '[ -e "$lists" ] || exit 100; echo >"$FAKE_GL_FILE"',
    )
    status, _, err = machine.run("play")
    assert status == 0
    assert "Installing software OpenGL" in err
    assert machine.trace()[-5:] == ["probe", "apt-get libgl1", "apt-get update", "apt-get libgl1", "probe"]


def test_tests_run_at_the_top_with_pytests_closing_line_last(machine: Machine) -> None:
    status, out, _ = machine.run("test", "-k", "wave")
    assert status == 0
    assert f"ruff format --check --quiet . in {machine.repo}" in out
    assert "mypy" in out
    assert out.endswith("=== closing line ===\n")
    assert machine.trace()[-1] == "pytest -n auto --dist worksteal -k wave"


@pytest.mark.parametrize(("failing", "expected"), [("FAKE_RUFF", 1), ("FAKE_PYTEST", 5)])
def test_any_failing_check_fails_the_whole_and_the_others_still_run(
    machine: Machine, failing: str, expected: int
) -> None:
    for script in ("run", ".ci/run"):
        words = ["test"] if script == "run" else []
        status, out, _ = machine.run(*words, script=script, **{failing: "5"})
        assert status == expected
        assert out.endswith("=== closing line ===\n")
        assert ("ruff check: FAILED" in out) == (failing == "FAKE_RUFF")
        assert "mypy: passed" in out
