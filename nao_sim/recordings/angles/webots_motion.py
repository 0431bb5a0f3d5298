"""Webots `.motion` files, such as those that come with its NAO.

The first line is `#WEBOTS_MOTION,V1.0,` and the joint names; each further line
is `MM:SS:mmm,PoseName,` and a value for each joint: radians, or `*` where the
pose leaves the joint alone (Webots reference manual, "Motion").  Webots moves
the eight phalanges of each hand one by one; their mean is the hand's opening,
and a hand that is written moves them all alike.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from nao_sim.motion import JointTrajectory
from nao_sim.recordings.angles.fixed_options import refuse_options
from nao_sim.recordings.recording import Label, Recording
from nao_sim.recordings.source import Source
from nao_sim.recordings.table import Header, cells, check_columns, number, rows, split
from nao_sim.robot import Array, facts, load_robot

NAME = "Webots motion"
LOOKS = "a first line #WEBOTS_MOTION,V1.0,"
MAGIC, VERSION = "#WEBOTS_MOTION", "V1.0"
UNSPECIFIED = "*"
_TIME = re.compile(r"(\d+):([0-5]\d):(\d{3})")
PHALANGES = 8  # of each hand
_PHALANX = re.compile(rf"([LR])Phalanx[1-{PHALANGES}]")
_LEAD = ("time", "pose")  # what stands before the joints in a row


def recognise(source: Source) -> str | None:
    """Why the file is a Webots motion, or None."""
    first = next(source.lines(), (1, ""))[1]
    return f"the first line starts with {MAGIC}" if first.startswith(MAGIC) else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file.
        reason: why it is taken for this format.

    Returns:
        The recording: a frame a pose, at the pose's own time.  The poses' names
        are its labels.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    refuse_options(source, "a Webots motion", "rad")
    header = _header(source)
    targets = _targets(source, header)
    times, names, values = _poses(source, header)
    positions = _gather(values, targets)
    given = np.array([joint in targets for joint in range(positions.shape[1])])
    motion = JointTrajectory(times, positions, given)
    labels = tuple(Label(name, time, time) for name, time in zip(names, times.tolist(), strict=True))
    return Recording(source.path, NAME, reason, motion, len(motion), _notes(header), labels)


def _header(source: Source) -> Header:
    """The joint names, with names for the two columns before them."""
    first = split(next(source.lines())[1], ",")
    if first[:2] != (MAGIC, VERSION):
        raise source.error(f"'{','.join(first[:2])}'", f"{MAGIC},{VERSION}", 1)
    header = Header(1, ",", (*_LEAD, *first[2:]))
    check_columns(source, header)
    return header


def _targets(source: Source, header: Header) -> Mapping[int, list[int]]:
    """Which columns (of the joints) make up each joint of the robot."""
    index = load_robot().index
    targets: dict[int, list[int]] = {}
    for column, name in enumerate(header.columns[len(_LEAD) :]):
        phalanx = _PHALANX.fullmatch(name)
        joint = phalanx[1] + "Hand" if phalanx else name
        if joint not in index or (phalanx is None and joint.endswith("Hand")):
            raise source.error("unknown joint", "a joint of Webots's NAO (NAOqi names, LPhalanx1...)", 1, name)
        targets.setdefault(index[joint], []).append(column)
    if not targets:
        raise source.error("no joints", "joint names after the version", 1)
    return targets


def _poses(source: Source, header: Header) -> tuple[Array, list[str], Array]:
    """Times (T,) s, names (T,) and the joint columns' values (T, C), `*` being nan."""
    times, names, values = list[float](), [], []
    for row in rows(source, header):
        line = row[0]
        time, name, *found = cells(source, header, row)
        times.append(_time(source, line, time, times[-1] if times else None))
        names.append(name)
        joints = zip(header.columns[len(_LEAD) :], found, strict=True)
        values.append(np.array([_value(source, line, column, cell) for column, cell in joints]))
    if not times:
        raise source.error("a first line and no poses", "at least one pose", 1)
    return np.array(times), names, np.array(values)


def _time(source: Source, line: int, text: str, before: float | None) -> float:
    match = _TIME.fullmatch(text)
    if match is None:
        raise source.error(f"'{text}'", "a time MM:SS:mmm", line, "time")
    minutes, seconds, milliseconds = map(int, match.groups())
    time = 60.0 * minutes + seconds + milliseconds / 1000.0
    if before is not None and time <= before:
        raise source.error(f"{time:g} s", f"a time after {before:g} s", line, "time")
    return time


def _value(source: Source, line: int, column: str, cell: str) -> float:
    if cell == UNSPECIFIED:
        return np.nan
    value = number(source, line, column, cell)
    if not np.isfinite(value):
        raise source.error(f"'{cell}'" if cell else "an empty cell", "an angle in radians, or *", line, column)
    return value


def _gather(values: Array, targets: Mapping[int, list[int]]) -> Array:
    """Joint positions (T, 26) from the file's columns (T, C)."""
    robot = load_robot()
    positions = np.full((len(values), len(robot.joint_names)), np.nan)
    for joint, columns in targets.items():
        value = values[:, columns].mean(axis=1)
        positions[:, joint] = np.clip(value / _closed_to_open(), 0.0, 1.0) if robot.is_hand[joint] else value
    return positions


def _closed_to_open() -> float:
    """How far a phalanx turns between a closed and an open hand, rad."""
    return float(facts()["hand"]["finger_joints"][0]["multiplier"])


def _notes(header: Header) -> tuple[str, ...]:
    phalanges = any(_PHALANX.fullmatch(name) for name in header.columns)
    return ("hand openings are the mean of the hand's phalanges",) if phalanges else ()


def motion_text(motion: JointTrajectory) -> str:
    """A trajectory as a Webots motion.

    Angles are exact, times are rounded to milliseconds; of frames within one
    millisecond the first stays.  A value that is not finite becomes `*`.

    Args:
        motion: from time 0 on; only its `given` joints become columns.
    """
    names, columns, factors = _columns(motion)
    milliseconds, frames = np.unique(np.round(motion.times * 1000.0).astype(np.int64), return_index=True)
    lines = [",".join([MAGIC, VERSION, *names])]
    for number_, (time, row) in enumerate(zip(milliseconds.tolist(), motion.positions[frames], strict=True), start=1):
        clock = f"{time // 60000:02d}:{time // 1000 % 60:02d}:{time % 1000:03d}"
        cells_ = [repr(value) if np.isfinite(value) else UNSPECIFIED for value in (row[columns] * factors).tolist()]
        lines.append(",".join([clock, f"Pose{number_}", *cells_]))
    return "\n".join(lines) + "\n"


def _columns(motion: JointTrajectory) -> tuple[list[str], list[int], Array]:
    """Names of the file's columns, the joint of each, and the factor to the column's radians."""
    robot = load_robot()
    names, columns, factors = list[str](), [], []
    for joint in np.flatnonzero(motion.given).tolist():
        name, hand = robot.joint_names[joint], bool(robot.is_hand[joint])
        parts = [f"{name[0]}Phalanx{i}" for i in range(1, PHALANGES + 1)] if hand else [name]
        names += parts
        columns += [joint] * len(parts)
        factors += [_closed_to_open() if hand else 1.0] * len(parts)
    return names, columns, np.array(factors)
