"""Gestures from the outside: taught by recordings, played, and told."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import numpy as np
import pytest
from gestures.postures import held, skeleton
from gestures.test_gesture_stream import HANG, flapping, ways

from nao_sim.cli import main
from nao_sim.gestures.storage import load_vocabulary, save
from nao_sim.gestures.vocabulary import built_in
from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings import Source, read
from nao_sim.replay import Orders
from nao_sim.robot import load_robot
from nao_sim.simulation.rollout import Rollout
from nao_sim.tasks import task_of
from tests.pictures import needs_gl

PERSON = str(TRAJECTORIES / "person_wave.csv")
ASKEW = held("up", "forward")
ROBOT = load_robot()


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Run in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "signal", lambda *_: None)


def recorded(name, directions, **how):
    """A recording of somebody with arms in directions (T, 2, 2, 3)."""
    somebody = skeleton(directions, **how)
    columns = [f"{joint}_{axis}" for joint in somebody.joints for axis in "xyz"]
    # the file's axes: x to the person's left, y up, z ahead
    points = somebody.positions[..., [1, 2, 0]].reshape(len(somebody), -1)
    rows = [
        ",".join(f"{number:.5f}" for number in (time, *row)) for time, row in zip(somebody.times, points, strict=True)
    ]
    Path(name).write_text("\n".join([",".join(["time", *columns]), *rows]) + "\n", encoding="utf-8")
    return name


def told():
    return json.loads(Path("r.json").read_text(encoding="utf-8"))


def played(name, *words):
    """The labels recognised in a recording, and what the robot did."""
    words = ["play", name, "--mode", "gestures", "--no-video", "-q", "--report", "r.json", "--rollout", "o.npz", *words]
    assert main(words) == 0
    return [row["label"] for row in told()["gestures"]["segments"]], Rollout.load("o.npz")


def asked(name, vocabulary, speed=1.0):
    """The labels recognised in a recording, and what the robot is asked to do then."""
    orders = Orders(Source(Path(name)), vocabulary=vocabulary, speed=speed)
    task = task_of(read(orders.recording), orders, lambda stage, done, total: None)
    return [segment.label for segment in task.recognised.segments], task.motion


def refused(capsys, *words):
    """The one line of a call that ends with status 2 and changes no file."""
    before = {path: path.read_bytes() for path in Path().iterdir()}
    assert main(list(words)) == 2
    out, err = capsys.readouterr()
    assert out == "" and len(err.splitlines()) == 1, err
    assert {path: path.read_bytes() for path in Path().iterdir()} == before
    return err


def test_a_pose_taught_by_one_person_is_recognised_on_another_and_done_by_the_robot(capsys):
    shown = recorded("a.csv", ways((ASKEW, 0.7, 1.2), (HANG, 0.8, 0.5)), noise=0.003)
    assert main(["teach", "left_askew", shown, "--into", "mine.vocab"]) == 0
    out = capsys.readouterr().out
    assert "left_askew, a pose (arms kept still for" in out and "--kind movement" in out
    assert "announced in 1 of 1" in out and "play FILE --mode gestures --vocabulary mine.vocab" in out
    other = recorded("b.csv", ways((ASKEW, 0.5, 2.5), (HANG, 0.8, 1.0)), height=1.3, turn=0.4, noise=0.003, seed=5)
    labels, rollout = played(other, "--vocabulary", "mine.vocab")
    assert "left_askew" in labels
    posture = load_vocabulary(Path("mine.vocab")).motions["left_askew"].positions[0]
    reached = (
        np.nan_to_num(np.abs(rollout.joint_positions - posture)[:, ROBOT.joints_of("LArm", "RArm")]).max(axis=1).min()
    )
    assert np.degrees(reached) < 2.0


def test_the_mirrored_person_makes_the_robot_do_the_mirrored_gesture():
    main(["teach", "left_askew", recorded("a.csv", ways((ASKEW, 0.7, 1.2))), "--into", "m.vocab", "-q"])
    known, directions = load_vocabulary(Path("m.vocab")), ways((ASKEW, 0.5, 2.0), (held("side"), 0.8, 2.0))
    one, motion = asked(recorded("b.csv", directions), known)
    other, twin = asked(recorded("c.csv", directions[:, ::-1] * [1.0, -1.0, 1.0]), known)
    assert "left_askew" in one and other == [label.replace("left", "right") for label in one]
    np.testing.assert_allclose(ROBOT.mirror(twin.positions), motion.positions, atol=1e-6)


def test_a_movement_taught_by_one_person_is_recognised_on_another(capsys):
    assert main(["teach", "right_flap", recorded("a.csv", flapping()), "--into", "mine.vocab"]) == 0
    out = capsys.readouterr().out
    assert "right_flap, a movement" in out and "left_flap, learned from the same" in out
    other = recorded("b.csv", flapping(3, 0.66), height=1.4, turn=-0.3, noise=0.003, seed=3)
    labels, motion = asked(other, load_vocabulary(Path("mine.vocab")))
    assert "right_flap" in labels
    assert np.ptp(motion.positions[:, ROBOT.index["RShoulderRoll"]]) > 0.5


def test_what_was_known_stays_known_and_more_examples_are_added(capsys):
    first, second = recorded("a.csv", flapping(2)), recorded("b.csv", flapping(2, 0.65))
    main(["teach", "right_flap", first, "--into", "mine.vocab", "-q"])
    before = load_vocabulary(Path("mine.vocab"))
    assert main(["teach", "right_flap", second, "--from", "mine.vocab", "--into", "other.vocab"]) == 0
    assert "already: more examples" in capsys.readouterr().out
    after = load_vocabulary(Path("other.vocab"))
    assert after.names == before.names and {"side", "right_flap", "left_flap"} <= set(after.names)
    assert len(after.movements.examples) == 2 * len(before.movements.examples)


def test_a_gesture_like_a_known_one_is_told(capsys):
    assert main(["teach", "wide", recorded("a.csv", ways((held("side"), 0.7, 1.5))), "--into", "mine.vocab"]) == 0
    assert "hard to tell from side: 1 of 1 examples would have been taken for it" in capsys.readouterr().out


def test_a_stretch_of_a_recording_is_an_example(capsys):
    assert main(["teach", "point", PERSON, "--start", "4.9", "--end", "5.9", "--into", "mine.vocab"]) == 0
    assert "point, a pose" in capsys.readouterr().out


def test_what_cannot_be_taught_is_one_line_and_nothing_is_written(capsys):
    angles, still = str(TRAJECTORIES / "wave.csv"), recorded("a.csv", ways((ASKEW, 0.7, 1.5)))
    save(Path("known.vocab"), built_in())
    Path("bad.vocab").write_bytes(Path("known.vocab").read_bytes()[:-200])
    into = ["--into", "mine.vocab"]
    assert "holds joint angles" in refused(capsys, "teach", "x", angles, *into)
    assert "nowhere.csv" in refused(capsys, "teach", "x", "nowhere.csv", *into)
    assert "expected the gesture's name first" in refused(capsys, "teach", still, still, *into)
    assert "which means no gesture" in refused(capsys, "teach", "none", still, *into)
    assert "'side' is a pose already" in refused(capsys, "teach", "side", still, "--kind", "movement", *into)
    assert "expected one" in refused(capsys, "teach", "x", still, still, "--start", "1", *into)
    assert "no frame between" in refused(capsys, "teach", "x", still, "--start", "99", *into)
    assert "a start before the end" in refused(capsys, "teach", "x", still, "--start", "2", "--end", "1", *into)
    assert "expected a movement" in refused(capsys, "teach", "x", still, "--end", "0.1", "--kind", "movement", *into)
    assert "bad.vocab: " in refused(capsys, "teach", "x", still, "--into", "bad.vocab")
    assert "bad.vocab: " in refused(capsys, "teach", "x", still, "--from", "bad.vocab", *into)
    assert "exists and is added to" in refused(
        capsys, "teach", "x", still, "--from", "bad.vocab", "--into", "known.vocab"
    )
    assert "no folder 'deep'" in refused(capsys, "teach", "x", still, "--into", "deep/mine.vocab")
    assert "would overwrite" in refused(capsys, "teach", "x", still, "--into", still)
    assert "bad.vocab: " in refused(capsys, "play", still, "--mode", "gestures", "--vocabulary", "bad.vocab")


def test_gestures_are_told_on_the_screen_and_in_the_report(capsys):
    shown = recorded("a.csv", ways((held("forward", "down"), 0.6, 0.8)))
    assert main(["play", shown, "--mode", "gestures", "--no-video", "--report", "r.json"]) == 0
    out = capsys.readouterr().out
    assert "gestures" in out and "left_forward (" in out and "imitated" not in out
    report = told()
    assert report["similarity"] is None and report["verdict"] == "as_requested"
    assert report["gestures"]["vocabulary"] == list(built_in().names)
    row = next(row for row in report["gestures"]["segments"] if row["label"] == "left_forward")
    assert (
        0.7 < row["start_s"] < 1.2
        and row["end_s"] == pytest.approx(1.7, abs=0.1)
        and 0.5 < row["confidence"] <= 1.0
        and row["has_motion"]
    )


def test_twice_as_fast_is_the_same_in_half_the_time():
    one, two = asked(PERSON, built_in()), asked(PERSON, built_in(), speed=2.0)
    assert one[0] == two[0] and two[1].duration == pytest.approx(one[1].duration / 2.0)
    np.testing.assert_array_equal(one[1].positions, two[1].positions)


def test_both_is_the_report_of_two_robots(capsys):
    shown = recorded("a.csv", ways((held("side"), 0.7, 1.0)))
    assert main(["play", shown, "--mode", "both", "--no-video", "--report", "r.json"]) == 0
    assert "player" in capsys.readouterr().out
    report = told()
    assert report["similarity"]["compared"] > 20 and report["steps"] > 50
    assert [row["label"] for row in report["gestures"]["segments"]][-1] == "side"
    robot = report["gestures"]["robot"]
    assert robot["verdict"] == "as_requested" and robot["simulated"]["self_collision_frames"] == 0
    for option in (["--rollout", "o.npz"], ["--show-safety"], ["--overlay", "all"], ["--camera", "head"]):
        assert "is for one robot" in refused(capsys, "play", shown, "--mode", "both", *option)


@needs_gl
def test_the_film_names_the_gesture():
    import av

    words = [
        "play",
        recorded("a.csv", ways((held("side"), 0.7, 1.0))),
        "--mode",
        "gestures",
        "-q",
        "--quality",
        "draft",
    ]
    assert main([*words, "--size", "320x240", "--fps", "10", "--hide-person"]) == 0
    with av.open("render/a.mp4") as film:
        frames = [frame.to_ndarray(format="rgb24").astype(int) for frame in film.decode(video=0)]
    changes = [np.abs(frame - frames[-1])[215:232, 10:80].mean() for frame in frames]
    assert changes[0] < 1.0 and max(changes) > 5.0
