"""A manifest: a CSV that says which stretch of which recording shows what, and who made it.

    path,label,user,start,end,layout,split
    anna/wave.csv,wave,anna,,,,
    anna/session.csv,clap,anna,3.2,5.0,,
    anna/session.csv,none,anna,8.0,9.5,,

`path`, `label` and `user` must be there, in any order; the other columns may be.
Paths are relative to the manifest; a path may go on into a tar or ZIP archive
(`signs.zip/anna/wave.csv`).  `none` labels what is no gesture.  A label may be
empty where the recording names what it shows.  `start` and `end` are seconds
after the recording's first frame; of a table of postures, which has no times, the
first and the last posture, counted from 1.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from nao_sim.errors import RecordingError
from nao_sim.files import beside
from nao_sim.recordings.archive import held_by
from nao_sim.recordings.skeletons.layouts import FOLDER as LAYOUTS
from nao_sim.recordings.source import Source, is_skipped
from nao_sim.recordings.table import Header, check_columns, header_of, number

Split = Literal["train", "test"]
REQUIRED = ("path", "label", "user")
COLUMNS = (*REQUIRED, "start", "end", "layout", "split")
SPLITS: dict[str, Split] = {"train": "train", "test": "test"}
WANTED = f"a manifest: a CSV with the columns {', '.join(REQUIRED)} and, if need be, {', '.join(COLUMNS[3:])}"


@dataclass(frozen=True, order=True)
class Row:
    """A stretch of a recording.

    Attributes:
        path: the recording, relative to the manifest's folder or absolute.
        start: s, where the stretch begins; where the recording does if None.
        end: s, where it ends; where the recording does if None.
        label: what it shows, `none` where no gesture; empty where the recording says it.
        user: who made it; may be empty where nobody knows.
        layout: name of a built-in layout, or a TOML table, relative as `path`.
        split: whether to learn from it or to judge by it; empty where the manifest does not say.
        line: of the manifest.
    """

    path: str
    start: float | None = None
    end: float | None = None
    label: str = ""
    user: str = ""
    layout: str = ""
    split: Split | Literal[""] = ""
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class Manifest:
    """A data set.

    Attributes:
        path: of the manifest.
        rows: in the file's order.
    """

    path: Path
    rows: tuple[Row, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns that it needs."""
        return tuple(name for name in COLUMNS if name in REQUIRED or any(_text(row, name) for row in self.rows))

    def file_of(self, row: Row) -> Path:
        """Where a row's recording is; it may be inside an archive."""
        return self.path.parent / row.path

    def layout_of(self, row: Row) -> Path | None:
        """The table of a row's layout; None where the row names none."""
        if not row.layout:
            return None
        built_in = LAYOUTS / f"{row.layout}.toml"
        return built_in if built_in.is_file() else self.path.parent / row.layout

    def error(self, row: Row, found: str, expected: str, column: str | None = None) -> RecordingError:
        """The error that blames a row."""
        return RecordingError(self.path, found, expected, row.line, column)


def load_manifest(path: Path) -> Manifest:
    """Read a manifest, and look whether its files are there.

    Raises:
        RecordingError: something in it is not as it should be; the message names the line and the column.
    """
    source = Source(path)
    if (kind := source.kind()) != "text":
        raise source.error("a folder" if kind == "folder" else "binary data", WANTED)
    header = _header(source)
    lines = [line for line in source.lines() if line[0] > header.line and not is_skipped(line[1])]
    rows = tuple(_row(source, header, *line) for line in lines)
    if not rows:
        raise source.error("a header and no rows", "a row for each labelled stretch", header.line)
    manifest = Manifest(path, rows)
    for row in rows:
        _check_files(manifest, row)
    _check_repeated(manifest)
    return manifest


def save_manifest(manifest: Manifest) -> None:
    """Write a manifest where its `path` is, rows as they are.

    Raises:
        UsageError: it cannot be written there.
    """
    rows = [manifest.columns, *([_text(row, name) for name in manifest.columns] for row in manifest.rows)]
    with beside(manifest.path) as draft:
        draft.write_text("".join(map(_line, rows)), encoding="utf-8")


