"""NumPy's files of points: an array of frames, joints and coordinates in any order (`.npy`), or several (`.npz`).

Pickled objects are never loaded.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from typing import IO, Any
from zipfile import BadZipFile, ZipFile

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.layout_file import read_layout
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.matlab_arrays import Found
from nao_sim.recordings.tables.point_arrays import COORDINATES, chosen

NAME = "NumPy arrays of points"
LOOKS = "a .npy or .npz with an array of frames x joints x 3"
KIND = "binary"
LARGEST = 4 << 30  # bytes of one array
NAMED = ("joint_names", "names", "joints")  # of joint angles, which are another format
_ZIP, _NPY = b"PK\x03\x04", b"\x93NUMPY"
_UNREADABLE = (
    OSError, ValueError, TypeError, KeyError, EOFError, MemoryError, NotImplementedError, RuntimeError, SyntaxError,
    BadZipFile, zlib.error, struct.error,
)  # fmt: skip


def recognise(source: Source) -> str | None:
    """Why the file is one of NumPy's with points, or None."""
    if source.start.startswith(_NPY):
        return "a NumPy array"
    if not source.start.startswith(_ZIP):
        return None
    try:
        with source.open() as stream, ZipFile(stream) as archive:
            shapes = dict(_shapes(archive))
    except _UNREADABLE:
        return None
    if any(name in shapes and shapes[name][1] in "US" for name in NAMED) and "positions" in shapes:
        return None
    sizes = {len(layout) for layout in builtin()}
    if source.layout is not None:
        sizes = {len(read_layout(source.layout))}
    points = [name for name, (shape, kind) in shapes.items() if kind in "fiu" and _may_be_points(shape, sizes)]
    return f"a ZIP archive of NumPy arrays, such as {points[0]}" if points else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file; its `person` is the name of an array, where several may be meant.
        reason: why it is taken for this format.

    Returns:
        The recording: the one array that makes a person.

    Raises:
        RecordingError: none does, or several do (they are named), or the file is damaged.
    """
    order, understood = chosen(source, _contents(source))
    return understood.recording(source, NAME, f"{reason}, {order.name} as {order.axes}", len(order.values))


def _shapes(archive: ZipFile) -> Iterator[tuple[str, tuple[tuple[int, ...], str]]]:
    """The arrays of an archive with their shapes and kinds of values."""
    for entry in archive.infolist():
        if entry.filename.endswith(".npy"):
            with archive.open(entry) as stream:
                yield entry.filename.removesuffix(".npy"), _shape(stream)


def _shape(stream: IO[bytes]) -> tuple[tuple[int, ...], str]:
    read_header = npy.read_array_header_1_0 if npy.read_magic(stream) == (1, 0) else npy.read_array_header_2_0
    shape, _, dtype = read_header(stream)
    return tuple(shape), dtype.kind


def _may_be_points(shape: tuple[int, ...], sizes: set[int]) -> bool:
    """Whether an array of this shape may have the points of a known skeleton."""
    shape = tuple(side for side in shape if side != 1)
    if len(shape) == 3:  # noqa: PLR2004
        return any(side in COORDINATES for side in shape) and any(side in sizes for side in shape)
    columns = {size * width for size in sizes for width in (3, 4)}
    return len(shape) == 2 and (shape[1] in columns or (shape[1] - 1) in columns)  # noqa: PLR2004


def _contents(source: Source) -> Found:
    """What a file holds."""
    told, found = list[str](), dict[str, NDArray[Any]]()
    for name, array in _arrays(source).items():
        told.append(f"{name} ({' x '.join(map(str, array.shape)) or 1})")
        found[name] = np.squeeze(array)
    arrays = {name: array for name, array in found.items() if array.dtype.kind in "fiu" and array.ndim >= 2}  # noqa: PLR2004
    numbers = {
        name: np.atleast_1d(array).astype(float)
        for name, array in found.items()
        if array.dtype.kind in "fiu" and array.ndim < 2 and array.size  # noqa: PLR2004
    }
    names = tuple(tuple(map(str, array.tolist())) for array in found.values() if array.dtype.kind == "U" and array.ndim)
    return Found(arrays, {}, names, numbers, tuple(told))


def _arrays(source: Source) -> dict[str, NDArray[Any]]:
    """A file's arrays, those of objects without what they hold."""
    single = source.start.startswith(_NPY)
    with source.open() as stream:
        try:
            if single:
                return {"array": np.load(stream, allow_pickle=False)}
            with ZipFile(stream) as archive:
                large = [entry.filename for entry in archive.infolist() if entry.file_size > LARGEST]
                if large:
                    raise source.error(f"{large[0]}: more than {LARGEST >> 30} GB", "the points of one recording")
                plain = [name for name, (_, kind) in _shapes(archive) if kind != "O"]
            stream.seek(0)
            with np.load(stream, allow_pickle=False) as file:
                return {name: file[name] for name in plain}
        except _UNREADABLE as error:
            reason = " ".join(str(error).split()) or type(error).__name__
            raise source.error(f"a damaged or unreadable NumPy file ({reason})", "one of plain arrays") from None
