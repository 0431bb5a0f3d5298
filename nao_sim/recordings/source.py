"""A recording's text, opened once and for all with every way that can go wrong.

Readers see numbered lines and never an operating system or codec error.
"""

from __future__ import annotations

import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from nao_sim.errors import RecordingError

Unit = Literal["deg", "rad"]
Line = tuple[int, str]  # 1-based number, text without its line end

LONGEST_LINE = 100_000  # characters; 27 columns of full-precision numbers take 700
PROBE = 4096  # bytes read to tell text from anything else
TEXT = "a recording in UTF-8 text"
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_SIGNATURES = {
    b"\x89PNG": "a PNG picture",
    b"\xff\xd8\xff": "a JPEG picture",
    b"GIF8": "a GIF picture",
    b"%PDF": "a PDF document",
    b"PK\x03\x04": "a ZIP archive or spreadsheet",
    b"\x1f\x8b": "a gzip archive",
    b"\xfd7zXZ": "an xz archive",
    b"\x93NUMPY": "a NumPy array",
}


@dataclass(frozen=True)
class Source:
    """A file to read, and what the caller says about it.

    Attributes:
        path: the file.
        unit: the caller's unit for angles that the file gives none for.
        rate: the caller's frame rate in Hz for a file without times.
    """

    path: Path
    unit: Unit | None = None
    rate: float | None = None

    def error(
        self, found: str, expected: str, line: int | None = None, column: str | int | None = None
    ) -> RecordingError:
        """The error that blames this file."""
        return RecordingError(self.path, found, expected, line, column)

    def probe(self) -> None:
        """Refuse what is no readable text file.

        Raises:
            RecordingError: missing, a folder, unreadable, empty or binary.
        """
        try:
            mode, size = (about := self.path.stat()).st_mode, about.st_size
            if stat.S_ISDIR(mode):
                raise self.error("a folder", "a file")
            if not stat.S_ISREG(mode):
                raise self.error("a device or pipe", "a file")
            with self.path.open("rb") as stream:
                start = stream.read(PROBE)
        except (OSError, ValueError) as error:
            raise self._unreadable(error) from None
        if size == 0:
            raise self.error("an empty file (0 bytes)", "a recording")
        if problem := _not_text(start):
            raise self.error(problem, TEXT)

    def lines(self) -> Iterator[Line]:
        """The file's lines, numbered, decoded and without a byte order mark.

        Raises:
            RecordingError: a line is too long, or not UTF-8.
        """
        try:
            with self.path.open(encoding="utf-8-sig", errors="surrogateescape") as stream:
                number = 0
                while text := stream.readline(LONGEST_LINE + 1):
                    number += 1
                    yield number, self._checked(number, text.rstrip("\n"))
        except (OSError, ValueError) as error:
            raise self._unreadable(error) from None

    def header(self) -> Line | None:
        """The first line that is neither blank nor a comment."""
        return next((line for line in self.lines() if not is_skipped(line[1])), None)

    def _checked(self, number: int, text: str) -> str:
        if len(text) > LONGEST_LINE:
            raise self.error(f"more than {LONGEST_LINE} characters", "one frame a line", number)
        if "\0" in text or (not text.isascii() and any("\udc80" <= letter <= "\udcff" for letter in text)):
            raise self.error("bytes that are not UTF-8 text", TEXT, number)
        return text

    def _unreadable(self, error: OSError | ValueError) -> RecordingError:
        if isinstance(error, FileNotFoundError):
            return self.error("no such file", "a recording")
        reason = error.strerror if isinstance(error, OSError) else None
        return self.error(f"cannot be read ({(reason or str(error)).lower()})", "a readable file")


def is_skipped(text: str) -> bool:
    """Whether a line is blank or a comment."""
    text = text.strip()
    return not text or text.startswith("#")


def _not_text(start: bytes) -> str | None:
    """What a file that opens with `start` is, unless it may be text."""
    for signature, name in _SIGNATURES.items():
        if start.startswith(signature):
            return name
    if start.startswith(_UTF16):
        return "UTF-16 text"
    return "binary data" if b"\0" in start else None
