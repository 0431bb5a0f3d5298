"""The exception family: every mistake a user can make ends in one of these.

A message names the file, the line or frame, the column or joint, what was
found and what was expected.  The command line prints it as one line on stderr
and leaves with `exit_status`.
"""

from __future__ import annotations

from pathlib import Path


class NaoSimError(Exception):
    """Base of all errors raised on purpose by nao_sim."""

    exit_status = 2


class UsageError(NaoSimError):
    """An option or argument that cannot be honoured."""


class RecordingError(NaoSimError):
    """A recording that cannot be read.

    Args:
        path: the file.
        found: what is there, in the reader's words.
        expected: what should be there.
        line: 1-based line number, where one is to blame.
        column: column name (or 1-based number), where one is to blame.
    """

    def __init__(
        self,
        path: str | Path,
        found: str,
        expected: str,
        line: int | None = None,
        column: str | int | None = None,
    ) -> None:
        self.path, self.found, self.expected = Path(path), found, expected
        self.line, self.column = line, column
        place = str(path)
        place += f", line {line}" if line is not None else ""
        place += f", column {column}" if column is not None else ""
        super().__init__(f"{place}: {found}; expected {expected}")


class RenderingError(NaoSimError):
    """No OpenGL back end can render on this machine."""

    exit_status = 3
