"""People from the outside: a recording of somebody in, a film, a report or joint angles out."""

from __future__ import annotations

import json
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nao_sim.cli import main
from nao_sim.imitation.retarget import retarget
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.recordings import load
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.robot import load_robot
from tests.people import person
from tests.pictures import needs_gl

KINECT = next(layout for layout in builtin() if layout.name == "Kinect v2")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)


def kinect_file(somebody: Skeleton, name: str = "kinect.csv") -> Path:
    """What a Kinect v2 of this person gives: 100 ns ticks, then x y z and state of each joint."""
    sensor = np.stack([np.stack([-t[:, 1], t[:, 2], 3.0 - t[:, 0]], axis=1)
                       for t in (somebody.track(joint) for joint in KINECT.joints)], axis=1)  # fmt: skip
    lines = []
    for time, frame in zip(somebody.times, sensor, strict=True):
        cells = ",".join(f"{x:.6f},{y:.6f},{z:.6f},2" for x, y, z in frame)
        lines.append(f"{round((9000 + time) * 1e7)},{cells}")
    Path(name).write_text("\n".join(lines) + "\n", encoding="utf-8")
    return Path(name)


def report() -> dict:
    return json.loads(Path("r.json").read_text(encoding="utf-8"))


def test_a_person_is_played_safely_and_scored(capsys):
    file = kinect_file(person(frames=60))
    assert main(["play", str(file), "--no-video", "--report", "r.json", "--rollout", "o.npz"]) == 0
    told = report()
    assert told["format"] == "skeleton text" and "Kinect v2" in told["format_reason"]
    assert told["simulated"]["limit_violations"] == 0 and told["simulated"]["self_collision_frames"] == 0
    assert not told["simulated"]["fell"]
    asked = told["similarity"]["stages"]["requested"]
    assert asked["excess_deg"]["mean"] < 2.0  # the filters' share: what is asked is NAO's nearest pose
    out = capsys.readouterr().out
    assert "imitated" in out and "from where they should point" in out


def test_the_report_s_score_is_the_one_that_compare_gives():
    file = kinect_file(person(frames=60))
    assert main(["play", str(file), "--no-video", "--report", "r.json", "--rollout", "o.npz", "--speed", "0.5"]) == 0
    assert main(["compare", str(file), "o.npz", "--json", "c.json"]) == 0
    assert json.loads(Path("c.json").read_text(encoding="utf-8"))["similarity"] == report()["similarity"]


@needs_gl
def test_the_film_shows_the_person_beside_the_robot_unless_told_not_to():
    from PIL import Image

    file = kinect_file(person(frames=8))
    small = ["--size", "160x120", "--fps", "5", "--quality", "draft", "-q"]
    assert main(["play", str(file), "--video", "with.png", *small]) == 0
    assert main(["play", str(file), "--video", "alone.png", "--hide-person", *small]) == 0
    pictures = {}
    for name in ("with", "alone"):
        frames = sorted(Path(name).glob("*.png"))
        pictures[name] = np.asarray(Image.open(frames[-1])).astype(int)
    blue = {name: ((p[:, :, 2] - p[:, :, 0]) > 60).sum() for name, p in pictures.items()}
    assert blue["with"] > blue["alone"] + 20  # the person's left side


@pytest.mark.parametrize("extension", [".csv", ".npz", ".py", ".motion"])
def test_retargeted_angles_are_a_recording_of_a_nao(extension, capsys):
    file = kinect_file(person(frames=30))
    target = f"angles{extension}"
    assert main(["retarget", str(file), "-o", target]) == 0
    assert f"written  {target}: 30 frames of HeadPitch" in capsys.readouterr().out
    motion, robot = load(target).motion, load_robot()
    assert isinstance(motion, JointTrajectory) and len(motion) == 30
    asked = motion.positions[:, motion.given]
    assert (asked >= robot.lower[motion.given] - 1e-6).all() and (asked <= robot.upper[motion.given] + 1e-6).all()


def test_played_angles_are_the_played_person():
    file = kinect_file(person(frames=40))
    assert main(["retarget", str(file), "-o", "angles.npz"]) == 0
    for name in (str(file), "angles.npz"):
        assert (
            main(["play", name, "--no-video", "-q", "--report", "r.json", "--rollout", f"{Path(name).stem}.o.npz"]) == 0
        )
    one, other = (np.load(f"{stem}.o.npz")["joint_positions"] for stem in ("kinect", "angles"))
    np.testing.assert_allclose(one, other, atol=1e-6)


@pytest.fixture(scope="module")
def trembling() -> Skeleton:
    somebody = person(frames=45, seed=2)
    noise = np.random.default_rng(0).normal(0.0, 0.008, somebody.positions.shape)
    return replace(somebody, positions=somebody.positions + noise)


@pytest.fixture(scope="module")
def plainly(trembling) -> np.ndarray:
    return retarget(trembling).motion.positions


@pytest.mark.parametrize("options", [["--match", "hands"], ["--body", "whole"], ["--raw"]], ids="".join)
def test_the_other_ways_to_imitate_are_safe_too_and_differ(options, trembling, plainly):
    file = str(kinect_file(trembling))
    assert main(["play", file, "--no-video", "-q", "--report", "r.json", *options]) == 0
    told = report()["simulated"]
    assert told["limit_violations"] == 0 and told["self_collision_frames"] == 0 and not told["fell"]
    assert main(["retarget", file, "-o", "other.npz", *options]) == 0
    assert not np.array_equal(load("other.npz").motion.positions, plainly, equal_nan=True)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["retarget", "kinect.csv", "-o", "kinect.csv"], "would overwrite the recording"),
        (["retarget", "kinect.csv", "-o", "angles.txt"], "extension '.txt'"),
        (["retarget", "angles.csv", "-o", "b.csv"], "holds joint angles (joint-angle CSV) already"),
        (["retarget", "hands.csv", "-o", "b.csv"], "no arm to imitate"),
        (["play", "hands.csv", "--no-video"], "no arm to imitate"),
        (["play", "angles.csv", "--no-video", "--match", "hands"], "expected a person's recording for --match hands"),
        (["play", "angles.csv", "--no-video", "--body", "whole"], "expected a person's recording for --body whole"),
        (["play", "angles.csv", "--no-video", "--raw"], "expected a person's recording for --raw"),
        (["play", "kinect.csv", "--no-video", "--layout", "none.toml"], "none.toml"),
    ],
)
def test_what_cannot_be_done_is_one_line_and_nothing_written(words, says, capsys):
    kinect_file(person(frames=10))
    Path("angles.csv").write_text("time,HeadYaw_deg\n0,1\n1,2\n", encoding="utf-8")
    head = "time,left_hand_x,left_hand_y,left_hand_z,right_hand_x,right_hand_y,right_hand_z"
    rows = [f"{0.1 * i},0.3,0.{i},1.0,0.3,-0.{i},1.0" for i in range(10)]
    Path("hands.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    before = sorted(Path.cwd().iterdir())
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert out == "" and len(err.splitlines()) == 1 and says in err, err
    assert sorted(path for path in Path.cwd().iterdir() if path.name != "render") == before
