"""Optical motion capture exported as text: Motive CSV, Vicon Nexus CSV, Qualisys TSV and OpenSim TRC.

`mocap_headers` finds the coordinates.  A skeleton's bones are taken where they begin; markers of a known set
(`marker_sets.toml`) tell the joints they surround; other names are taken as joints'.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from nao_sim.recordings.landmarks.people import choose
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.rigs.rig import Rig
from nao_sim.recordings.rigs.rig_joints import joints_of
from nao_sim.recordings.skeletons.layout_file import read_layout
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Line, Source, is_skipped
from nao_sim.recordings.table import Header
from nao_sim.recordings.tables.markers import as_joints
from nao_sim.recordings.tables.mocap_headers import MOTIVE, QUALISYS, TRC, VICON, Mocap, header_of, kind_of
from nao_sim.recordings.tables.named_rows import chunks
from nao_sim.robot import Array

NAME = "optical motion capture"
LOOKS = f"the header of a {MOTIVE}, {VICON}, {QUALISYS} or {TRC}"
FEWEST = 4  # known points that make a subject
MISSING = 1e7  # what some programs write for "not seen" is beyond


def recognise(source: Source) -> str | None:
    """Why the file is motion capture's, or None."""
    kind = kind_of(source)
    return f"the header of a {kind}" if kind else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's layout and person (the subject's name).
        reason: why it is taken for this format.

    Returns:
        The recording: one person.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    points, notes = points_of(source)
    return understand(source, points).recording(source, NAME, reason, len(points.values), notes)


def points_of(source: Source) -> tuple[Points, tuple[str, ...]]:
    """The points of one person, and what a user should know.

    Raises:
        RecordingError: as `read`.
    """
    kind = kind_of(source)
    assert kind is not None, "recognise() has seen the header"
    mocap = header_of(source, kind)
    lines, numbers = _numbers(source, mocap)
    values = numbers[:, : 3 * len(mocap.names)].reshape(len(lines), -1, 3)
    values = np.where(np.isfinite(values) & (np.abs(values) < MISSING), values, np.nan)
    names, values, who = _subject(source, mocap.names, values)
    points = Points(values, names, lines=lines, unit=mocap.unit)
    own = source.layout is not None and read_layout(source.layout).names
    points, notes = (points, ()) if own else _as_joints(points, mocap)
    return _timed(points, mocap, numbers[:, 3 * len(mocap.names) :]), (*who, *notes)


def _numbers(source: Source, mocap: Mocap) -> tuple[tuple[int, ...], Array]:
    """Lines (T,) and numbers (T, 3 M + 1 or 2): the coordinates, then time and frame."""
    wanted = [column for place in mocap.columns for column in place]
    wanted += [column for column in (mocap.time, mocap.frame) if column is not None]
    names = {column: f"{name} {axis}" for name, place in zip(mocap.names, mocap.columns, strict=True)
             for axis, column in zip("XYZ", place, strict=True)}  # fmt: skip
    header = Header(mocap.line, mocap.separator, tuple(names.get(i, f"{i + 1}") for i in range(mocap.width or 0)))
    grown, lines = bytearray(), list[int]()
    for chunk in chunks(source, header, wanted, below=_rows(source, mocap)):
        grown += chunk.numbers.tobytes()
        lines += chunk.lines
    if not lines:
        raise source.error("a header and no rows", "at least one row of values", mocap.line)
    return tuple(lines), np.frombuffer(grown).reshape(len(lines), len(wanted))


def _rows(source: Source, mocap: Mocap) -> Iterator[Line]:
    """The lines of numbers, the cells that some programs leave out at their ends filled in."""
    mark, width = mocap.separator, mocap.width or 0
    for number, text in source.lines():
        if number <= mocap.line:
            continue
        if is_skipped(text.strip(f"{mark or ' '} \r\t")):
            if mocap.ends:
                return
            continue
        short = width - 1 - text.count(mark) if mark else 0
        yield number, text.rstrip("\r") + (mark or "") * max(short, 0)


def _subject(source: Source, names: tuple[str, ...], values: Array) -> tuple[tuple[str, ...], Array, tuple[str, ...]]:
    """The points of one subject, where names tell of several (`Sub1:LSHO`)."""
    subjects: dict[str, list[int]] = {}
    for place, name in enumerate(names):
        subjects.setdefault(name.rpartition(":")[0], []).append(place)
    there = np.asarray(np.isfinite(values).all(axis=2))
    tracked = {
        name: int(there[:, places].any(axis=1).sum()) for name, places in subjects.items() if len(places) >= FEWEST
    }
    if len(tracked) < 2 and (source.person is None or source.person not in tracked):  # noqa: PLR2004
        return names, values, ()
    chosen, notes = choose(source, tracked)
    return tuple(names[place] for place in subjects[chosen]), values[:, subjects[chosen]], notes


def _as_joints(points: Points, mocap: Mocap) -> tuple[Points, tuple[str, ...]]:
    """Bones and known markers as joints; other points by their names."""
    if not mocap.bones:
        return as_joints(points)
    names = points.names or ()
    loose = Rig(names, tuple(-1 if place == 0 else 0 for place in range(len(names))), np.zeros((len(names), 3)))
    joints = joints_of(loose)
    if not joints:
        return points, ()
    return replace(points, values=points.values[:, list(joints.values())], names=tuple(joints)), ()


def _timed(points: Points, mocap: Mocap, beside: Array) -> Points:
    """The points with the file's times, or its frame numbers at its rate."""
    if mocap.time is not None:
        return replace(points, times=beside[:, 0], time_unit=1.0)
    if mocap.frame is not None and mocap.rate:
        return replace(points, times=beside[:, 0] / mocap.rate, time_unit=1.0)
    if mocap.frame is not None:
        return replace(points, times=beside[:, 0], time_unit=0.0)
    return replace(points, times=np.arange(len(points.values)) / mocap.rate, time_unit=1.0) if mocap.rate else points
