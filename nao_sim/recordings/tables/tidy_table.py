"""Tables with one point a row: `frame,joint,x,y,z`, or `frame,type,landmark_index,x,y,z`.

The rows of a frame have its number or time; where the table has neither, a frame ends when a point comes again.
Rows without a header are read where each has a joint's name before the last three numbers, as in
`1250, ShoulderLeft, Tracked, 0.1, 0.4, 2.1`.
"""

from __future__ import annotations

import math
from array import array
from collections import Counter
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np

from nao_sim.body import joint_called
from nao_sim.recordings.landmarks.landmark_parts import BODIES, HANDS, body_of, cleaned
from nao_sim.recordings.landmarks.landmark_points import state_confidence
from nao_sim.recordings.landmarks.landmark_words import keys_of
from nao_sim.recordings.landmarks.people import choose
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.layout_file import LENGTHS
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Source
from nao_sim.recordings.table import Header, split
from nao_sim.recordings.table import rows as below
from nao_sim.recordings.tables.column_names import Columns, columns_of, parts_and_keys
from nao_sim.recordings.tables.named_rows import chunks, header_line, time_unit
from nao_sim.recordings.tables.named_table import RATE, unit_of
from nao_sim.robot import Array

NAME = "table of one point a row"
LOOKS = "a header such as frame,joint,x,y,z, or such rows without one"
PEEK = 3  # rows without a header that tell what their columns are


@dataclass(eq=False)
class _Gathered:
    """The rows so far: where each is in the table (T, J) of its person."""

    names: dict[str, int] = field(default_factory=dict)
    people: dict[str, int] = field(default_factory=dict)
    place: array[int] = field(default_factory=lambda: array("q"))
    person: array[int] = field(default_factory=lambda: array("q"))
    frame: array[int] = field(default_factory=lambda: array("q"))
    lines: array[int] = field(default_factory=lambda: array("q"))
    values: bytearray = field(default_factory=bytearray)


def recognise(source: Source) -> str | None:
    """Why the file is a table of one point a row, or None."""
    header = _header(source)
    columns = columns_of(header.columns) if header else None
    if header is None or columns is None or list(columns.points) != [""] or source.layout is not None:
        return None
    which = _which(header)
    return f"a point a row, named by '{header.columns[which[-1]]}'" if which else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: one person.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    header = _header(source)
    assert header is not None, "recognise() has seen a header"
    points, notes = points_of(source, header)
    return understand(source, points).recording(source, NAME, reason, len(points.values), notes)


def points_of(source: Source, header: Header) -> tuple[Points, tuple[str, ...]]:
    """The points of one person, and what a user should know."""
    columns = columns_of(header.columns)
    wanted, rows = _rows(source, header, columns)
    numbers = np.frombuffer(rows.values).reshape(-1, len(wanted))
    person, who = _person(source, rows, numbers)
    mine = np.asarray(rows.person) == person
    frames, order = np.unique(np.asarray(rows.frame)[mine], return_inverse=True)
    table = np.full((len(frames), len(rows.names), 4), np.nan)
    axes = [wanted.index(columns.points[""][axis]) for axis in ("x", "y", "z") if axis in columns.points[""]]
    table[order, np.asarray(rows.place)[mine], : len(axes)] = numbers[mine][:, axes]
    if "trust" in columns.points[""]:
        table[order, np.asarray(rows.place)[mine], 3] = numbers[mine][:, wanted.index(columns.points[""]["trust"])]
    points, notes = _body(source, header, tuple(rows.names), table)
    lines, clock = np.zeros(len(frames), int), np.zeros(len(frames))
    lines[order[::-1]] = np.asarray(rows.lines)[mine][::-1]
    column = next((columns.row[name] for name in ("time", "frame") if name in columns.row), None)
    unit = unit_of(source, header, columns)
    points = replace(points, lines=lines.tolist(), unit=points.unit or (LENGTHS[unit] if unit else None), rate=RATE)
    if column is not None:
        clock[order[::-1]] = numbers[mine][::-1, wanted.index(column)]
        told = time_unit(source, header, column) if "time" in columns.row else 0.0
        points = replace(points, times=clock, time_unit=told)
    return points, (*who, *notes)


