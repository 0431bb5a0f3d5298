"""The rollout and its file."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.robot import load_robot
from nao_sim.simulation.rollout import ARRAYS, Rollout


def _rollout(seed: int, steps: int) -> Rollout:
    random = np.random.default_rng(seed)
    joints = random.normal(size=(4, steps, 26))
    joints[0, random.random((steps, 26)) < 0.2] = np.nan
    base = random.normal(size=(steps, 7))
    base[:, 3:] /= np.linalg.norm(base[:, 3:], axis=1, keepdims=True)
    return Rollout(0.02 * np.arange(1, steps + 1), *joints, base)


@given(st.integers(0, 2**31), st.integers(1, 40))
def test_what_is_loaded_is_what_was_saved(tmp_path_factory, seed, steps):
    path = tmp_path_factory.mktemp("rollout") / "run.npz"
    rollout = _rollout(seed, steps)
    rollout.save(path)
    again = Rollout.load(path)
    for name in ARRAYS:
        assert np.array_equal(getattr(again, name), getattr(rollout, name), equal_nan=True)
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
    }


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no zip", b"hello"])
def test_another_file_is_refused_by_name(tmp_path, content):
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"other\.npz: not a rollout .*expected an NPZ"):
        Rollout.load(path)


def test_between_control_steps_poses_are_between_and_quaternions_are_unit():
    rollout = _rollout(3, 30)
    joints, base = rollout.at(np.linspace(0.0, 0.7, 100))
    assert joints.min() >= rollout.joint_positions.min()
    assert joints.max() <= rollout.joint_positions.max()
    assert np.linalg.norm(base[:, 3:], axis=1) == pytest.approx(1.0)
    at_steps, _ = rollout.at(rollout.time)
    assert at_steps == pytest.approx(rollout.joint_positions)
