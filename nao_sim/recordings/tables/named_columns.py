"""Tables of points with a header: one row a frame, the columns named by joint (or number) and axis.

`column_names` says what the columns are, `named_table` reads them.  Points by MediaPipe's names or numbers are taken as
landmarks are, others by their names.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nao_sim.recordings.landmarks.landmark_parts import BODIES, HANDS, body_of, cleaned
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.layout_file import LENGTHS, read_layout
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Source
from nao_sim.recordings.table import Header
from nao_sim.recordings.tables.column_names import FEWEST, TRUST, Columns, columns_of, parts_and_keys
from nao_sim.recordings.tables.named_rows import header_line
from nao_sim.recordings.tables.named_table import (
    Rows,
    check,
    coordinates,
    labels_of,
    left_out,
    read_rows,
    times_of,
    unit_of,
)
from nao_sim.robot import Array

NAME = "table of points"
LOOKS = "a header of joints and axes such as time,ShoulderLeft_x,ShoulderLeft_y,ShoulderLeft_z"
KINECT, AZURE, PERCENT = 2.0, 3.0, 100.0  # full confidence: 0 1 2 (tracked), 0 1 2 3 (high), or per cent


def recognise(source: Source) -> str | None:
    """Why the file is a table of points, or None."""
    header = header_line(source)
    columns = columns_of(header.columns) if header else None
    if columns is None or "" in columns.points:
        return None
    if len(columns.points) < FEWEST:
        return None
    if source.layout is not None:
        own = read_layout(source.layout)
        if not own.names and len(own) != len(columns.points):
            return None
    return f"columns of {len(columns.points)} points, such as '{next(iter(columns.points))}'"


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's layout, rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: one person, and a label for each stretch of rows with one.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    header = header_line(source)
    assert header is not None, "recognise() has seen a header"
    columns = columns_of(header.columns)
    check(source, header, columns)
    rows = read_rows(source, header, columns)
    notes = (*rows.notes, *left_out(columns))
    points, told = points_of(source, header, columns, rows)
    understood = understand(source, points)
    labels = labels_of(rows.labels, understood.skeleton.times)
    return understood.recording(source, NAME, reason, len(rows.lines), (*notes, *told), labels)


def points_of(source: Source, header: Header, columns: Columns, rows: Rows) -> tuple[Points, tuple[str, ...]]:
    """The points of the table, and what a user should know."""
    where = parts_and_keys(list(columns.points))
    table = coordinates(columns, rows)
    trust = _trust(source, header, columns, rows)
    parts = {}
    for name in (*BODIES, *HANDS):
        chosen = [place for place, (part, _) in enumerate(where.values()) if part == name]
        if chosen and np.isfinite(table[:, chosen]).any() and table[:, chosen].any():
            keys = tuple(list(where.values())[place][1] for place in chosen)
            parts[name] = cleaned(keys, np.dstack([table[:, chosen], trust[:, chosen]]))
    if not any(name in parts for name in BODIES):
        raise source.error(f"no place of any point such as '{next(iter(where))}'", "points of a body", header.line)
    if source.layout is not None:
        points = Points(table, tuple(where), confidence=np.nan_to_num(trust, nan=1.0), planar=columns.planar)
        notes: tuple[str, ...] = ()
    else:
        points, notes = body_of(parts, None)
    unit = unit_of(source, header, columns)
    times, time_unit, rate = times_of(source, header, columns, rows)
    points = replace(points, times=times, time_unit=time_unit, rate=rate, lines=rows.lines)
    return replace(points, unit=points.unit or (LENGTHS[unit] if unit else None)), notes


def _trust(source: Source, header: Header, columns: Columns, rows: Rows) -> Array:
    """How sure the points are, (T, J) from 0 to 1; nan where the table does not say."""
    found = np.full((len(rows.lines), len(columns.points)), np.nan)
    for kind in TRUST:
        chosen = {place: point[kind] for place, point in enumerate(columns.points.values()) if kind in point}
        if 2 * len(chosen) < len(columns.points):
            continue  # a hand's state, open or closed, says nothing of the others
        told = rows.numbers[:, [rows.place[column] for column in chosen.values()]]
        scale = _scale(kind, told)
        wrong = (told < 0.0) | (told > scale)
        if wrong.any():
            row, at = np.argwhere(wrong)[0]
            name = header.columns[list(chosen.values())[at]]
            expected = "a state 0, 1 or 2" if kind == "state" else "0 to 1"
            raise source.error(f"{told[row, at]:g}", expected, rows.lines[row], name)
        found[:, list(chosen)] = 1.0 - told / scale / 2.0 if kind == "inferred" else told / scale
        break
    return found


def _scale(kind: str, told: Array) -> float:
    """What stands for full confidence."""
    most, whole = float(np.nanmax(told, initial=0.0)), bool((told[np.isfinite(told)] % 1.0 == 0.0).all())
    if most <= 1.0 or kind == "inferred":
        return 1.0
    if kind == "state":
        return KINECT
    return AZURE if whole and most <= AZURE else PERCENT
