"""Joint-angle CSV: one frame a row under a header of NAOqi joint names.

A column says its unit by suffix (`LElbowRoll_deg`, `LElbowRoll_rad`), a comment
above the header says it for all (`# unit: deg`), or the caller says it.  Hands
run from 0 to 1 and have none.  Times stand in a column `time` (s), or the
caller gives the frame rate.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nao_sim.motion import JointTrajectory
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.source import Source, Unit
from nao_sim.recordings.table import Header, check_columns, header_of, number_chunks
from nao_sim.robot import Array, load_robot

NAME = "joint-angle CSV"
LOOKS = "a header of NAOqi joint names such as time,LShoulderPitch_deg"
TIME = "time"
UNITS: dict[str, Unit] = {"deg": "deg", "degree": "deg", "degrees": "deg",
                          "rad": "rad", "radian": "rad", "radians": "rad"}  # fmt: skip
THREE_WAYS = "a suffix (LElbowRoll_deg or _rad), a line '# unit: deg' above the header, or --unit deg (or rad)"
_SUFFIX = re.compile(r"_(deg|rad)$")
_COMMENT = re.compile(r"#\s*units?\s*[:=]\s*(\S*)\s*$", re.IGNORECASE)


@dataclass(frozen=True)
class _Column:
    """Where a column of the file goes: joint index, and the factor to the inner unit."""

    joint: int
    factor: float


def recognise(source: Source) -> str | None:
    """Why the file is a joint-angle CSV, or None."""
    line = source.header()
    names = header_of(line).columns if line else ()
    joints = [name for name in names if _base(name) in load_robot().index]
    if joints:
        return f"column '{joints[0]}' is a NAOqi joint"
    near = next((name for name in names if _nearest(_base(name))), None)
    return f"column '{near}' is almost a NAOqi joint" if near else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's unit and rate where it has none.
        reason: why it is taken for this format.

    Returns:
        The recording; joints without a column are not `given`, and a cell that
        is empty or not finite asks nothing.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    line = source.header()
    assert line is not None, "recognise() has seen a header"
    header = header_of(line)
    check_columns(source, header)
    _check_joints(source, header)
    columns = _columns(source, header)
    times, positions = _frames(source, header, columns)
    given = np.zeros(len(load_robot().joint_names), bool)
    given[[column.joint for column in columns.values()]] = True
    motion = JointTrajectory(times, positions, given)
    return Recording(source.path, NAME, reason, motion, len(motion), _notes(source, header))


def _base(column: str) -> str:
    """A column's name without its unit."""
    return _SUFFIX.sub("", column)


def _suffix(column: str) -> Unit | None:
    return UNITS[match[1]] if (match := _SUFFIX.search(column)) else None


def _nearest(name: str) -> str | None:
    """The known column that `name` may be meant for."""
    known = {joint.lower(): joint for joint in (*load_robot().joint_names, TIME)}
    close = difflib.get_close_matches(name.lower(), known, n=1, cutoff=0.75)
    return known[close[0]] if close else None


def _check_joints(source: Source, header: Header) -> None:
    """Refuse unknown columns, hands with a unit, a joint twice, and a file without joints."""
    robot, seen = load_robot(), dict[str, str]()
    for column in header.columns:
        base = _base(column)
        if base not in robot.index:
            if column != TIME:
                hint = f" (did you mean {near}?)" if (near := _nearest(base)) else ""
                raise source.error(f"unknown column{hint}", "'time' (s) or a NAOqi joint name", header.line, column)
            continue
        if robot.is_hand[robot.index[base]] and base != column:
            raise source.error("a hand with a unit", f"'{base}', 0 closed to 1 open", header.line, column)
        if base in seen:
            raise source.error(f"{base} also in column '{seen[base]}'", "each joint once", header.line, column)
        seen[base] = column
    if not seen:
        raise source.error("no joint column", LOOKS, header.line)


