"""Delimited text as numbers: fast where all is well, exact where it is not.

A chunk of rows goes through `numpy.loadtxt`.  Only if that stumbles, over an
empty cell as over a mistake, is the chunk read cell by cell, and then an error
can say which line and column is to blame.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from nao_sim.recordings.source import Line, Source, is_skipped
from nao_sim.robot import Array

CHUNK = 8192  # rows; 2 MB of values


@dataclass(frozen=True)
class Header:
    """The line that names a table's columns.

    Attributes:
        line: its number in the file.
        delimiter: `,`, `;` or a tab; None for any spaces.
        columns: the names, in the file's order.
    """

    line: int
    delimiter: str | None
    columns: tuple[str, ...]


def header_of(line: Line) -> Header:
    """Split a header line at the first of tab, semicolon and comma that it holds."""
    number, text = line
    delimiter = next((mark for mark in "\t;," if mark in text), ",")
    return Header(number, delimiter, split(text, delimiter))


def split(text: str, delimiter: str | None) -> tuple[str, ...]:
    """The cells of a line, without the spaces and quotation marks around them."""
    return tuple(cell.strip().strip('"').strip() for cell in text.split(delimiter))


def check_columns(source: Source, header: Header) -> None:
    """Refuse unnamed and repeated columns.

    Raises:
        RecordingError: a name is empty or there twice.
    """
    for number, name in enumerate(header.columns, start=1):
        if not name:
            raise source.error("a column without a name", "a name for each column", header.line, number)
        if header.columns.index(name) + 1 < number:
            raise source.error(f"column '{name}' twice", "each column once", header.line, name)


def rows(source: Source, header: Header) -> Iterator[Line]:
    """The lines below the header that hold a frame."""
    for number, text in source.lines():
        only_empty_cells = header.delimiter == "\t" and "\t" in text
        if number > header.line and (only_empty_cells or not is_skipped(text)):
            yield number, text


def cells(source: Source, header: Header, row: Line) -> tuple[str, ...]:
    """The cells of one row.

    Raises:
        RecordingError: the row is shorter or longer than the header.
    """
    found = split(row[1], header.delimiter)
    if len(found) != len(header.columns):
        as_where = ", as in the header" if header.line else ""
        raise source.error(_count(len(found)), _count(len(header.columns)) + as_where, row[0])
    return found


def number(source: Source, line: int, column: str, cell: str) -> float:
    """The number in a cell; an empty cell is not a number (nan).

    Raises:
        RecordingError: the cell holds text.
    """
    if not cell:
        return math.nan
    try:
        if "_" in cell or not cell.isascii():  # float() reads 1_000 and digits of other scripts
            raise ValueError
        return float(cell)
    except ValueError:
        shown = cell if len(cell) <= 40 else cell[:37] + "..."  # noqa: PLR2004
        expected = "a number with a decimal point" if "," in cell else "a number"
        raise source.error(f"'{shown}'", expected, line, column) from None


def number_chunks(source: Source, header: Header) -> Iterator[tuple[Sequence[int], Array]]:
    """The numbers below the header, in pieces of at most `CHUNK` rows.

    Yields:
        Line numbers (N,) and values (N, C); an empty cell is nan.

    Raises:
        RecordingError: a row has the wrong length, or a cell holds text.
    """
    frames = rows(source, header)
    while chunk := list(islice(frames, CHUNK)):
        lines, texts = zip(*chunk, strict=True)
        yield lines, numbers(source, header, lines, texts)


def numbers(source: Source, header: Header, lines: Sequence[int], texts: Sequence[str]) -> Array:
    """The numbers (N, C) of some rows; an empty cell is nan.

    Args:
        source: the file.
        header: the columns of the rows.
        lines: (N,) the rows' numbers in the file.
        texts: (N,) the rows.

    Raises:
        RecordingError: a row has the wrong length, or a cell holds text.
    """
    width = len(header.columns)
    try:
        values = np.loadtxt(texts, delimiter=header.delimiter, comments=None, ndmin=2)
        if values.shape == (len(lines), width):
            return values
    except ValueError:
        pass
    return np.array([_row(source, header, row) for row in zip(lines, texts, strict=True)])


def _row(source: Source, header: Header, row: Line) -> list[float]:
    found = cells(source, header, row)
    return [number(source, row[0], name, cell) for name, cell in zip(header.columns, found, strict=True)]


def _count(values: int) -> str:
    return f"{values} value{'s' if values != 1 else ''}"
