"""The wheel: what is in it, and that its own files suffice.

The wheel is installed into an empty environment which then borrows the third-party packages of the running one through
a `.pth` file.  Those come from the lock file and are not on trial here; fetching them again would take a minute.
Folders named in a `.pth` are not searched for further `.pth` files, so the running environment's link to this checkout
does not come along: `nao_sim` can only be the wheel's.
"""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import venv
from importlib.metadata import packages_distributions
from pathlib import Path
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def canonical(requirement: str) -> str:
    name = re.match(r"[\w.-]+", requirement)
    assert name, requirement
    return re.sub(r"[-_.]+", "-", name.group()).lower()


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (path,) = folder.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def names(wheel: Path) -> set[str]:
    with ZipFile(wheel) as archive:
        return set(archive.namelist())


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The `bin` folder of an environment that holds the wheel."""
    home = tmp_path_factory.mktemp("an empty environment")
    venv.create(home, symlinks=True)
    python = home / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-deps", "--no-index", wheel]
    subprocess.run(pip, check=True, capture_output=True)
    (site_packages,) = home.glob("lib/python*/site-packages")
    borrowed = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}
    (site_packages / "borrowed.pth").write_text("\n".join(borrowed))
    return home / "bin"


def run(command: list[str | Path], cwd: Path) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False, timeout=120)


def test_the_wheel_holds_the_package_and_its_data(names: set[str]) -> None:
    assert names >= {
        "nao_sim/py.typed",
        "nao_sim/cli.py",
        "nao_sim/_data/models/nao_h25/facts.json",
        "nao_sim/_data/models/nao_h25/nao_h25.xml",
        "nao_sim/_data/models/nao_h25/scene.xml",
        "nao_sim/_data/models/nao_h25/LICENSE",
        "nao_sim/_data/render/presets.toml",
        "nao_sim/_data/trajectories/wave.csv",
    }
    assert any(re.fullmatch(r"nao_sim-[\d.]+\.dist-info/licenses/LICENSE", name) for name in names)
    sources = {path.relative_to(ROOT).as_posix() for path in (ROOT / "nao_sim").rglob("*.py")}
    assert sources <= names


def test_the_wheel_holds_nothing_else(names: set[str]) -> None:
    assert {name.split("/")[0].split("-")[0] for name in names} == {"nao_sim"}
    junk = re.compile(r"(^|/)(tests?|__pycache__|scripts)/|_data/.*\.py$|\.(pyc|mp4|webm|gif|log)$|(^|/)\.|MUJOCO_LOG")
    assert [name for name in names if junk.search(name)] == []


def test_every_import_is_declared() -> None:
    """A package that comes along with another today may stay away tomorrow."""
    table = PROJECT["project"]
    groups = [table["dependencies"], *table["optional-dependencies"].values()]
    declared = {canonical(requirement) for group in groups for requirement in group}
    known = packages_distributions()
    missing = {
        (path.name, module)
        for path in (ROOT / "nao_sim").rglob("*.py")
        for module in imported(path) - set(sys.stdlib_module_names) - {"nao_sim"}
        if declared.isdisjoint(map(canonical, known.get(module, [module])))
    }
    assert missing == set()


def imported(path: Path) -> set[str]:
    """Top-level names of all modules that a file imports, wherever in it."""
    modules: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            modules.add(node.module)
    return {module.split(".")[0] for module in modules}


def test_the_installed_package_is_the_wheels_and_finds_its_data(installed: Path, tmp_path: Path) -> None:
    code = "import nao_sim.paths as p, sys; print(p.__file__, p.MODEL, p.TRAJECTORIES, p.PRESETS, *sys.path, sep='\\n')"
    done = run([installed / "python", "-c", code], tmp_path)
    assert done.returncode == 0, done.stderr
    module, model, trajectories, presets, *search_path = done.stdout.splitlines()
    assert str(ROOT) not in search_path
    assert all(Path(path).is_relative_to(installed.parent) for path in (module, model, trajectories, presets))
    assert (Path(model) / "nao_h25.xml").is_file()
    assert (Path(trajectories) / "wave.csv").is_file()
    assert (Path(presets) / "presets.toml").is_file()


def test_the_console_script_answers(installed: Path, tmp_path: Path) -> None:
    done = run([installed / "nao-sim", "--version"], tmp_path)
    assert (done.returncode, done.stdout.split()[0], done.stderr) == (0, "nao-sim", "")


def test_the_installed_wheel_plays_a_recording_from_anywhere(installed: Path, tmp_path: Path) -> None:
    """Expected: exit status 0, and a JSON report somewhere below the folder it was called in."""
    (tmp_path / "my wave.csv").write_bytes((ROOT / "trajectories" / "wave.csv").read_bytes())
    done = run([installed / "nao-sim", "play", "my wave.csv", "--no-video"], tmp_path)
    assert done.returncode == 0, done.stderr
    (report,) = tmp_path.rglob("*.json")
    assert json.loads(report.read_text(encoding="utf-8"))
