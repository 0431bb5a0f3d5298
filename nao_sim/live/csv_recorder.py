"""What was received, on disk at once, as a table that `nao-sim play` reads.

A row a frame in the sender's own unit and axes: its time, and x, y, z and
confidence of each joint of the layout, empty where missing.  Every row is
handed to the operating system whole, so that a program that ends in any way
leaves whole rows behind.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.live.protocol import Frame

LARGEST = 32 * 1024 * 1024  # bytes, of a recording that a client asked for: 20 minutes of 24 joints


class CsvRecorder:
    """Writes one sender's frames.

    Args:
        file: where to; unbuffered, so that a row is there when `write` returns.
        columns: the points that make up each joint.
        largest: bytes after which nothing more is written; None for no limit.

    Attributes:
        rows: how many there are.
        full: whether there was no room for a row.
    """

    def __init__(self, file: IO[bytes], columns: Mapping[str, Sequence[int]], largest: int | None = None) -> None:
        self._file, self._columns = file, [list(points) for points in columns.values()]
        self._left = math.inf if largest is None else float(largest)
        self.rows, self.full = 0, False
        axes = [f"{joint}_{what}" for joint in columns for what in ("x", "y", "z", "confidence")]
        self._put(",".join(["time", *axes]) + "\n")

    def write(self, frame: Frame) -> None:
        """Add a frame."""
        sure = np.where(np.isnan(frame.points).any(axis=1), np.nan, np.nan_to_num(frame.confidence, nan=1.0))
        rows = np.column_stack([frame.points, sure])
        joints = np.stack([rows[points].mean(axis=0) for points in self._columns])
        numbers = (_text(value) for value in joints.ravel().tolist())
        self._put(",".join([f"{frame.time:.6f}", *numbers]) + "\n")
        self.rows += not self.full

    def _put(self, line: str) -> None:
        data = line.encode()
        self._left -= len(data)
        self.full = self._left < 0
        if not self.full:
            self._file.write(data)

    def text(self) -> bytes:
        """All that was written; only of a file that can be read, too."""
        self._file.seek(0)
        found = self._file.read()
        self._file.seek(0, 2)
        return found

    def close(self) -> None:
        """Let go of the file."""
        self._file.close()


def _text(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.7g}"


def record_to(path: Path, columns: Mapping[str, Sequence[int]]) -> CsvRecorder:
    """A recorder that writes a new file, `name-2`, `name-3` ... where files are there already.

    What was received cannot be had again, so nothing is overwritten.

    Raises:
        UsageError: it cannot be written.
    """
    number, found = 1, path
    while True:
        try:
            return CsvRecorder(found.open("xb", buffering=0), columns)
        except FileExistsError:
            number += 1
            found = path.with_name(f"{path.stem}-{number}{path.suffix}")
        except OSError as error:
            raise UsageError(f"{found}: cannot write there: {error.strerror}") from None


def record_aside(columns: Mapping[str, Sequence[int]]) -> CsvRecorder:
    """A recorder whose file has no name and goes when it is closed."""
    return CsvRecorder(tempfile.TemporaryFile(buffering=0), columns, LARGEST)