def _columns(source: Source, header: Header) -> dict[int, _Column]:
    """Map the file's columns to joints and inner units."""
    robot, comment = load_robot(), _unit_comment(source, header)
    columns = {}
    for number, name in enumerate(header.columns):
        if name == TIME:
            continue
        joint = robot.index[_base(name)]
        unit = None if robot.is_hand[joint] else _unit(source, header, name, comment)
        columns[number] = _Column(joint, float(np.radians(1.0)) if unit == "deg" else 1.0)
    return columns


def _unit(source: Source, header: Header, column: str, comment: Unit | None) -> Unit:
    """The one unit that suffix, comment and caller agree on."""
    said = {"suffix": _suffix(column), "comment": comment, "unit option": source.unit}
    stated = [(who, unit) for who, unit in said.items() if unit is not None]
    if not stated:
        raise source.error("no unit", THREE_WAYS, header.line, column)
    (first, unit), *others = stated
    for who, other in others:
        if other != unit:
            raise source.error(f"'{unit}' by {first} but '{other}' by {who}", "one unit", header.line, column)
    return unit


def _unit_comment(source: Source, header: Header) -> Unit | None:
    """The unit that comments above the header state for all columns."""
    stated: Unit | None = None
    for number, text in source.lines():
        if number >= header.line:
            break
        if match := _COMMENT.match(text.strip()):
            unit = UNITS.get(match[1].lower())
            if unit is None:
                raise source.error(f"unit '{match[1]}'", "deg or rad", number)
            if stated not in (None, unit):
                raise source.error(f"'# unit: {unit}' after '# unit: {stated}'", "one unit", number)
            stated = unit
    return stated


def _frames(source: Source, header: Header, columns: dict[int, _Column]) -> tuple[Array, Array]:
    """Times (T,) s and positions (T, 26) of all rows."""
    clock, width = _Clock(source, header), len(load_robot().joint_names)
    times, positions = bytearray(), bytearray()  # grown in place: a long file is held once
    order = [column.joint for column in columns.values()]
    factors = np.array([column.factor for column in columns.values()])
    for lines, values in number_chunks(source, header):
        chunk = np.full((len(lines), width), np.nan)
        chunk[:, order] = values[:, list(columns)] * factors
        times += clock.times(lines, values).tobytes()
        positions += chunk.tobytes()
    if not times:
        raise source.error("a header and no rows", "at least one row of values", header.line)
    return np.frombuffer(times), np.frombuffer(positions).reshape(-1, width)


class _Clock:
    """Gives rows their times: from the file's column, or by counting at the caller's rate."""

    def __init__(self, source: Source, header: Header) -> None:
        self._source = source
        self._column = header.columns.index(TIME) if TIME in header.columns else None
        self._count, self._last = 0, -np.inf
        if self._column is None and source.rate is None:
            raise source.error("no times", "a column 'time' in seconds, or the frame rate (--rate HZ)", header.line)
        if self._column is not None and source.rate is not None:
            raise source.error(
                f"a time column and a rate of {source.rate:g} Hz", "no rate for a file with times", header.line, TIME
            )

    def times(self, lines: Sequence[int], values: Array) -> Array:
        if self._column is None:
            frames = np.arange(self._count, self._count + len(lines))
            self._count += len(lines)
            return frames / (self._source.rate or np.nan)
        times = values[:, self._column]
        before = np.concatenate([[self._last], times[:-1]])
        wrong = ~(np.isfinite(times) & (times > before))
        if wrong.any():
            self._refuse(lines[first := int(wrong.argmax())], times[first], before[first])
        self._last = times[-1]
        return times

    def _refuse(self, line: int, time: float, before: float) -> None:
        expected = f"a time after {before:.12g} s" if np.isfinite(time) else "a finite time in seconds"
        raise self._source.error(f"{time:.12g}", expected, line, TIME)


def _notes(source: Source, header: Header) -> tuple[str, ...]:
    notes = [] if TIME in header.columns else [f"no time column: {source.rate:g} frames a second, as told"]
    bare = [name for name in header.columns if name in load_robot().index and not name.endswith("Hand")]
    if source.unit and bare and _unit_comment(source, header) is None:
        notes.append(f"angles without a unit taken as {source.unit}, as told")
    return tuple(notes)
