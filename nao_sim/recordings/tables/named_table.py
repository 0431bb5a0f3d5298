"""A table of points, read: the rows of one person, what they say of time and label, and the unit."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nao_sim.recordings.landmarks.people import choose
from nao_sim.recordings.recording import Label
from nao_sim.recordings.skeletons.layout_file import LENGTHS
from nao_sim.recordings.source import Source
from nao_sim.recordings.table import Header
from nao_sim.recordings.tables.column_names import AXES, Columns
from nao_sim.recordings.tables.named_rows import chunks, time_unit
from nao_sim.robot import Array

RATE = 30.0  # Hz, what the cameras behind such tables give
SHOWN = 6  # column names in a note
_UNIT = re.compile(r"#.*\bunits?\s*[:=]\s*([A-Za-z]+)", re.IGNORECASE)
_RATE = re.compile(r"#.*\b(?:fps|rate|hz|frames per second)\s*[:=]\s*(\d+(?:\.\d+)?)", re.IGNORECASE)
_UNIT_WORDS = {"metres": "m", "meters": "m", "millimetres": "mm", "millimeters": "mm", "inches": "in",
               "centimetres": "cm", "centimeters": "cm"}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Rows:
    """All rows of one person.

    Attributes:
        lines: (T,) where they are.
        numbers: (T, K) as read.
        place: where in a row each column of the table is.
        labels: (T,) what each row shows, or nothing.
        notes: what a user should know.
    """

    lines: tuple[int, ...]
    numbers: Array
    place: Mapping[int, int]
    labels: tuple[str, ...]
    notes: tuple[str, ...]

    def column(self, column: int) -> Array:
        """One column (T,)."""
        return self.numbers[:, self.place[column]]


def check(source: Source, header: Header, columns: Columns) -> None:
    """Refuse a column that says what another one says."""
    if columns.twice:
        raise source.error(f"column '{columns.twice[0]}' twice", "each column once", header.line, columns.twice[0])


def left_out(columns: Columns) -> tuple[str, ...]:
    """A note of the columns that are not read."""
    if not columns.ignored:
        return ()
    more = f" and {len(columns.ignored) - SHOWN} more" if len(columns.ignored) > SHOWN else ""
    return (f"columns left out: {', '.join(columns.ignored[:SHOWN])}{more}",)


def read_rows(source: Source, header: Header, columns: Columns) -> Rows:
    """All rows of one person."""
    points = {column for point in columns.points.values() for column in point.values()}
    wanted = sorted(points | {columns.row[name] for name in ("time", "frame") if name in columns.row})
    texts = [columns.row[name] for name in ("id", "label") if name in columns.row]
    numbers, lines, told = bytearray(), list[int](), [list[str]() for _ in texts]
    for chunk in chunks(source, header, wanted, texts):
        numbers += chunk.numbers.tobytes()
        lines += chunk.lines
        for known, cells in zip(told, chunk.texts, strict=True):
            known.extend(cells)
    if not lines:
        raise source.error("a header and no rows", "at least one row of values", header.line)
    found = np.frombuffer(numbers).reshape(len(lines), len(wanted))
    place = {column: at for at, column in enumerate(wanted)}
    text = dict(zip((name for name in ("id", "label") if name in columns.row), told, strict=True))
    mine, notes = _mine(source, text.get("id"), found[:, [place[column] for column in _coordinate_columns(columns)]])
    labels = tuple(text["label"][row] for row in mine) if "label" in text else ()
    return Rows(tuple(lines[row] for row in mine), found[mine], place, labels, notes)


def _mine(source: Source, ids: Sequence[str] | None, numbers: Array) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    """Which rows are the person's, and a note where there are several people."""
    if ids is None:
        return np.arange(len(numbers)), ()
    there = np.nan_to_num(numbers).any(axis=1)
    who = np.array(ids)
    tracked = Counter(who[there].tolist())
    if not tracked:
        raise source.error("no tracked point", "a person")
    chosen, notes = choose(source, {name: tracked[name] for name in dict.fromkeys(ids) if name in tracked})
    return np.flatnonzero(who == chosen), notes


def _coordinate_columns(columns: Columns) -> list[int]:
    axes = AXES[:2] if columns.planar else AXES
    return [point[axis] for point in columns.points.values() for axis in axes]


def coordinates(columns: Columns, rows: Rows) -> Array:
    """The points (T, J, 3)."""
    axes = 2 if columns.planar else 3
    found = np.zeros((len(rows.lines), len(columns.points), 3))
    found[:, :, :axes] = rows.numbers[:, [rows.place[column] for column in _coordinate_columns(columns)]].reshape(
        len(rows.lines), -1, axes
    )
    return found


def _comments(source: Source, header: Header, wanted: re.Pattern[str]) -> str | None:
    """What the comments above the header say."""
    for line, text in source.lines():
        if line >= header.line:
            return None
        if match := wanted.search(text):
            return match[1]
    return None


def unit_of(source: Source, header: Header, columns: Columns) -> str | None:
    """The unit that names or comments tell, or None."""
    if len(columns.units) > 1:
        raise source.error(f"units {' and '.join(columns.units)}", "one unit for all points", header.line)
    told = _comments(source, header, _UNIT)
    word = columns.units[0] if columns.units else _UNIT_WORDS.get((told or "").lower(), (told or "").lower())
    return word if word in LENGTHS else None


def times_of(
    source: Source, header: Header, columns: Columns, rows: Rows
) -> tuple[Array | None, float | None, float | None]:
    """Times (T,) as the table has them, seconds in their unit, and the rate of one without."""
    if "time" in columns.row:
        column = columns.row["time"]
        return rows.column(column), time_unit(source, header, column), RATE
    told = _comments(source, header, _RATE)
    rate = float(told) if told and float(told) > 0.0 else None
    frames = np.arange(len(rows.lines), dtype=float)
    if "frame" in columns.row:
        frames = rows.column(columns.row["frame"])
        if rate is None:
            return frames, 0.0, RATE
    return (None, None, RATE) if rate is None else (frames / rate, 1.0, RATE)


def labels_of(labels: Sequence[str], times: Array) -> tuple[Label, ...]:
    """The stretches of rows with one label; none where rows were left out."""
    if len(labels) != len(times):
        return ()
    starts = [row for row in range(len(labels)) if row == 0 or labels[row] != labels[row - 1]]
    ends = [*(start - 1 for start in starts[1:]), len(labels) - 1]
    return tuple(
        Label(labels[start], float(times[start]), float(times[end]))
        for start, end in zip(starts, ends, strict=True)
        if labels[start]
    )
