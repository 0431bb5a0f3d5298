"""The reference: what the code says stands in docs/, and the report's page knows every field of a report."""

from __future__ import annotations

import importlib.util
import json
import re

import pytest

from nao_sim.cli import COMMANDS, main
from nao_sim.paths import TRAJECTORIES
from tests.docs.shown import ROOT

DOCS = ROOT / "docs"
NAMES = {"tracking_rmse_deg"}  # fields whose keys are names of joints


def test_the_generated_parts_are_what_the_code_says(capsys):
    spec = importlib.util.spec_from_file_location("reference", DOCS / "tools" / "reference.py")
    reference = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(reference)
    assert reference.main(["--check"]) == 0, capsys.readouterr().out


def test_every_command_has_a_heading():
    text = (DOCS / "commands.md").read_text(encoding="utf-8")
    assert re.findall(r"^## (.*)$", text, re.MULTILINE) == list(COMMANDS)


@pytest.fixture(scope="module")
def fields(tmp_path_factory):
    """Names of all fields of reports of a person, played by two robots, and of motions that meet all rules."""
    folder = tmp_path_factory.mktemp("reports")
    person = (TRAJECTORIES / "person_wave.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    (folder / "person.csv").write_text("".join(person[:2] + person[20:60]), encoding="utf-8")
    stress = (TRAJECTORIES / "stress.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    first = next(i for i, line in enumerate(stress) if line.startswith("10.2,"))
    header = next(line for line in stress if line.startswith("time"))
    (folder / "stress.csv").write_text(header + "".join(stress[first : first + 40]), encoding="utf-8")
    reports = []
    for words in (["person.csv", "--mode", "both"], ["person.csv"], ["stress.csv"]):
        report = folder / "report.json"
        name, *more = words
        orders = ["play", str(folder / name), *more, "--no-video", "--report", str(report), "--quiet"]
        assert main(orders) == 0
        reports.append(json.loads(report.read_text(encoding="utf-8")))
    return set().union(*map(keys, reports))


def keys(value):
    """All keys of a JSON, but for those that are names."""
    if isinstance(value, list):
        return set().union(*map(keys, value)) if value else set()
    if not isinstance(value, dict):
        return set()
    return set(value).union(*(keys(inner) for key, inner in value.items() if key not in NAMES))


def test_the_reports_page_knows_every_field_and_no_other(fields):
    text = (DOCS / "report.md").read_text(encoding="utf-8")
    assert {field for field in fields if f"`{field}`" not in text} == set()
    json_part = text[: text.index("## The rollout")]
    rows = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \|", json_part, re.MULTILINE)
    told = {name for row in rows for name in re.findall(r"`(\w+)`", row)}
    reasons = set(re.findall(r"^\| `(\w+)` \|[^|]*\| (?:always|`\w+`) \|$", json_part, re.MULTILINE))
    assert told - reasons - fields <= {"render_s", "render_fps", "gl_backend", "gl_renderer"}  # of a film
