"""Write joint trajectories, each format as its reader reads it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.files import beside
from nao_sim.motion import JointTrajectory
from nao_sim.recordings.angles.choregraphe_python import python_text
from nao_sim.recordings.angles.joint_csv import TIME
from nao_sim.recordings.angles.joint_npz import npz_arrays
from nao_sim.recordings.angles.webots_motion import motion_text
from nao_sim.robot import load_robot

DECIMALS = 4  # of a degree and of a hand's opening


def joint_csv_text(motion: JointTrajectory, comments: Sequence[str] = (), decimals: int | None = DECIMALS) -> str:
    """The trajectory as joint-angle CSV, its unit by suffix.

    Args:
        motion: only its `given` joints become columns; nan becomes an empty
            cell, infinities stay.
        comments: lines to put above the header, without their `#`.
        decimals: digits after the point of degrees and openings; None for
            radians, exact to the last bit.

    Returns:
        The file's text.
    """
    robot, exact = load_robot(), decimals is None
    joints = np.flatnonzero(motion.given)
    suffix = "_rad" if exact else "_deg"
    names = [robot.joint_names[i] + ("" if robot.is_hand[i] else suffix) for i in joints]
    values = motion.positions[:, joints] * [1.0 if exact else robot.report_unit(int(i)) for i in joints]
    lines = [f"# {comment}" for comment in comments] + [",".join([TIME, *names])]
    for time, row in zip(motion.times.tolist(), values.tolist(), strict=True):
        clock = repr(time) if exact else f"{time:.12g}"
        lines.append(",".join([clock, *(_cell(value, decimals) for value in row)]))
    return "\n".join(lines) + "\n"


def _cell(value: float, decimals: int | None) -> str:
    if np.isnan(value):
        return ""
    text = repr(value) if decimals is None else f"{value:.{decimals}f}"
    return text.removeprefix("-") if decimals is not None and float(text) == 0.0 else text


def write_joint_csv(path: str | Path, motion: JointTrajectory, comments: Sequence[str] = ()) -> None:
    """Write `joint_csv_text` to a file, beside it first so that none is left half-written.

    Args:
        path: the file, replaced if it is there.
        motion: the trajectory.
        comments: lines to put above the header, without their `#`.
    """
    with beside(Path(path)) as draft:
        _write_text(draft, joint_csv_text(motion, comments))


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")


def _write_npz(path: Path, motion: JointTrajectory) -> None:
    with path.open("wb") as file:
        np.savez_compressed(file, **npz_arrays(motion))


# By the file's extension: what writes it, and the format's name for the user.
WRITERS: Mapping[str, tuple[str, Callable[[Path, JointTrajectory], None]]] = {
    ".csv": ("joint-angle CSV", lambda path, motion: _write_text(path, joint_csv_text(motion, decimals=None))),
    ".motion": ("Webots motion", lambda path, motion: _write_text(path, motion_text(from_zero(motion)))),
    ".npz": ("joint-angle NPZ", _write_npz),
    ".py": ("Choregraphe Python lists", lambda path, motion: _write_text(path, python_text(from_zero(motion)))),
}


def check_extension(path: Path) -> str:
    """The extension that says how to write a file.

    Raises:
        UsageError: no such format is written.
    """
    if (extension := path.suffix.lower()) not in WRITERS:
        known = ", ".join(f"{known} ({name})" for known, (name, _) in WRITERS.items())
        raise UsageError(f"{path}: extension '{path.suffix}' is not one that is written; expected {known}")
    return extension


def write_motion(path: str | Path, motion: JointTrajectory) -> None:
    """Write a trajectory in the format of the file's extension, as exactly as it can hold it.

    Args:
        path: .csv, .motion, .npz or .py; replaced, whole or not at all, if it is there.
        motion: the trajectory.

    Raises:
        UsageError: no such format is written, it cannot hold this motion at
            all, or the file cannot be written there.
    """
    check_extension(Path(path))
    with beside(Path(path)) as draft:
        write_draft(draft, motion)


def write_draft(path: Path, motion: JointTrajectory) -> None:
    """`write_motion` straight to a file that nobody else looks at yet."""
    WRITERS[check_extension(path)][1](path, motion)


def from_zero(motion: JointTrajectory) -> JointTrajectory:
    """The motion, begun at time 0 where it would begin before."""
    if motion.times[0] >= 0.0:
        return motion
    return JointTrajectory(motion.times - motion.times[0], motion.positions, motion.given)
