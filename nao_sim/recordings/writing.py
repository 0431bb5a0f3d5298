"""Write a joint trajectory as the CSV that `joint_csv` reads."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from nao_sim.files import beside
from nao_sim.motion import JointTrajectory
from nao_sim.recordings.joint_csv import TIME
from nao_sim.robot import load_robot

DECIMALS = 4  # of a degree and of a hand's opening


def joint_csv_text(motion: JointTrajectory, comments: Sequence[str] = (), decimals: int = DECIMALS) -> str:
    """The trajectory as joint-angle CSV, degrees by suffix.

    Args:
        motion: only its `given` joints become columns; nan becomes an empty
            cell, infinities stay.
        comments: lines to put above the header, without their `#`.
        decimals: digits after the point of degrees and openings.

    Returns:
        The file's text.
    """
    robot = load_robot()
    joints = np.flatnonzero(motion.given)
    names = [robot.joint_names[i] + ("" if robot.is_hand[i] else "_deg") for i in joints]
    values = motion.positions[:, joints] * [robot.report_unit(int(i)) for i in joints]
    lines = [f"# {comment}" for comment in comments] + [",".join([TIME, *names])]
    for time, row in zip(motion.times.tolist(), values.tolist(), strict=True):
        lines.append(",".join([f"{time:.12g}", *(_cell(value, decimals) for value in row)]))
    return "\n".join(lines) + "\n"


def write_joint_csv(path: str | Path, motion: JointTrajectory, comments: Sequence[str] = ()) -> None:
    """Write `joint_csv_text` to a file, beside it first so that none is left half-written.

    Args:
        path: the file, replaced if it is there.
        motion: the trajectory.
        comments: lines to put above the header, without their `#`.
    """
    with beside(Path(path)) as draft:
        draft.write_text(joint_csv_text(motion, comments), encoding="utf-8", newline="\n")


def _cell(value: float, decimals: int) -> str:
    if np.isnan(value):
        return ""
    text = f"{value:.{decimals}f}"
    return text.removeprefix("-") if float(text) == 0.0 else text
