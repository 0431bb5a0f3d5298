"""`nao-sim play` from the outside: files in, files and exit status out."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from nao_sim.cli import main
from nao_sim.motion import JointTrajectory
from nao_sim.options import film_of
from nao_sim.paths import TRAJECTORIES
from nao_sim.simulation.rollout import Rollout
from tests.pictures import needs_gl

ROOT = Path(__file__).resolve().parent.parent
STRESS = TRAJECTORIES / "stress.csv"


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)  # the test runner keeps its own handlers
    return tmp_path


def _short(path: Path, frames: int = 26) -> Path:
    """A second of a small arm motion."""
    angles = 80 - 20 * np.sin(np.linspace(0, np.pi, frames))
    rows = [f"{0.04 * i:.2f},{angle:.3f}" for i, angle in enumerate(angles)]
    path.write_text("\n".join(["time,LShoulderPitch_deg", *rows]) + "\n", encoding="utf-8")
    return path


def _report(path: str | Path) -> dict:
    return json.loads(Path(path).read_text(encoding="utf-8"))


def _fails(capsys, *words: str) -> str:
    """The one line on stderr of a call that ends with status 2 and writes nothing."""
    before = sorted(Path.cwd().rglob("*"))
    assert main(["play", *words]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert len(err.splitlines()) == 1, err
    assert sorted(Path.cwd().rglob("*")) == before
    return err


def test_stress_ends_standing_with_every_intervention_told_and_no_violation(capsys):
    assert main(["play", str(STRESS), "--no-video", "--rollout", "out.npz", "--report", "r.json"]) == 0
    report = _report("r.json")
    assert all(report["requested"].values()), report["requested"]
    reasons = {row["reason"] for row in report["changed"]}
    assert {"limit", "coupling", "speed", "self_collision"} <= reasons
    did = report["simulated"]
    assert did["limit_violations"] == 0
    assert did["max_limit_excess_deg"] <= 0.1
    assert did["max_coupling_excess_deg"] <= 0.5
    assert did["max_speed_ratio"] <= 1.02
    assert did["self_collision_frames"] == 0
    assert did["min_self_distance_m"] > 0
    assert did["fell"] is False
    assert did["min_support_margin_m"] > 0
    rollout = Rollout.load("out.npz")
    assert np.isfinite(rollout.command).all()
    assert "into the robot itself" in capsys.readouterr().out


def test_stress_pinned_moves_its_legs_as_safely():
    assert main(["play", str(STRESS), "--base", "pinned", "--no-video", "-q", "--report", "r.json"]) == 0
    report = _report("r.json")
    assert report["simulated"]["limit_violations"] == 0
    assert report["simulated"]["self_collision_frames"] == 0
    assert report["simulated"]["max_coupling_excess_deg"] <= 0.5
    assert report["simulated"]["min_support_margin_m"] is None


NOT_PLAYED = {"stress.csv", "thesis_users.csv"}  # the first is no sample, the second a manifest


@pytest.mark.parametrize("name", sorted({path.name for path in TRAJECTORIES.glob("*.csv")} - NOT_PLAYED))
def test_every_sample_plays_and_the_robot_stands(name):
    pace = "4" if name == "thesis_table_a1.csv" else "1"  # a minute and more of poses that are held
    assert main(["play", str(TRAJECTORIES / name), "--speed", pace, "--no-video", "-q", "--report", "r.json"]) == 0
    did = _report("r.json")["simulated"]
    assert did["limit_violations"] == did["self_collision_frames"] == 0


def test_a_gentle_sample_is_not_changed_at_all():
    assert main(["play", "--no-video", "-q", "--report", "r.json"]) == 0
    report = _report("r.json")
    assert Path(report["recording"]).name == "wave.csv"
    assert report["changed"] == []
    assert not any(report["requested"].values())


@pytest.mark.parametrize("version", ["v4", "v6"])
def test_other_versions_play(version):
    _short(Path("a.csv"))
    assert main(["play", "a.csv", "--robot", version, "--no-video", "-q"]) == 0
    assert _report("render/a.json")["robot"] == version


def test_report_holds_what_is_documented():
    _short(Path("a.csv"))
    assert main(["play", "a.csv", "--no-video", "-q"]) == 0
    report = _report("render/a.json")
    documented = (ROOT / "docs" / "report.md").read_text(encoding="utf-8")
    keys = [*report, *report["requested"], *report["simulated"], *report["timing"]]
    missing = [key for key in keys if f"`{key}`" not in documented]
    assert not missing
    assert report["schema"] == 1


def test_results_of_a_folder_made_for_them_stay_out_of_version_control():
    _short(Path("a.csv"))
    main(["play", "a.csv", "--no-video", "-q"])
    assert Path("render/.gitignore").read_text(encoding="utf-8") == "*\n"


def test_twice_as_fast_is_half_as_long():
    _short(Path("a.csv"))
    main(["play", "a.csv", "--no-video", "-q", "--rollout", "one.npz"])
    main(["play", "a.csv", "--no-video", "-q", "--rollout", "two.npz", "--speed", "2"])
    one, two = Rollout.load("one.npz"), Rollout.load("two.npz")
    assert one.time[-1] - two.time[-1] == pytest.approx(0.5, abs=0.021)


def test_the_mirrored_recording_gives_the_mirrored_motion(robot):
    from nao_sim.recordings import load, write_joint_csv

    stress = load(STRESS).motion
    # later both arms struggle, where the tiniest difference decides which gives way (docs/limits.md)
    part = slice(*np.searchsorted(stress.times, (0.0, 6.0)))
    calmer = JointTrajectory(stress.times[part], stress.positions[part], stress.given)
    for name, motion in (("plain", calmer), ("mirror", calmer.mirrored())):
        write_joint_csv(f"{name}.csv", motion)
        main(["play", f"{name}.csv", "--no-video", "-q", "--rollout", f"{name}.npz"])
    plain, mirror = Rollout.load("plain.npz"), Rollout.load("mirror.npz")
    apart = np.abs(robot.mirror(mirror.joint_positions) - plain.joint_positions)[:, ~robot.is_hand]
    assert np.degrees(apart.max()) < 0.5


def test_hands_and_head_arrive_where_they_are_asked(robot):
    Path("a.csv").write_text("# unit: deg\ntime,HeadYaw,LHand\n0,0,0\n1,30,1\n2,30,1\n", encoding="utf-8")
    main(["play", "a.csv", "--no-video", "-q", "--rollout", "out.npz"])
    end = Rollout.load("out.npz").joint_positions[-1]
    assert np.degrees(end[robot.index["HeadYaw"]]) == pytest.approx(30, abs=0.5)
    assert end[robot.index["LHand"]] == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["nowhere.csv"], "nowhere.csv"),
        (["."], "folder"),
        (["a.csv", "--speed", "0"], "--speed 0: expected a factor"),
        (["a.csv", "--speed", "nan"], "--speed nan: expected a factor"),
        (["a.csv", "--size", "640"], "--size 640: expected WIDTHxHEIGHT"),
        (["a.csv", "--size", "641x480"], "even width and height, not 641x480; try 642x480"),
        (["a.csv", "--fps", "0"], "0.0 frames a second"),
        (["a.csv", "--fps", "nan"], "frames a second"),
        (["a.csv", "--video", "film.avi"], "expected one of .mp4"),
        (["a.csv", "--video", "film.mp4", "--no-video"], "contradict"),
        (["a.csv", "--camera", "behind"], "front"),
        (["a.csv", "--arrange", "behind"], "holds joint angles (joint-angle CSV); expected a person's recording"),
        (["a.csv", "--arrange", "eyes", "--camera", "head"], "--arrange eyes shows in a part what --camera head sees"),
        (["a.csv", "--overlay", "none", "--show-safety"], "contradict each other"),
        (["a.csv", "--robot", "v3"], "v4"),
        (["a.csv", "--mode", "gestures"], "a.csv: holds joint angles (joint-angle CSV); expected a person's recording"),
        (["a.csv", "--vocabulary", "b.vocab"], "--vocabulary b.vocab: no gestures are recognised"),
        (["a.csv", "--mode", "gestures", "--raw"], "--raw: says how every frame is imitated"),
        (["a.csv", "--report", "a.csv"], "would overwrite the recording"),
        (["a.csv", "--rollout", "x.json", "--report", "x.json"], "named for two results"),
        (["a.csv", "--unit", "rad"], "unit"),
        (["a.csv", "--no-such-option"], "--no-such-option"),
        (["a.csv", "b.csv"], "b.csv"),
    ],
)
def test_what_cannot_be_honoured_is_one_line_and_nothing_written(capsys, words, says):
    _short(Path("a.csv"))
    assert says in _fails(capsys, *words)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "empty"),
        (b"time,LShoulderPitch_deg\n", "line"),
        (b"time,LShoulderPitch\n0,1\n", "unit"),
        (b"time,LShoulderPitch_deg\n0,1\n0.1,hello\n", "line 3, column LShoulderPitch_deg: 'hello'"),
        (b"time,LShoulderPitch_deg\n0,1\n0,2\n", "line 3"),
        (b"time,LShoulderPitch_deg\n1,1\n0.5,2\n", "line 3"),
        (b"time,Elbow_deg\n0,1\n", "Elbow"),
        (b"\x00\x01\x02\x03" * 100, "bad.csv"),
        (b"LShoulderPitch_deg\n1\n2\n", "--rate"),
        (b"time,LShoulderPitch_deg\n0,80\n9000000,70\n", "lasts 2500.0 hours; expected at most 2"),
    ],
)
def test_a_bad_file_is_one_line_that_names_the_place(capsys, content, says):
    Path("bad.csv").write_bytes(content)
    error = _fails(capsys, "bad.csv")
    assert "bad.csv" in error
    assert says in error


def test_a_file_without_times_plays_at_a_given_rate():
    Path("a.csv").write_text("LShoulderPitch_deg\n80\n70\n60\n", encoding="utf-8")
    assert main(["play", "a.csv", "--rate", "2", "--no-video", "-q"]) == 0
    assert _report("render/a.json")["duration_s"] == 1.0


@pytest.mark.parametrize(
    ("name", "film"), [("a.csv", "a.mp4"), ("a.json.gz", "a.mp4"), ("a.b.bvh.XZ", "a.b.mp4"), ("x/a.b.csv", "a.b.mp4")]
)
def test_the_film_has_the_name_of_what_is_in_the_file(name, film):
    assert film_of(Path(name)) == Path("render") / film


def test_a_wrong_choice_is_told_in_words_for_people(capsys):
    assert main(["play", "--base", "flying"]) == 2
    said = capsys.readouterr().err
    assert "'flying' is not one of 'free'" in said and "Value error" not in said


def test_a_single_frame_is_a_pose():
    Path("a.csv").write_text("time,LShoulderPitch_deg\n0,20\n", encoding="utf-8")
    assert main(["play", "a.csv", "--no-video", "-q"]) == 0
    assert _report("render/a.json")["frames"] == 1


def test_a_folder_that_cannot_be_made_is_said_before_any_work(capsys):
    _short(Path("a.csv"))
    Path("file").write_text("", encoding="utf-8")
    assert "file/deep" in _fails(capsys, "a.csv", "--report", "file/deep/r.json")


@needs_gl
def test_video_report_and_summary_are_written(capsys):
    import av

    _short(Path("a.csv"))
    assert main(["play", "a.csv", "--size", "160x120", "--quality", "draft", "--fps", "10"]) == 0
    with av.open("render/a.mp4") as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    report = _report("render/a.json")
    shown = report["approach_s"] + report["duration_s"] + 0.5
    assert len(frames) == round(10 * shown)
    assert frames[0].shape == (120, 160, 3)
    assert np.std(frames[0]) > 5
    assert np.abs(frames[0].astype(int) - frames[len(frames) // 2]).max() > 50
    assert report["timing"]["gl_backend"] in ("egl", "osmesa", "glfw")
    out = capsys.readouterr().out
    assert "render/a.mp4" in out
    assert "render/a.json" in out


def test_where_nothing_renders_all_else_is_written_and_the_status_is_3(capsys, monkeypatch):
    _short(Path("a.csv"))
    monkeypatch.setenv("MUJOCO_GL", "glfw")
    monkeypatch.delenv("DISPLAY", raising=False)
    assert main(["play", "a.csv", "--rollout", "out.npz"]) == 3
    error = capsys.readouterr().err
    assert "apt-get install" in error
    assert "Traceback" not in error
    assert not Path("render/a.mp4").exists()
    assert len(Rollout.load("out.npz")) > 10
    assert _report("render/a.json")["simulated"]["fell"] is False


@needs_gl
def test_a_run_that_is_ended_in_mid_render_leaves_no_film(tmp_path):
    _short(Path("long.csv"), frames=400)
    words = [sys.executable, "-m", "nao_sim.play", "long.csv", "-q", "--quality", "fine"]
    run = subprocess.Popen(words, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)})
    while run.poll() is None and not list(tmp_path.glob("render/.long*")):
        time.sleep(0.05)
    run.terminate()
    assert run.wait(30) != 0
    assert [path.name for path in (tmp_path / "render").iterdir()] == [".gitignore"]


def test_the_module_is_the_command():
    words = [sys.executable, "-m", "nao_sim.play", "nowhere.csv"]
    done = subprocess.run(
        words, env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert done.stderr.startswith("nao-sim: nowhere.csv")
