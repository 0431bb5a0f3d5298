"""The lock file: exact, hashed, and free of addresses."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LOCK = (ROOT / "requirements.lock").read_text(encoding="utf-8")
ENTRY = re.compile(
    r"^(?P<name>[a-z0-9-]+)==(?P<version>[\w.]+)(?: ; .+)? \\\n(?P<hashes>(?: +--hash=.+\n)+)", re.MULTILINE
)


def test_every_entry_is_exact_and_hashed() -> None:
    starts = [line for line in LOCK.splitlines() if line[:1] not in ("", " ", "#")]
    entries = list(ENTRY.finditer(LOCK))
    assert len(entries) == len(starts) > 20
    for entry in entries:
        assert all(re.search(r"--hash=sha256:[0-9a-f]{64}( \\)?$", line) for line in entry["hashes"].splitlines())


def test_it_names_no_address_and_no_folder() -> None:
    assert not re.search(r"://|--(extra-)?index-url|find-links|file:|/(root|home|tmp|usr|work)\b", LOCK)


def test_it_covers_what_pyproject_asks_for() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    locked = {entry["name"]: entry["version"] for entry in ENTRY.finditer(LOCK)}
    for requirement in [*project["project"]["dependencies"], *project["dependency-groups"]["dev"]]:
        assert re.match(r"[\w-]+", requirement)[0].lower() in locked, requirement  # type: ignore[index]
    assert locked["dm-control"] == "1.0.50"
    assert locked["mujoco"].startswith("3.17.")


def test_its_header_says_how_to_remake_it() -> None:
    command = LOCK.splitlines()[1]
    assert command.startswith("#    uv pip compile pyproject.toml --group dev ")
    assert command.endswith(" -o requirements.lock")