def _line(row: Sequence[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(row)
    line = text.getvalue()
    return '"' + line.replace(",", '",', 1) if line.startswith("#") else line  # else it would be a comment


def _text(row: Row, column: str) -> str:
    value = getattr(row, column)
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)


def _header(source: Source) -> Header:
    line = source.header()
    if line is None:
        raise source.error("only blank lines and comments", WANTED)
    header = header_of(line)
    header = Header(header.line, header.delimiter, tuple(name.lower() for name in header.columns))
    check_columns(source, header)
    if missing := [name for name in REQUIRED if name not in header.columns]:
        raise source.error(f"no column {', '.join(missing)}", WANTED, header.line)
    if strange := [name for name in header.columns if name not in COLUMNS]:
        raise source.error("unknown column", f"any of {', '.join(COLUMNS)}", header.line, strange[0])
    return header


def _row(source: Source, header: Header, line: int, text: str) -> Row:
    found = dict(zip(header.columns, _cells(source, header, line, text), strict=True))
    if not found["path"]:
        raise source.error("an empty cell", "the name of a recording", line, "path")
    start, end = (_seconds(source, line, name, found.get(name, "")) for name in ("start", "end"))
    if start is not None and end is not None and end <= start:
        raise source.error(f"end {end:g} after start {start:g}", "an end later than the start", line, "end")
    split = found.get("split", "").lower()
    if split not in ("", *SPLITS):
        raise source.error(f"'{split}'", "train or test", line, "split")
    side: Split | Literal[""] = SPLITS.get(split, "")
    return Row(found["path"], start, end, found["label"], found["user"], found.get("layout", ""), side, line)


def _cells(source: Source, header: Header, line: int, text: str) -> list[str]:
    """The cells of a row, in which quotation marks may protect the delimiter."""
    try:
        found = next(csv.reader([text], delimiter=header.delimiter or ",", strict=True, skipinitialspace=True))
    except csv.Error as error:
        raise source.error(f"quotation marks that do not fit ({error})", "a row of a CSV", line) from None
    if len(found) != len(header.columns):
        many = "1 value" if len(found) == 1 else f"{len(found)} values"
        raise source.error(many, f"{len(header.columns)} values, as in the header", line)
    return [cell.strip() for cell in found]


def _seconds(source: Source, line: int, column: str, cell: str) -> float | None:
    value = number(source, line, column, cell)
    if cell and not math.isfinite(value):
        raise source.error(f"'{cell}'", "a finite number of seconds", line, column)
    return value if cell else None


def _check_files(manifest: Manifest, row: Row) -> None:
    """Refuse a row whose recording or layout is not there."""
    file, layout = manifest.file_of(row), manifest.layout_of(row)
    if not file.exists() and held_by(file) is None:
        raise manifest.error(row, f"no such file: {file}", "a recording, relative to the manifest", "path")
    if layout is not None and not layout.is_file():
        known = ", ".join(sorted(each.stem for each in LAYOUTS.glob("*.toml")))
        raise manifest.error(row, f"unknown layout '{row.layout}'", f"a TOML table, or one of {known}", "layout")


def _check_repeated(manifest: Manifest) -> None:
    """Refuse a stretch that is there twice."""
    first: dict[tuple[str, float | None, float | None], Row] = {}
    for row in manifest.rows:
        known = first.setdefault((row.path, row.start, row.end), row)
        if known is not row:
            again = f"the same stretch of {row.path} as in line {known.line}"
            said = again if known.label == row.label else f"{again}, labelled {known.label} and {row.label}"
            raise manifest.error(row, said, "each stretch once")


def in_order(rows: Iterable[Row]) -> list[Row]:
    """Rows in an order of their own, so that a manifest's order changes no result."""
    none = -math.inf
    return sorted(rows, key=lambda row: (row.path, none if row.start is None else row.start, row.end or math.inf))
