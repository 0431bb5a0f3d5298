"""A finished run: what was asked, commanded and done, at 50 Hz."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from nao_sim.errors import RecordingError
from nao_sim.files import beside
from nao_sim.robot import Array, load_robot, read_only
from nao_sim.simulation.simulator import State

ARRAYS = ("time", "requested", "command", "joint_positions", "joint_velocities", "base_pose")


@dataclass(frozen=True, eq=False)
class Rollout:
    """Arrays of one run, T control steps.

    Attributes:
        time: (T,) s.
        requested: (T, 26) what the recording asked for; not finite where it asked nothing.
        command: (T, 26) what the guard let through.
        joint_positions: (T, 26) of the simulated joints, rad (hands 0..1).
        joint_velocities: (T, 26) rad/s.
        base_pose: (T, 7) torso pose, m and unit quaternion (x, y, z, qw, qx, qy, qz).
    """

    time: Array
    requested: Array
    command: Array
    joint_positions: Array
    joint_velocities: Array
    base_pose: Array

    def __post_init__(self) -> None:
        for name in ARRAYS:
            object.__setattr__(self, name, read_only(getattr(self, name)))

    def __len__(self) -> int:
        return len(self.time)

    @classmethod
    def of(cls, time: Array, requested: Array, commands: list[Array], states: list[State]) -> Rollout:
        """Stack the control steps of a run."""
        return cls(
            time=time,
            requested=requested,
            command=np.array(commands),
            joint_positions=np.array([state.positions for state in states]),
            joint_velocities=np.array([state.velocities for state in states]),
            base_pose=np.array([state.base_pose for state in states]),
        )

    def at(self, times: Array) -> tuple[Array, Array]:
        """Joint positions (N, 26) and base poses (N, 7) at `times` (N,), for pictures between control steps."""
        joints = np.column_stack([np.interp(times, self.time, column) for column in self.joint_positions.T])
        base = np.column_stack([np.interp(times, self.time, column) for column in self.base_pose.T])
        base[:, 3:] /= np.linalg.norm(base[:, 3:], axis=1, keepdims=True)
        return joints, base

    def save(self, path: str | Path) -> None:
        """Write the NPZ: the arrays above and `joint_names` (26,)."""
        arrays: dict[str, Any] = {name: getattr(self, name) for name in ARRAYS}
        with beside(Path(path)) as draft, draft.open("wb") as file:
            np.savez_compressed(file, joint_names=np.array(load_robot().joint_names), **arrays)

    @classmethod
    def load(cls, path: str | Path) -> Rollout:
        """Read what `save` wrote.

        Raises:
            RecordingError: not such a file, or of other joints.
        """
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in ARRAYS}
                names = tuple(file["joint_names"])
        except (OSError, ValueError, KeyError, EOFError, BadZipFile) as error:
            raise RecordingError(path, f"not a rollout ({error})", "an NPZ written with --rollout") from error
        if names != load_robot().joint_names:
            raise RecordingError(path, "other joints", "the 26 NAOqi joints in NAOqi order", column="joint_names")
        return cls(**arrays)
