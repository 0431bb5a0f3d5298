"""`nao-sim compare`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from nao_sim.cli import main
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import load, write_joint_csv
from nao_sim.robot import load_robot
from nao_sim.simulation.rollout import Rollout
from tests.bodies import smooth_motion

ROBOT = load_robot()
ARMS = [name[1:].startswith(("Shoulder", "Elbow")) for name in ROBOT.joint_names]


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    """An empty folder with a recording, a rollout that does it a tenth of a second late, and the angles alone."""
    monkeypatch.chdir(tmp_path)
    motion = smooth_motion(1, 4.0)
    motion = JointTrajectory(motion.times, np.where(ARMS, motion.positions, np.nan), np.array(ARMS))
    write_joint_csv("human.csv", motion)
    positions = np.nan_to_num(motion.positions)
    _write_rollout("run.npz", JointTrajectory(motion.times, positions))


def _write_rollout(name: str, motion: JointTrajectory, speed: float = 1.0) -> None:
    times, start = 0.02 * np.arange(1, 301), 1.0
    asked, done = (motion.sample(speed * (times - start - late)) for late in (0.0, 0.1))
    pose = np.tile([0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0], (len(times), 1))
    Rollout(times, asked, asked, done, np.zeros_like(done), pose, motion_start=start, speed=speed).save(name)


def _json(name: str = "score.json") -> dict:
    return json.loads(Path(name).read_text(encoding="utf-8"))


def test_the_rollout_alone_says_when_and_how_fast_the_recording_was_imitated():
    motion = load("human.csv").motion
    positions = np.nan_to_num(motion.positions)
    _write_rollout("fast.npz", JointTrajectory(motion.times, positions), speed=2.0)
    for name, late in (("run.npz", 100.0), ("fast.npz", 100.0)):
        assert main(["compare", "human.csv", name, "--json", "score.json"]) == 0
        stages = _json()["similarity"]["stages"]
        assert list(stages) == ["requested", "commanded", "simulated"]
        assert stages["commanded"]["direction_error_deg"]["all"]["p95"] < 0.2
        assert stages["commanded"]["lag_ms"] == pytest.approx(0.0, abs=2.0)
        assert stages["simulated"]["direction_error_deg"]["all"]["mean"] > 1.0
        assert stages["simulated"]["lag_ms"] == pytest.approx(late, abs=2.0)


def test_what_is_printed_is_what_is_written(capsys):
    assert main(["compare", "human.csv", "run.npz", "--json", "score.json"]) == 0
    out, err = capsys.readouterr()
    assert err == "" and out.splitlines()[0] == "run.npz imitating human.csv" and out.splitlines()[-1] == "score.json"
    assert max(len(line.rstrip()) for line in out.splitlines()) <= 80
    error = _json()["similarity"]["stages"]["simulated"]["direction_error_deg"]["all"]["mean"]
    (line,) = (line for line in out.splitlines() if line.startswith("both arms (°)"))
    assert line.split()[-1] == f"{error:.1f}"
    assert "100 % (left)" in out and "delay (ms)" in out


def test_joint_angles_are_one_stage_and_begin_with_the_human():
    motion = load("human.csv").motion
    write_joint_csv("later.csv", JointTrajectory(motion.times + 7.0, motion.positions, motion.given))
    assert main(["compare", "human.csv", "later.csv", "--json", "score.json"]) == 0
    stages = _json()["similarity"]["stages"]
    assert list(stages) == ["requested"] and stages["requested"]["direction_error_deg"]["all"]["p95"] < 0.01
    assert stages["requested"]["wbf"]["mean"] == 1.0


def test_the_plot_is_a_picture():
    assert main(["compare", "human.csv", "run.npz", "--plot", "error.png"]) == 0
    assert Path("error.png").read_bytes().startswith(b"\x89PNG")
    assert sorted(path.name for path in Path().iterdir()) == ["error.png", "human.csv", "run.npz"]


def test_every_key_of_the_json_is_documented():
    main(["compare", "human.csv", "run.npz", "--json", "score.json"])
    documented = (Path(__file__).resolve().parents[1] / "docs" / "report.md").read_text(encoding="utf-8")
    assert all(f"`{key}`" in documented for key in _json())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["none.csv", "run.npz"], "none.csv"),
        (["human.csv", "none.npz"], "none.npz"),
        (["human.csv", "cut.npz"], "cut.npz"),
        (["human.csv", "elsewhere.npz"], "elsewhere.npz: has no moment in common with human.csv"),
        (["human.csv", "run.npz", "--json", "human.csv"], "human.csv: would overwrite the recording"),
        (["human.csv", "run.npz", "--json", "a.png", "--plot", "a.png"], "a.png: named for two results"),
        (["human.csv", "run.npz", "--json", "."], "is a folder; expected the name of a file"),
        (["human.csv", "run.npz", "--json", "none/score.json"], "none/score.json: cannot write there"),
        (
            ["human.csv", "run.npz", "--plot", "error.bmp"],
            "--plot error.bmp: expected a name that ends in .png, .svg or .pdf",
        ),
        (["human.csv", "run.npz", "--robot", "v7"], "v7"),
        (["human.csv"], "rollout"),
        (["human.csv", "ages.csv"], "ages.csv: lasts 277.8 hours; expected at most 2"),
    ],
)
def test_what_cannot_be_is_one_line_and_status_2(words, message, capsys):
    content = Path("run.npz").read_bytes()
    Path("ages.csv").write_text("time,LShoulderPitch_deg\n0,80\n1e6,90\n", encoding="utf-8")
    Path("cut.npz").write_bytes(content[: len(content) // 2])
    rollout = Rollout.load("run.npz")
    Rollout(**{name: getattr(rollout, name) for name in rollout.__dataclass_fields__} | {"motion_start": 99.0}).save(
        "elsewhere.npz"
    )
    before = {path: path.read_bytes() for path in Path().iterdir()}
    assert main(["compare", *words]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and message in err
    assert {path: path.read_bytes() for path in Path().iterdir()} == before


def test_a_person_is_no_robot(monkeypatch, capsys):
    from nao_sim import recordings
    from nao_sim.recordings.recording import Recording

    person = Skeleton(np.array([0.0]), np.zeros((1, 1, 3)), ("head",))
    read = recordings.load
    monkeypatch.setattr(
        recordings,
        "load",
        lambda path, *rest, **more: (
            Recording(path, "text", "said so", person, 1)
            if Path(path).name == "person.txt"
            else read(path, *rest, **more)
        ),
    )
    assert main(["compare", "human.csv", "person.txt"]) == 2
    assert "person.txt: a person (text); expected a robot's motion, from play or retarget" in capsys.readouterr().err


def test_a_robot_that_moved_much_longer_than_the_recording_is_doubted(capsys):
    motion = load("human.csv").motion
    longer = np.concatenate([motion.times, motion.times[-1] + np.arange(1.0, 9.0)])
    positions = np.concatenate([motion.positions, np.repeat(motion.positions[-1:], 8, axis=0)])
    write_joint_csv("longer.csv", JointTrajectory(longer, positions, motion.given))
    assert main(["compare", "human.csv", "longer.csv"]) == 0
    assert "lasts 4.0 s, but the robot moved for 12.0 s" in capsys.readouterr().out
    assert main(["compare", "human.csv", "human.csv"]) == 0
    assert "is it this recording" not in capsys.readouterr().out
