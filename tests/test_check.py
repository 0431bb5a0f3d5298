"""`nao-sim check` from the outside: what it says, writes and ends with."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import pytest

from nao_sim.cli import main
from nao_sim.console import REASONS
from nao_sim.paths import TRAJECTORIES
from nao_sim.safety.rules import SPEED_FRACTION
from nao_sim.simulation import measures
from nao_sim.verdict import Verdict, verdict, wrongs

ROOT = Path(__file__).resolve().parents[1]
WELL = {
    "fell": False,
    "limit_violations": 0,
    "max_limit_excess_deg": 0.1,
    "max_coupling_excess_deg": 0.5,
    "max_speed_ratio": 1.02,
    "self_collision_frames": 0,
    "min_self_distance_m": 0.005,
}


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """An empty folder with a second of a motion that is safe, and one that asks a joint beyond its limit."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)  # the test runner keeps its own handlers
    monkeypatch.setenv("COLUMNS", "80")
    _write("safe.csv", [80.0 - 0.5 * frame for frame in range(20)])
    _write("far.csv", [80.0 + 3.0 * frame for frame in range(20)])


@pytest.fixture(scope="module")
def stress(tmp_path_factory) -> dict:
    """The report of a motion that needs every rule."""
    file = tmp_path_factory.mktemp("stress") / "report.json"
    assert main(["check", str(TRAJECTORIES / "stress.csv"), "-q", "--json", str(file)]) > 0
    return json.loads(file.read_text(encoding="utf-8"))


def _write(name: str, angles: list[float]) -> None:
    rows = [f"{0.05 * frame:.2f},{angle}" for frame, angle in enumerate(angles)]
    Path(name).write_text("\n".join(["time,LShoulderPitch_deg", *rows]) + "\n", encoding="utf-8")


def _checked(*words: str) -> tuple[int, dict]:
    status = main(["check", *words, "-q", "--json", "check.json"])
    return status, json.loads(Path("check.json").read_text(encoding="utf-8"))


def test_what_is_safe_is_said_to_be_and_ends_with_0(capsys):
    assert main(["check", "safe.csv"]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines()[1] == "safe as requested"
    assert "0 limit violations, 0 self-collisions" in out and "changed" not in out
    assert err == "" and sorted(path.name for path in Path().iterdir()) == ["far.csv", "safe.csv"]


def test_what_is_made_safe_names_the_rule_the_joint_and_the_time_and_ends_with_1(capsys):
    status, report = _checked("far.csv")
    assert status == main(["check", "far.csv"]) == 1
    out = capsys.readouterr().out
    assert f"made safe: {report['changed_steps']} of {report['steps']} frames (50 Hz) changed" in out
    (rule,) = (row for row in report["rules"] if row["reason"] == "limit")
    assert rule["joints"] == ["LShoulderPitch"] and rule["largest_change_deg"] == pytest.approx(17.5, abs=0.1)
    (line,) = (line for line in out.splitlines() if line.startswith(REASONS["limit"]))
    share, mean = f"{100 * rule['share']:.1f}", f"{rule['mean_change_deg']:.1f}°"
    assert line.split()[-5:] == [f"{rule['seconds']:.2f}", share, "%", "17.5°", mean]
    start, end = rule["times_s"][0]
    assert f"at {start:.2f}-{end:.2f} s" in out
    assert max(len(line.rstrip()) for line in out.splitlines()) <= 80


def test_the_rules_say_in_sum_what_the_changed_joints_say_one_by_one(stress):
    report = stress
    assert {row["reason"] for row in report["rules"]} == {row["reason"] for row in report["changed"]}
    for rule in report["rules"]:
        rows = [row for row in report["changed"] if row["reason"] == rule["reason"]]
        assert set(rule["joints"]) == {row["joint"] for row in rows}
        assert rule["largest_change_deg"] == max(row.get("largest_change_deg", 0.0) for row in rows)
        assert 0.0 < rule["mean_change_deg"] <= rule["largest_change_deg"]
        seconds = [row["seconds"] for row in rows]
        assert max(seconds) <= rule["seconds"] <= sum(seconds) + 1e-9
        assert rule["seconds"] == pytest.approx(sum(end - start for start, end in rule["times_s"]))
        assert rule["share"] == pytest.approx(rule["steps"] / report["steps"], abs=1e-4)
        assert {tuple(pair["links"]) for pair in rule.get("pairs", [])} == {
            tuple(pair) for row in rows for pair in row.get("pairs", [])
        }
    longest = max(rule["steps"] for rule in report["rules"])
    assert longest <= report["changed_steps"] <= sum(rule["steps"] for rule in report["rules"])


def test_check_says_of_a_recording_what_play_does_with_it():
    _, report = _checked("far.csv", "--base", "pinned", "--speed", "2")
    words = ["far.csv", "--base", "pinned", "--speed", "2", "--no-video", "-q", "--report", "play.json"]
    assert main(["play", *words]) == 0
    played = json.loads(Path("play.json").read_text(encoding="utf-8"))
    del played["timing"]
    assert report == played


def test_json_on_the_standard_output_is_all_there_is(capsys):
    _, report = _checked("far.csv")
    assert main(["check", "far.csv", "--json", "-"]) == 1
    out, err = capsys.readouterr()
    assert (json.loads(out), err) == (report, "")


def test_a_robot_that_breaks_a_rule_is_told_in_check_and_play_and_ends_with_4(monkeypatch, capsys):
    monkeypatch.setattr(measures, "limit_violations", lambda robot, states: (3, 0.01))
    assert main(["check", "safe.csv"]) == 4
    assert "NOT SAFE: a joint passed its limit, by up to 0.57°" in capsys.readouterr().out
    assert main(["play", "safe.csv", "--no-video", "-q"]) == 4


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ({"fell": True}, "fell"),
        ({"limit_violations": 1}, "passed its limit"),
        ({"max_coupling_excess_deg": 0.51}, "that another joint sets"),
        ({"max_speed_ratio": 1.03}, "103 %"),
        ({"self_collision_frames": 2, "min_self_distance_m": -0.001}, "touched itself in 2 steps"),
        ({"min_self_distance_m": 0.0049}, "within 4.9 mm"),
    ],
)
def test_each_rule_that_the_simulated_robot_breaks_is_named_once(what, says):
    assert wrongs(WELL) == []
    (wrong,) = wrongs(WELL | what)
    assert says in wrong
    assert verdict(0, [wrong]) == verdict(7, [wrong]) == Verdict.unsafe