def _header(source: Source) -> Header | None:
    """The names of the columns: the file's own, or for rows without them what their cells are."""
    header = header_line(source)
    if header is None or not any(_is_number(cell) for cell in header.columns):
        return header
    rows = [split(text, header.delimiter) for _, text in islice(below(source, replace(header, line=0)), PEEK)]
    kinds = {tuple(map(_kind, row)) for row in rows}
    kind = kinds.pop()
    if kinds or kind.count("joint") != 1 or kind[-3:] != ("number",) * 3 or kind.index("joint") >= len(kind) - 3:
        return header
    names = [f"column {place}" if known == "number" else known for place, known in enumerate(kind, start=1)]
    if names[0] == "column 1":
        names[0] = "time"
    return Header(header.line - 1, header.delimiter, (*names[:-3], "x", "y", "z"))


def _kind(cell: str) -> str:
    """What a cell of a row without a header is."""
    if _is_number(cell):
        return "number"
    return "joint" if joint_called(cell) else "state" if not math.isnan(state_confidence(cell)) else "text"


def _is_number(cell: str) -> bool:
    try:
        return math.isfinite(float(cell))
    except ValueError:
        return False


def _which(header: Header) -> tuple[int, ...]:
    """The columns that name a row's point: what it is of, where there is one, and its name or number."""
    named = keys_of(header.columns, "which")
    sets = [name for name in keys_of(header.columns, "set") if name not in named]
    return tuple(header.columns.index(name) for name in (*sets[:1], *named[:1])) if named else ()


def _rows(source: Source, header: Header, columns: Columns) -> tuple[list[int], _Gathered]:
    """The columns that were read, and all rows of them."""
    clock = next((columns.row[name] for name in ("time", "frame") if name in columns.row), None)
    wanted = sorted({*columns.points[""].values(), *(() if clock is None else (clock,))})
    which = _which(header)
    who = columns.row.get("id") if columns.row.get("id") not in which else None
    rows, seen = _Gathered(), set[tuple[int, int]]()
    frame, last = -1, None
    for chunk in chunks(source, header, wanted, (*which, *(() if who is None else (who,)))):
        rows.values += chunk.numbers.tobytes()
        rows.lines.extend(chunk.lines)
        times = chunk.numbers[:, wanted.index(clock)].tolist() if clock is not None else [0.0] * len(chunk.lines)
        for texts, time in zip(zip(*chunk.texts, strict=True), times, strict=True):
            name = "_".join(texts[: len(which)])
            place = rows.names.setdefault(name, len(rows.names))
            person = rows.people.setdefault(texts[-1] if who is not None else "", len(rows.people))
            if frame < 0 or time != last or (clock is None and (person, place) in seen):
                frame, last, seen = frame + 1, time, set()
            elif (person, place) in seen:
                raise source.error(
                    f"'{name}' twice", "each point once in a frame", chunk.lines[len(rows.frame) % len(times)]
                )
            seen.add((person, place))
            rows.place.append(place)
            rows.person.append(person)
            rows.frame.append(frame)
    if not rows.frame:
        raise source.error("a header and no rows", "at least one row of values", header.line)
    return wanted, rows


def _person(source: Source, rows: _Gathered, numbers: Array) -> tuple[int, tuple[str, ...]]:
    """Whose rows are read."""
    there = np.isfinite(numbers).any(axis=1)
    pairs = set(zip(np.asarray(rows.person)[there].tolist(), np.asarray(rows.frame)[there].tolist(), strict=True))
    tracked = Counter(person for person, _ in pairs)
    if not tracked:
        raise source.error("no tracked point", "a person")
    chosen, notes = choose(source, {name: tracked[number] for name, number in rows.people.items() if tracked[number]})
    return rows.people[chosen], notes


def _body(source: Source, header: Header, names: tuple[str, ...], table: Array) -> tuple[Points, tuple[str, ...]]:
    """The points (T, J, 4) of a body and hands."""
    where = parts_and_keys(names)
    parts = {}
    for part in (*BODIES, *HANDS):
        chosen = [place for place, name in enumerate(names) if where[name][0] == part]
        if chosen and np.isfinite(table[:, chosen, 0]).any():
            parts[part] = cleaned(tuple(where[names[place]][1] for place in chosen), table[:, chosen])
    if not any(part in parts for part in BODIES):
        raise source.error(f"only points such as '{names[0]}'", "points of a body", header.line)
    return body_of(parts, None)
