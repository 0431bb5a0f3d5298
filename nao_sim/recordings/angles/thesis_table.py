"""The training table of I. I. Itauma's MSc thesis: one posture of both arms a row.

The header is `RSR,RSP,RER,REY,RH,LSR,LSP,LER,LEY,LH` in any order and case,
with a label column `Behavior` or `y` where the rows are labelled; degrees by
definition (`nao_sim.imitation.features`).  The rows have no times, so the robot
shows one posture after the other: it holds each and goes smoothly to the next.
"""

from __future__ import annotations

import numpy as np

from nao_sim.imitation.arms import arm_positions
from nao_sim.imitation.features import FEATURES, directions_of, elbow_disagreement
from nao_sim.motion import JointTrajectory
from nao_sim.recordings.angles.fixed_options import refuse_options
from nao_sim.recordings.recording import Label, Recording
from nao_sim.recordings.source import Source
from nao_sim.recordings.table import Header, cells, check_columns, header_of, number, rows
from nao_sim.robot import Array
from nao_sim.smooth_step import PEAK_SPEED, minimum_jerk

NAME = "thesis table"
LOOKS = "the header RSR,RSP,RER,REY,RH,LSR,LSP,LER,LEY,LH[,Behavior]"
LABELS = ("behavior", "y")
HOLD = 1.0  # s, each posture stands
TRANSITION = 0.8  # s, the shortest way between two
COMFORTABLE = 3.0  # rad/s, the fastest any joint turns on the way; NAO's arms can do 6.5
RATE = 50.0  # Hz
SUSPECT = np.radians(25.0)  # a row whose elbow is off by more contradicts itself


def recognise(source: Source) -> str | None:
    """Why the file is a thesis table, or None."""
    line = source.header()
    columns = [name.upper() for name in header_of(line).columns] if line else []
    present = [name for name in FEATURES if name in columns]
    many = len(FEATURES) // 2
    return f"the header names {len(present)} of the thesis's ten features" if len(present) >= many else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file.
        reason: why it is taken for this format.

    Returns:
        The recording: the two arms' pitch, roll and yaw angles, sampled at
        `RATE`, and a label for each posture of a labelled table.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    refuse_options(source, "a thesis table", "deg", "is postures without times")
    lines, features, labels = postures(source)
    poses = arm_positions(directions_of(features))
    holds, motion = in_sequence(poses)
    named = tuple(Label(name, start, end) for name, (start, end) in zip(labels, holds, strict=False))
    return Recording(source.path, NAME, reason, motion, len(lines), _notes(lines, features), named)


def postures(source: Source) -> tuple[list[int], Array, list[str]]:
    """The rows as they stand in the file.

    Returns:
        Line numbers (N,), features (N, 10) rad in the order of `FEATURES`, and labels (N,) or none at all.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    line = source.header()
    if line is None:
        raise source.error("no header", LOOKS)
    header = header_of(line)
    _check_header(source, header)
    return _postures(source, header)


def in_sequence(poses: Array) -> tuple[list[tuple[float, float]], JointTrajectory]:
    """Show postures one after the other.

    Between two of them every joint follows minimum jerk; a long way takes
    longer, so that no joint is faster than `COMFORTABLE`.

    Args:
        poses: (N, 26) rad; a joint that is nan in one is nan in all.

    Returns:
        Start and end of each hold (s), and the trajectory at `RATE`.
    """
    ways = np.nan_to_num(np.abs(np.diff(poses, axis=0))).max(axis=1, initial=0.0)
    durations = np.ceil(np.maximum(TRANSITION, PEAK_SPEED * ways / COMFORTABLE) * RATE) / RATE
    starts = np.concatenate([[0.0], np.cumsum(durations + HOLD)])
    times = np.arange(round((starts[-1] + HOLD) * RATE) + 1) / RATE
    reached = np.clip(np.searchsorted(starts, times + 0.5 / RATE, side="right") - 1, 0, len(poses) - 1)
    following = np.minimum(reached + 1, len(poses) - 1)
    progress = (times - starts[reached] - HOLD) / np.append(durations, 1.0)[reached]
    u = np.clip(progress, 0.0, 1.0)[:, None]
    positions = poses[reached] + minimum_jerk(u) * (poses[following] - poses[reached])
    holds = [(float(start), float(start + HOLD)) for start in starts]
    given = np.asarray(np.isfinite(poses).any(axis=0))
    return holds, JointTrajectory(times, positions, given)


def _check_header(source: Source, header: Header) -> None:
    check_columns(source, header)
    columns = [name.lower() for name in header.columns]
    for place, (name, column) in enumerate(zip(columns, header.columns, strict=True)):
        if name in columns[:place]:
            raise source.error(f"column '{column}' twice", "each column once", header.line, column)
        if name.upper() not in FEATURES and name not in LABELS:
            raise source.error("unknown column", f"{', '.join(FEATURES)}, Behavior or y", header.line, column)
    if missing := [name for name in FEATURES if name.lower() not in columns]:
        raise source.error(f"no column {', '.join(missing)}", "all ten features", header.line)


def _postures(source: Source, header: Header) -> tuple[list[int], Array, list[str]]:
    names = [name.lower() for name in header.columns]
    order = [names.index(name.lower()) for name in FEATURES]
    label = next((names.index(name) for name in LABELS if name in names), None)
    lines, features, labels = [], [], []
    for row in rows(source, header):
        found = cells(source, header, row)
        lines.append(row[0])
        features.append([_angle(source, row[0], header.columns[i], found[i]) for i in order])
        if label is not None:
            labels.append(found[label])
    if not lines:
        raise source.error("a header and no rows", "at least one row of values", header.line)
    return lines, np.radians(features), labels


def _angle(source: Source, line: int, column: str, cell: str) -> float:
    angle = number(source, line, column, cell)
    if not np.isfinite(angle):
        raise source.error(f"'{cell}'" if cell else "an empty cell", "a finite angle in degrees", line, column)
    return angle


def _notes(lines: list[int], features: Array) -> tuple[str, ...]:
    """Tell of the rows whose own elbow angle contradicts their directions."""
    off = elbow_disagreement(features).max(axis=1)
    suspects = [f"{line} ({np.degrees(angle):.0f} deg)" for line, angle in zip(lines, off, strict=True)
                if angle > SUSPECT]  # fmt: skip
    if not suspects:
        return ()
    limit = f"{np.degrees(SUSPECT):.0f} deg"
    return (f"elbow angle and segment directions disagree by more than {limit} in line {', '.join(suspects)}",)