def test_of_many_each_has_a_line_and_the_worst_is_the_status(capsys):
    Path("bad.csv").write_text("no recording\n", encoding="utf-8")
    assert main(["check", "safe.csv", "far.csv"]) == 1
    capsys.readouterr()
    assert main(["check", "safe.csv", "bad.csv", "far.csv", "--json", "all.json"]) == 2
    out, err = capsys.readouterr()
    lines = out.splitlines()
    assert lines[0] == "safe as requested  safe.csv"
    assert lines[1].startswith("made safe: ") and "  far.csv: limit" in lines[1]
    assert "bad.csv" in err and err.count("\n") == 1
    totals = [line.split() for line in lines[3:]]
    assert ["safe", "as", "requested", "1"] in totals and ["cannot", "be", "read", "1"] in totals
    written = json.loads(Path("all.json").read_text(encoding="utf-8"))
    assert [report["recording"] for report in written["recordings"]] == ["safe.csv", "far.csv"]
    assert written["unreadable"] == 1


def test_one_recording_of_many_is_checked_as_if_alone():
    _, alone = _checked("far.csv")
    _, many = _checked("safe.csv", "far.csv", "far.csv")
    assert many["recordings"][1] == many["recordings"][2] == alone


@pytest.mark.parametrize("command", [["check"], ["play", "--no-video"]])
def test_what_is_switched_off_is_said_on_the_screen_and_in_the_report(command, capsys):
    words = [*command, "safe.csv", "--without", "self-collision", "--without", "balance", "--accept-risk"]
    main([*words, "--max-speed", "0.5", *(["--json", "r.json"] if command == ["check"] else ["--report", "r.json"])])
    assert "SWITCHED OFF: balance, self_collision" in capsys.readouterr().out
    report = json.loads(Path("r.json").read_text(encoding="utf-8"))
    assert (report["rules_off"], report["speed_fraction"]) == (["balance", "self_collision"], 0.5)


def test_with_all_rules_on_nothing_is_said_of_it(capsys):
    _, report = _checked("safe.csv")
    assert (report["rules_off"], report["speed_fraction"]) == ([], SPEED_FRACTION)
    main(["check", "safe.csv"])
    assert "SWITCHED OFF" not in capsys.readouterr().out


@pytest.mark.parametrize("command", [["check"], ["play", "--no-video"]])
@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--without", "balance"], "expected --accept-risk"),
        (["--without", "limit", "--accept-risk"], "limit can never be off"),
        (["--without", "gravity", "--accept-risk"], "no rule 'gravity'; expected one of coupling, speed"),
        (["--max-speed", "1.5"], "0.05 to 1"),
        (["--max-speed", "nan"], "0.05 to 1"),
        (["--speed", "0"], "--speed 0"),
    ],
)
def test_rules_that_cannot_be_are_refused_in_one_line(command, words, says, capsys):
    _refused(capsys, [*command, "safe.csv", *words], says)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["none.csv"], "none.csv"),
        (["safe.csv", "--plot", "picture.jpg"], "expected a name that ends in .png, .svg or .pdf"),
        (["safe.csv", "far.csv", "--plot", "picture.png"], "shows one recording, and 2 are given"),
        (["safe.csv", "--json", "safe.csv"], "would overwrite the recording"),
        (["far.csv", "safe.csv", "--json", "safe.csv"], "would overwrite the recording"),
        (["safe.csv", "--body", "whole"], "expected a person's recording"),
        ([], "RECORDING"),
    ],
)
def test_what_cannot_be_checked_is_one_line_and_nothing_written(words, says, capsys):
    _refused(capsys, ["check", *words], says)


def _refused(capsys, words, says):
    before = {path: path.read_bytes() for path in Path().iterdir()}
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and says in err, err
    assert {path: path.read_bytes() for path in Path().iterdir()} == before


def test_the_help_shows_the_usual_speed(capsys):
    main(["check", "--help"])
    assert f"[default: ({SPEED_FRACTION:g})]" in " ".join(capsys.readouterr().out.replace("│", " ").split())


def test_the_picture_is_written_where_it_should_be(capsys):
    assert main(["check", "far.csv", "--plot", "new/picture.png"]) == 1
    assert Path("new/picture.png").read_bytes().startswith(b"\x89PNG")
    assert "written new/picture.png" in capsys.readouterr().out


def test_every_key_of_the_report_is_documented(stress):
    documented = (ROOT / "docs" / "report.md").read_text(encoding="utf-8")
    keys = {*stress, *(key for row in stress["rules"] for key in row)}
    assert not [key for key in keys if f"`{key}`" not in documented]
    assert not [reason for reason in REASONS if f"`{reason}`" not in documented]
