"""The rows of a table whose header names its columns: numbers, and the few columns of text beside them, in pieces."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from nao_sim.recordings.landmarks.landmark_points import state_confidence
from nao_sim.recordings.skeletons.timestamps import clock, unit_named
from nao_sim.recordings.source import Line, Source
from nao_sim.recordings.table import Header, header_of, number, rows, split
from nao_sim.robot import Array

CHUNK = 2**20  # numbers read at a time, 8 MB
NOTHING = ("na", "n/a", "null", "none", "-", "nan(ind)", "-nan(ind)", "#n/a", "1.#qnan", "-1.#ind")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")


@dataclass(frozen=True, eq=False)
class Chunk:
    """Some rows.

    Attributes:
        lines: (N,) where they are in the file.
        numbers: (N, K) of the columns that were asked for; nan for cells without one.
        texts: (N,) for each column of text its cells.
    """

    lines: tuple[int, ...]
    numbers: Array
    texts: tuple[tuple[str, ...], ...]


def header_line(source: Source) -> Header | None:
    """The names of the columns, in the first line that is no comment; a separator at its end opens no column."""
    line = source.header()
    if line is None:
        return None
    header = header_of(line)
    if len(header.columns) == 1:
        header = Header(line[0], None, split(line[1].strip(), None))
    return (
        replace(header, columns=header.columns[:-1]) if len(header.columns) > 1 and not header.columns[-1] else header
    )


def chunks(
    source: Source,
    header: Header,
    wanted: Sequence[int],
    texts: Sequence[int] = (),
    below: Iterator[Line] | None = None,
) -> Iterator[Chunk]:
    """The rows below a header, in pieces of at most `CHUNK` numbers.

    Args:
        source: the file.
        header: its header.
        wanted: (K,) the columns of numbers; states and clock times are made numbers.
        texts: the columns of text.
        below: the rows; all below the header where None.

    Raises:
        RecordingError: a row is too short or too long, or a cell is no number.
    """
    below = rows(source, header) if below is None else below
    size = max(CHUNK // max(len(wanted), 1), 1)
    while some := list(islice(below, size)):
        lines, cut = tuple(line for line, _ in some), [_whole(source, header, line) for line in some]
        told = tuple(zip(*([split(text, header.delimiter)[column] for column in texts] for text in cut), strict=True))
        yield Chunk(lines, _numbers(source, header, lines, cut, wanted), told if texts else ())


def time_unit(source: Source, header: Header, column: int) -> float | None:
    """Seconds in the unit of a column of times, by its name or because it has clock times; None where nothing tells."""
    cells = (split(text, header.delimiter)[column:][:1] for _, text in rows(source, header))
    first = next((cell for found in cells for cell in found if cell and cell.lower() not in NOTHING), "")
    return 1.0 if _is_clock(first) and clock(first) is not None else unit_named(header.columns[column])


def _whole(source: Source, header: Header, line: Line) -> str:
    """A row without a separator that trails it.

    Raises:
        RecordingError: it has more or fewer cells than the header.
    """
    text, width, mark = line[1].rstrip("\r\n"), len(header.columns), header.delimiter
    count = len(text.split()) if mark is None else text.count(mark) + 1
    if mark is not None and count == width + 1 and text.rstrip(" ").endswith(mark):
        return text.rstrip(" ").removesuffix(mark)
    if count != width and (found := len(split(text, mark))) != width:
        raise source.error(f"{found} value{'s' * (found != 1)}", f"{width} values, as in the header", line[0])
    return text


def _numbers(
    source: Source, header: Header, lines: Sequence[int], texts: Sequence[str], wanted: Sequence[int]
) -> Array:
    """Numbers (N, K): fast where all is well, exact where it is not."""
    filled = [_filled(text, header.delimiter) for text in texts]
    if header.delimiter != ",":
        filled = [text.replace(",", ".") if "," in text else text for text in filled]  # decimal commas
    try:
        return np.loadtxt(filled, delimiter=header.delimiter, usecols=wanted, comments=None, ndmin=2)
    except ValueError:
        pass
    found = []
    for line, text in zip(lines, texts, strict=True):
        row = split(text, header.delimiter)
        found.append([_number(source, line, header.columns[column], row[column]) for column in wanted])
    return np.array(found).reshape(len(lines), len(wanted))


def _filled(text: str, mark: str | None) -> str:
    """A row whose empty cells say `nan`, so that they are read as fast as the others."""
    if mark is None or not (mark * 2 in text or text.startswith(mark) or text.endswith(mark)):
        return text
    return mark.join(cell or "nan" for cell in text.split(mark))


def _number(source: Source, line: int, column: str, cell: str) -> float:
    """The number in a cell; a tracking state's confidence and a clock time's seconds."""
    if cell.lower() in NOTHING:
        return math.nan
    if cell[:1].isalpha() and not math.isnan(state := _state(cell)):
        return state
    if _is_clock(cell) and (time := clock(cell)) is not None:
        return time
    return number(source, line, column, cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell)


def _is_clock(cell: str) -> bool:
    """Whether a cell may be a clock time or a date."""
    return ":" in cell or "-" in cell[1:]


def _state(cell: str) -> float:
    """The number 0, 1 or 2 of a tracking state in words, 0 or 1 of false and true; nan for anything else."""
    if cell.lower() in ("true", "false"):
        return float(cell.lower() == "true")
    return 2.0 * state_confidence(cell)
