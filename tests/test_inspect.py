"""`nao-sim inspect`: what it prints, writes and refuses."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nao_sim import cli
from nao_sim.inspect_report import inspection
from nao_sim.inspect_tables import print_inspection
from nao_sim.motion import Skeleton
from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings import Label, Recording, load
from tests.people import person
from tests.tracking import JOINTS, spoiled

WAVE = TRAJECTORIES / "wave.csv"


def recorded(skeleton: Skeleton, **more: object) -> Recording:
    return Recording(Path("some.txt"), "a format", "a reason", skeleton, len(skeleton), **more)  # type: ignore[arg-type]


def printed(recording: Recording, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("COLUMNS", "100")
    print_inspection(inspection(recording), [])
    return capsys.readouterr().out


def test_joint_angles_are_told(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert cli.main(["inspect", str(WAVE)]) == 0
    out, err = capsys.readouterr()
    assert err == "" and "…" not in out
    for part in (str(WAVE), "joint-angle CSV", "is a NAOqi joint", "50.0 frames/s (even)", "14 joints", "RElbowRoll"):
        assert part in out
    row = next(line.split() for line in out.splitlines() if line.startswith("RShoulderPitch"))
    motion = load(WAVE).motion
    values = np.degrees(motion.positions[:, motion_index("RShoulderPitch")])
    assert row[1:5] == [f"{values.min():.1f}", f"{values.max():.1f}", "-119.5", "119.5"]


def motion_index(name: str) -> int:
    from nao_sim.robot import load_robot

    return load_robot().index[name]


def test_a_person_is_told(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    noisy = spoiled(person(90), np.random.default_rng(0))
    labels = tuple(Label(name, 0.0, 1.0) for name in "abcdefgh")
    out = printed(recorded(noisy, notes=("something to know",), labels=labels), capsys, monkeypatch)
    for part in ("something to know", "90 in 2.97 s", "a person, 70 joints", "a, b, c, d, e, f and 2 more",
                 "rejected by jump", "left fingers (20)", "left elbow - left wrist"):  # fmt: skip
        assert part in out
    assert "left index" not in out


def test_what_a_person_lacks_is_told(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    out = printed(recorded(person(30, joints=JOINTS)), capsys, monkeypatch)
    assert "without spine, left_hand, left_hip, left_knee, left_ankle, left_foot and 5 more" in out
    assert "nothing to reject or fill" in out


@pytest.mark.parametrize("frames", [1, 2])
def test_next_to_nothing_is_told_as_well(
    frames: int, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    skeleton = person(frames, joints=("left_hand",))
    assert "1 joint" in printed(recorded(skeleton), capsys, monkeypatch)
    nobody = replace(skeleton, positions=np.full(skeleton.positions.shape, np.nan))
    assert "0 joints" in printed(recorded(nobody), capsys, monkeypatch)


def test_names_in_brackets_are_no_markup(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    out = printed(recorded(person(3, joints=JOINTS), notes=("[bold]a[/bold]",)), capsys, monkeypatch)
    assert "[bold]a[/bold]" in out


def test_the_report_is_plain_json_with_units_in_its_names() -> None:
    skeleton = spoiled(person(60, joints=JOINTS), np.random.default_rng(1))
    report = inspection(recorded(skeleton))
    assert json.loads(json.dumps(report, allow_nan=False)) == report
    assert report["holds"] == "person" and report["frames"] == 60 and report["rate_hz"] == 30.0
    wrist = next(row for row in report["joints"] if row["joint"] == "left_wrist")
    assert wrist["seen"] == pytest.approx(np.isfinite(skeleton.track("left_wrist")).all(axis=1).mean(), abs=1e-4)
    assert 5.0 < wrist["jitter_mm"] < 20.0
    arm = next(row for row in report["bones"] if (row["start"], row["end"]) == ("left_shoulder", "left_elbow"))
    assert arm["length_m"] == pytest.approx(0.172 * 1.7, abs=0.01)
    assert report["cleaning"]["points"] == 600


def test_json_goes_to_a_file_or_alone_to_the_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "wave.json"
    assert cli.main(["inspect", str(WAVE), "--json", str(path), "-q"]) == 0
    assert capsys.readouterr().out == ""
    assert cli.main(["inspect", str(WAVE), "--json", "-"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report == json.loads(path.read_text(encoding="utf-8"))
    assert report["holds"] == "robot" and report["joints"][0]["upper_limit_deg"] == pytest.approx(119.5, abs=0.01)


def test_another_robot_has_other_motors(capsys: pytest.CaptureFixture[str]) -> None:
    ratios = []
    for robot in ("v4", "v6"):
        assert cli.main(["inspect", str(WAVE), "--json", "-", "--robot", robot]) == 0
        ratios.append([row["top_speed_ratio"] for row in json.loads(capsys.readouterr().out)["joints"]])
    assert ratios[0] != ratios[1]


def test_a_picture_is_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "wave.png"
    assert cli.main(["inspect", str(WAVE), "--plot", str(path)]) == 0
    assert path.read_bytes().startswith(b"\x89PNG") and f"written  {path}" in capsys.readouterr().out.replace("\n", "")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nothing.csv"], "no such file"),
        ([str(WAVE), "--plot", "wave.jpg"], "expected a name that ends in .png, .svg or .pdf"),
        ([str(WAVE), "--plot", "missing/wave.png"], "cannot write there"),
        ([str(WAVE), "--json", str(WAVE)], "would overwrite"),
        ([str(WAVE), "--json", "."], "is a folder"),
        ([str(WAVE), "--plot", "a.png", "--json", "a.png"], "named for two results"),
        ([str(WAVE), "--rate", "nan"], "rate"),
    ],
)
def test_bad_input_is_one_line_and_status_2(
    words: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["inspect", *words]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("nao-sim") and message in err and err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_looking_at_help_and_numbers_needs_no_matplotlib(capsys: pytest.CaptureFixture[str]) -> None:
    import subprocess
    import sys

    script = (
        f"from nao_sim.cli import main; main(['inspect', {str(WAVE)!r}, '-q'])\n"
        "import sys; print({'matplotlib', 'mujoco'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"
