"""The rollout and its file."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.robot import load_robot
from nao_sim.simulation.rollout import ARRAYS, Rollout, is_rollout


def _rollout(seed: int, steps: int) -> Rollout:
    random = np.random.default_rng(seed)
    joints = random.normal(size=(4, steps, 26))
    joints[0, random.random((steps, 26)) < 0.2] = np.nan
    base = random.normal(size=(steps, 7))
    base[:, 3:] /= np.linalg.norm(base[:, 3:], axis=1, keepdims=True)
    clock = {"motion_start": random.uniform(0.0, 3.0), "speed": random.uniform(0.1, 3.0)}
    return Rollout(0.02 * np.arange(1, steps + 1), *joints, base, **clock)


@given(st.integers(0, 2**31), st.integers(1, 40))
def test_what_is_loaded_is_what_was_saved(tmp_path_factory, seed, steps):
    path = tmp_path_factory.mktemp("rollout") / "run.npz"
    rollout = _rollout(seed, steps)
    rollout.save(path)
    again = Rollout.load(path)
    for name in ARRAYS:
        assert np.array_equal(getattr(again, name), getattr(rollout, name), equal_nan=True)
    assert (again.motion_start, again.speed) == (rollout.motion_start, rollout.speed)
    assert [file.name for file in path.parent.iterdir()] == ["run.npz"]


def test_the_file_holds_what_is_documented_and_nothing_else(tmp_path):
    _rollout(0, 5).save(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz", allow_pickle=False) as file:
        shapes = {name: file[name].shape for name in file.files}
        assert tuple(file["joint_names"]) == load_robot().joint_names
    assert shapes == {
        "time": (5,),
        "joint_names": (26,),
        "requested": (5, 26),
        "command": (5, 26),
        "joint_positions": (5, 26),
        "joint_velocities": (5, 26),
        "base_pose": (5, 7),
        "motion_start": (),
        "speed": (),
    }


def _arrays(steps: int = 5) -> dict[str, np.ndarray]:
    rollout = _rollout(1, steps)
    return {name: getattr(rollout, name) for name in ARRAYS} | {"joint_names": np.array(load_robot().joint_names)}


def test_a_file_of_before_the_clock_was_kept_still_loads(tmp_path):
    np.savez_compressed(tmp_path / "old.npz", **_arrays())
    again = Rollout.load(tmp_path / "old.npz")
    assert (again.motion_start, again.speed) == (0.0, 1.0)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no zip", b"hello", b"\x93NUMPY\x01\x00v\x00{"])
def test_another_file_is_refused_by_name(tmp_path, content):
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    assert not is_rollout(path)
    with pytest.raises(RecordingError, match=r"other\.npz: not a rollout .*expected an NPZ"):
        Rollout.load(path)


def test_a_missing_file_is_said_to_be_missing(tmp_path):
    with pytest.raises(RecordingError, match="no such file; expected an NPZ written with --rollout"):
        Rollout.load(tmp_path / "none.npz")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"command": np.zeros((5, 25))}, r"column command: an array of shape \(5, 25\); expected shape \(5, 26\)"),
        ({"base_pose": np.zeros((4, 7))}, "column base_pose: an array of shape"),
        ({"time": np.zeros(5)}, "column time: times that do not increase"),
        ({"time": np.array([0.1, 0.2, np.nan, 0.4, 0.5])}, "column time: a value that is not a number"),
        ({"joint_positions": np.full((5, 26), np.inf)}, "column joint_positions: a value that is not a number"),
        ({"joint_names": np.array(["a", "b"])}, "column joint_names: other joints"),
        ({"command": np.array(["text"])}, "not a rollout"),
        ({"speed": np.array(0.0)}, "not a rollout .*speed 0"),
        ({"motion_start": np.array([1.0, 2.0])}, "not a rollout"),
    ],
)
def test_arrays_that_are_no_rollouts_are_named(tmp_path, changes, message):
    np.savez_compressed(tmp_path / "odd.npz", **(_arrays() | changes))
    assert is_rollout(tmp_path / "odd.npz")
    with pytest.raises(RecordingError, match=message):
        Rollout.load(tmp_path / "odd.npz")


def test_a_rollout_without_steps_is_refused(tmp_path):
    arrays = {name: array[:0] if name in ARRAYS else array for name, array in _arrays().items()}
    np.savez_compressed(tmp_path / "empty.npz", **arrays)
    with pytest.raises(RecordingError, match=r"column time: an array of shape .*expected shape \(T,\) with T >= 1"):
        Rollout.load(tmp_path / "empty.npz")


def test_a_cut_file_is_refused(tmp_path):
    _rollout(0, 50).save(tmp_path / "run.npz")
    content = (tmp_path / "run.npz").read_bytes()
    (tmp_path / "cut.npz").write_bytes(content[: len(content) // 2])
    with pytest.raises(RecordingError, match="not a rollout"):
        Rollout.load(tmp_path / "cut.npz")


def test_the_performance_says_when_the_recording_began(simulator):
    from nao_sim.motion import JointTrajectory
    from nao_sim.simulation.performance import perform

    motion = JointTrajectory(np.array([0.0, 0.1]), np.zeros((2, 26)))
    performance = perform(motion, simulator("pinned"))
    assert performance.rollout.motion_start == performance.approach > 0.5
    assert performance.rollout.speed == 1.0


def test_between_control_steps_poses_are_between_and_quaternions_are_unit():
    rollout = _rollout(3, 30)
    joints, base = rollout.at(np.linspace(0.0, 0.7, 100))
    assert joints.min() >= rollout.joint_positions.min()
    assert joints.max() <= rollout.joint_positions.max()
    assert np.linalg.norm(base[:, 3:], axis=1) == pytest.approx(1.0)
    at_steps, _ = rollout.at(rollout.time)
    assert at_steps == pytest.approx(rollout.joint_positions)
