"""A finished run: what was asked, commanded and done, at 50 Hz."""

from __future__ import annotations

import math
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

import numpy as np

from nao_sim.errors import RecordingError
from nao_sim.files import beside
from nao_sim.robot import Array, load_robot, read_only
from nao_sim.simulation.simulator import State

ARRAYS = ("time", "requested", "command", "joint_positions", "joint_velocities", "base_pose")
CLOCK = {"motion_start": 0.0, "speed": 1.0}  # what holds for files that do not say
_SHAPES = {"time": (), "base_pose": (7,)}  # of one control step; all else is of the 26 joints
_UNREADABLE = (
    OSError, ValueError, KeyError, TypeError, AttributeError, EOFError, MemoryError, NotImplementedError,
    BadZipFile, zlib.error, struct.error,
)  # fmt: skip


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
        motion_start: s, when the recording's first frame was asked for.
        speed: times as fast as recorded.
    """

    time: Array
    requested: Array
    command: Array
    joint_positions: Array
    joint_velocities: Array
    base_pose: Array
    motion_start: float = CLOCK["motion_start"]
    speed: float = CLOCK["speed"]

    def __post_init__(self) -> None:
        for name in ARRAYS:
            object.__setattr__(self, name, read_only(getattr(self, name)))
        if not (math.isfinite(self.motion_start) and math.isfinite(self.speed) and self.speed > 0.0):
            raise ValueError(
                f"motion_start {self.motion_start:g} s, speed {self.speed:g}; expected a time and a factor"
            )

    def __len__(self) -> int:
        return len(self.time)

    @classmethod
    def of(
        cls,
        time: Array,
        requested: Array,
        commands: list[Array],
        states: list[State],
        motion_start: float = CLOCK["motion_start"],
    ) -> Rollout:
        """Stack the control steps of a run."""
        return cls(
            time=time,
            requested=requested,
            command=np.array(commands),
            joint_positions=np.array([state.positions for state in states]),
            joint_velocities=np.array([state.velocities for state in states]),
            base_pose=np.array([state.base_pose for state in states]),
            motion_start=motion_start,
        )

    def at(self, times: Array) -> tuple[Array, Array]:
        """Joint positions (N, 26) and base poses (N, 7) at `times` (N,), for pictures between control steps."""
        joints = np.column_stack([np.interp(times, self.time, column) for column in self.joint_positions.T])
        base = np.column_stack([np.interp(times, self.time, column) for column in self.base_pose.T])
        base[:, 3:] /= np.linalg.norm(base[:, 3:], axis=1, keepdims=True)
        return joints, base

    def save(self, path: str | Path) -> None:
        """Write the NPZ: the arrays above, their two numbers and `joint_names` (26,)."""
        arrays: dict[str, Any] = {name: getattr(self, name) for name in (*ARRAYS, *CLOCK)}
        with beside(Path(path)) as draft, draft.open("wb") as file:
            np.savez_compressed(file, joint_names=np.array(load_robot().joint_names), **arrays)

    @classmethod
    def load(cls, path: str | Path) -> Rollout:
        """Read what `save` wrote.

        Raises:
            RecordingError: not such a file, or of other joints.
        """
        expected = "an NPZ written with --rollout"
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays: dict[str, Any] = {name: np.asarray(file[name], float) for name in ARRAYS}
                clock: dict[str, Any] = {
                    name: float(file[name]) if name in file else usual for name, usual in CLOCK.items()
                }
                names = tuple(file["joint_names"])
            if wrong := _misfit(arrays, names):
                raise RecordingError(path, wrong[1], wrong[2], column=wrong[0])
            return cls(**arrays, **clock)
        except FileNotFoundError:
            raise RecordingError(path, "no such file", expected) from None
        except _UNREADABLE as error:
            raise RecordingError(path, f"not a rollout ({error})", expected) from error


def is_rollout(path: str | Path) -> bool:
    """Whether a file is an NPZ with a rollout's arrays."""
    try:
        with ZipFile(path) as file:
            return {f"{name}.npy" for name in ARRAYS} <= set(file.namelist())
    except (OSError, ValueError, BadZipFile, NotImplementedError):
        return False


def _misfit(arrays: dict[str, Array], names: tuple[str, ...]) -> tuple[str, str, str] | None:
    """The first array that is none of a rollout's: its name, what was found, what was expected."""
    known = load_robot().joint_names
    if names != known:
        return "joint_names", "other joints", "the 26 NAOqi joints in NAOqi order"
    steps = np.size(arrays["time"])
    for name, array in arrays.items():
        shape = (steps, *_SHAPES.get(name, (len(known),)))
        if array.shape != shape or not steps:
            return name, f"an array of shape {array.shape}", f"shape {shape if steps else '(T,) with T >= 1'}"
        if name != "requested" and not np.isfinite(array).all():
            return name, "a value that is not a number", "finite values"
    if (np.diff(arrays["time"]) <= 0.0).any():
        return "time", "times that do not increase", "strictly increasing times"
    return None
