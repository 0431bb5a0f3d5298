"""A recording's bytes and text, opened once and for all with every way that can go wrong.

Readers see numbered lines and never an operating system, compression or codec
error.  A file compressed with gzip, bzip2 or xz is read as what is in it.
"""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import IO, Any, Literal

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
    b"\x93NUMPY": "a NumPy array",
}
_COMPRESSED: dict[bytes, Any] = {b"\x1f\x8b": gzip.open, b"\xfd7zXZ\x00": lzma.open, b"BZh": bz2.open}
_TAR_MAGIC = slice(257, 262)
Kind = Literal["text", "binary", "folder"]


@dataclass(frozen=True)
class Source:
    """A file to read, and what the caller says about it.

    Attributes:
        path: the file.
        unit: the caller's unit for angles that the file gives none for.
        rate: the caller's frame rate in Hz for a file without times.
        layout: a TOML table that says how a skeleton stands in the file.
        person: which of several people, by the file's own id.
        rig: the ASF file that an AMC file moves.
    """

    path: Path
    unit: Unit | None = None
    rate: float | None = None
    layout: Path | None = None
    person: str | None = None
    rig: Path | None = None

    def error(
        self, found: str, expected: str, line: int | None = None, column: str | int | None = None
    ) -> RecordingError:
        """The error that blames this file."""
        return RecordingError(self.path, found, expected, line, column)

    def kind(self) -> Kind:
        """What sort of thing the path is; refuse what nobody can read.

        Raises:
            RecordingError: missing, a device, unreadable, empty or damaged.
        """
        try:
            mode, size = (about := self.path.stat()).st_mode, about.st_size
        except (OSError, ValueError) as error:
            raise self._unreadable(error) from None
        if stat.S_ISDIR(mode):
            return "folder"
        if not stat.S_ISREG(mode):
            raise self.error("a device or pipe", "a file")
        if size == 0:
            raise self.error("an empty file (0 bytes)", "a recording")
        start = self.start
        if start[_TAR_MAGIC] == b"ustar":
            raise self.error("a tar archive", "one recording: unpack it first (tar -xf)")
        return "binary" if not_text(start) else "text"

    @cached_property
    def start(self) -> bytes:
        """The first bytes, decompressed."""
        with self.open() as stream:
            return stream.read(PROBE)

    @contextmanager
    def open(self) -> Iterator[IO[bytes]]:
        """The file's bytes, decompressed.

        Raises:
            RecordingError: it cannot be read, or its compressed data is damaged.
        """
        try:
            with self.path.open("rb") as raw:
                magic = raw.read(6)
                raw.seek(0)
                opener = next((opener for mark, opener in _COMPRESSED.items() if magic.startswith(mark)), None)
                with opener(raw) if opener else raw as stream:
                    yield stream
        except (EOFError, lzma.LZMAError, zlib.error, gzip.BadGzipFile) as error:
            raise self.error(f"damaged compressed data ({str(error).lower()})", "a whole file") from None
        except (OSError, ValueError) as error:
            raise self._unreadable(error) from None

    def lines(self) -> Iterator[Line]:
        """The file's lines, numbered, decoded and without a byte order mark.

        Raises:
            RecordingError: a line is too long, or not UTF-8.
        """
        with self.open() as stream, io.TextIOWrapper(stream, "utf-8-sig", errors="surrogateescape") as text_stream:
            number = 0
            while text := text_stream.readline(LONGEST_LINE + 1):
                number += 1
                yield number, self._checked(number, text.rstrip("\n"))

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


def not_text(start: bytes) -> str | None:
    """What a file that opens with `start` is, unless it may be text."""
    for signature, name in _SIGNATURES.items():
        if start.startswith(signature):
            return name
    if start.startswith(_UTF16):
        return "UTF-16 text"
    return "binary data" if b"\0" in start else None
