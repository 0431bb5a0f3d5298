"""Text of numbers without names: its separator, its lines, and its frames as arrays."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice

from nao_sim.recordings.source import Line, Source, is_skipped
from nao_sim.recordings.table import Header, numbers
from nao_sim.robot import Array

CHUNK = 2**20  # numbers read at a time, 8 MB
_NO_NUMBER = re.compile(r"-?(?:1\.#\w+|nan\([^)]*\))", re.IGNORECASE)  # what C prints for nan


@dataclass(frozen=True)
class Style:
    """How the numbers of a line are set apart.

    Attributes:
        separator: between two numbers; None for any spaces.
        trailing: whether one stands after the last number, too.
        comma: whether numbers have decimal commas.
    """

    separator: str | None
    trailing: bool = False
    comma: bool = False

    def plain(self, text: str) -> str:
        """A line with decimal points and without what trails it."""
        if self.trailing:
            text = text.rstrip().removesuffix(self.separator or "")
        text = text.replace(",", ".") if self.comma else text
        return _NO_NUMBER.sub("nan", text) if "#" in text or "(" in text else text

    def cells(self, text: str) -> list[str]:
        """The cells of a line."""
        return self.plain(text).split(self.separator)


def style_of(text: str, separator: str | None = None) -> Style:
    """The style that a line of numbers shows; with decimal commas only where nothing else makes numbers of it.

    Args:
        text: the line.
        separator: what is told to stand between two numbers.
    """
    marks = [separator] if separator else [*(mark for mark in ";,\t" if mark in text.strip()), " "]
    styles = []
    for mark in marks:
        set_apart = None if mark == " " else mark
        trailing = set_apart is not None and text.rstrip(" \r").endswith(set_apart)
        styles += [Style(set_apart, trailing, comma) for comma in (False, True) if not (comma and mark == ",")]
    return next((style for style in styles if are_numbers(style.cells(text))), styles[0])


def are_numbers(cells: Sequence[str]) -> bool:
    """Whether all cells are numbers, nan or empty."""
    try:
        found = [float(cell or "nan") for cell in (cell.strip() for cell in cells)]
    except ValueError:
        return False
    return bool(found)


@dataclass(frozen=True)
class Block:
    """How the lines of a file make frames.

    Attributes:
        style: of the lines.
        lines: lines a frame that count.
        between: lines after each of them that do not.
        header: lines above the first frame.
        counted: whether a line that counts the frame's lines opens each frame.
        end: the text of a line after which nothing counts.
        columns: names of the columns, for messages.
    """

    style: Style
    lines: int = 1
    between: int = 0
    header: int = 0
    counted: bool = False
    end: str | None = None
    columns: tuple[str, ...] = ()


@dataclass(eq=False)
class Frames:
    """The frames of a file, piece by piece.

    Attributes:
        notes: what was left out, once all is read.
    """

    source: Source
    block: Block
    notes: list[str] = field(default_factory=list)

    def chunks(self) -> Iterator[tuple[list[int], Array]]:
        """Line numbers (N,) and numbers (N, lines x columns) of at most `CHUNK` numbers' worth of frames.

        Raises:
            RecordingError: a line has the wrong length, or a cell holds text.
        """
        block, width = self.block, len(self.block.columns)
        header = Header(0, block.style.separator, block.columns)
        frames = self._frames()
        size = max(CHUNK // (block.lines * width), 1)
        while chunk := list(islice(frames, size)):
            rows = [row for frame in chunk for row in frame]
            where = [number for number, _ in rows]
            texts = [self.block.style.plain(text) for _, text in rows]
            values = numbers(self.source, header, where, texts)
            yield where[:: block.lines], values.reshape(len(chunk), block.lines * width)

    def spread(self, wanted: int) -> Array:
        """Numbers (N, C) of at least `wanted` lines, if there are, from all over a file of a frame a line."""
        kept, stride = list[Line](), 1
        for place, line in enumerate(self.lines()):
            if place % stride == 0:
                kept.append(line)
            if len(kept) > 2 * wanted:
                kept, stride = kept[::2], 2 * stride
        header = Header(0, self.block.style.separator, self.block.columns)
        where, texts = [number for number, _ in kept[:-1]], [self.block.style.plain(text) for _, text in kept[:-1]]
        return numbers(self.source, header, where, texts)

    def lines(self) -> Iterator[Line]:
        """The lines that hold numbers."""
        block = self.block
        for number, text in self.source.lines():
            only_empty_cells = block.style.separator == "\t" and "\t" in text
            if number <= block.header or (is_skipped(text) and not only_empty_cells):
                continue
            if block.end is not None and text.strip() == block.end:
                return
            yield number, text

    def _frames(self) -> Iterator[list[Line]]:
        """The lines of each whole frame; a last one that breaks off is left out, and said so."""
        frames = self._counted() if self.block.counted else self._plain()
        before: list[Line] = []
        first = True
        for frame in frames:
            if before:
                yield before
                first = False
            before = frame
        if not before:
            return
        short = len(before) < self.block.lines or len(self.block.style.cells(before[-1][1])) < len(self.block.columns)
        if short and not first:
            self.notes.append(f"the last frame (line {before[0][0]}) breaks off: left out")
        elif len(before) < self.block.lines:
            raise self.source.error(f"{len(before)} lines", f"a frame of {self.block.lines} lines", before[0][0])
        else:
            yield before

    def _plain(self) -> Iterator[list[Line]]:
        lines, stride = self.lines(), 1 + self.block.between
        while frame := list(islice(lines, self.block.lines * stride)):
            yield frame[::stride]

    def _counted(self) -> Iterator[list[Line]]:
        """Frames that say how many lines they have: none, one person's or several's."""
        lines, stride = self.lines(), 1 + self.block.between
        need, crowd = self.block.lines * stride, 0
        for number, text in lines:
            cells = text.split()
            if len(cells) != 1 or not cells[0].isdecimal() or int(cells[0]) % need:
                raise self.source.error(f"'{text.strip()[:40]}'", f"how many lines the frame has, 0 or {need}", number)
            people = int(cells[0]) // need
            crowd += people > 1
            asked = self.source.person or ""
            wanted = int(asked) if asked.isdecimal() else 1
            frame = list(islice(lines, int(cells[0])))[(wanted - 1) * need : wanted * need][::stride]
            yield frame if people >= wanted > 0 else [(number, self._nobody())] * self.block.lines
        if crowd:
            self.notes.append(f"several people in {crowd} frames: person {wanted} of each frame taken (--person)")

    def _nobody(self) -> str:
        return (self.block.style.separator or " ").join(["nan"] * len(self.block.columns))
