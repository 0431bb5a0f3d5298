"""What a `.mat` file holds, however deep in structs and cells: arrays, names, and single numbers."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from nao_sim.body import joint_called
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.matlab_tags import check_tags
from nao_sim.robot import Array

LARGEST = 1 << 31  # bytes
TRACK = 3  # coordinates
NAMED = 5  # joints with a track of their own that make a person
_DEEPEST = 5


@dataclass(frozen=True, eq=False)
class Found:
    """What a file holds.

    Attributes:
        arrays: arrays of numbers with two axes or more, by where they are (`S.data`, `C{2}`).
        tracks: for each struct (or the file) of tracks by joint, (T, J, 3) and the names.
        names: lists of words.
        numbers: single numbers and vectors (N,).
        told: all variables with their sizes, for messages.
    """

    arrays: Mapping[str, Array]
    tracks: Mapping[str, tuple[Array, tuple[str, ...]]]
    names: tuple[tuple[str, ...], ...]
    numbers: Mapping[str, Array]
    told: tuple[str, ...]


def contents(source: Source) -> Found:
    """Read a file.

    Raises:
        RecordingError: it is damaged, or of a newer version than v7.
    """
    found = dict[str, Any]()
    for name, value in _variables(source).items():
        found |= dict(_walk(name, value, 0))
    arrays = {name: value for name, value in found.items() if _is_array(value)}
    tracks = {}
    for owner in dict.fromkeys(_owner(name) for name in arrays):
        mine = {name.rpartition(".")[2]: arrays[name] for name in arrays if _owner(name) == owner}
        if (track := _tracks(mine)) is not None:
            tracks[owner] = track
    numbers = {name: np.atleast_1d(np.asarray(value, float)) for name, value in found.items() if _is_vector(value)}
    names = tuple(value for value in found.values() if isinstance(value, tuple))
    return Found(arrays, tracks, names, numbers, tuple(f"{name} ({_size(value)})" for name, value in found.items()))


def _variables(source: Source) -> Mapping[str, Any]:
    """The file's variables as SciPy reads them."""
    from scipy.io import loadmat

    with source.open() as stream:
        content = stream.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise source.error(f"more than {LARGEST >> 20} MB", "a smaller .mat file")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if content.startswith(b"MATLAB 5.0"):
                check_tags(content)
            file: Any = io.BytesIO(content)  # SciPy's stubs know of paths only
            variables = loadmat(file, struct_as_record=False, squeeze_me=True)
    except NotImplementedError:
        raise source.error("a MATLAB v7.3 file (HDF5)", "an older format: save('file.mat', ..., '-v7')") from None
    except MemoryError:
        raise source.error("a .mat file that does not fit in memory", "a smaller one") from None
    except Exception as error:  # whatever a damaged file does to the reader: it has no family of errors of its own
        raise source.error(f"a damaged .mat file ({type(error).__name__})", "a whole one") from None
    return {name: value for name, value in variables.items() if not name.startswith("__")}


def _walk(name: str, value: Any, depth: int) -> Iterator[tuple[str, Any]]:
    """Arrays, words and numbers of a variable, those of equal cells as one array of frames."""
    if depth > _DEEPEST:
        return
    if hasattr(value, "_fieldnames"):
        for field in value._fieldnames:
            yield from _walk(f"{name}.{field}", getattr(value, field), depth + 1)
    elif isinstance(value, np.ndarray) and value.dtype == object:
        cells = list(value.ravel())
        if cells and all(isinstance(cell, str) for cell in cells):
            yield name, tuple(cells)
        elif _are_frames(cells):
            yield name, np.stack([np.asarray(cell, float) for cell in cells])
        else:
            for number, cell in enumerate(cells, start=1):
                yield from _walk(f"{name}{{{number}}}", cell, depth + 1)
    elif isinstance(value, np.ndarray) and value.dtype.kind == "U" and value.size:
        yield name, tuple(str(text).strip() for text in value.ravel())
    else:
        yield name, value


def _are_frames(cells: list[Any]) -> bool:
    """Whether cells are frames: arrays (J, 3) or (3, J) of one size."""
    if len(cells) < 2 or not all(isinstance(cell, np.ndarray) and cell.dtype.kind in "fiu" for cell in cells):  # noqa: PLR2004
        return False
    shapes = {cell.shape for cell in cells}
    return len(shapes) == 1 and len(shape := shapes.pop()) == 2 and TRACK in shape  # noqa: PLR2004


def _is_array(value: Any) -> bool:
    return isinstance(value, np.ndarray) and value.dtype.kind in "fiu" and value.ndim >= 2  # noqa: PLR2004


def _is_vector(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "fiu" and value.ndim <= 1 and value.size > 0
    return isinstance(value, int | float) and not isinstance(value, bool)


def _owner(name: str) -> str:
    return name.rpartition(".")[0]


def _tracks(arrays: Mapping[str, Array]) -> tuple[Array, tuple[str, ...]] | None:
    """The joints that have a track (T, 3) or (3, T) each, as one array (T, J, 3)."""
    joints = {name: array for name, array in arrays.items() if joint_called(name) and array.ndim == 2}  # noqa: PLR2004
    tall = {
        name: array if array.shape[1] == TRACK else array.T for name, array in joints.items() if TRACK in array.shape
    }
    if len(tall) < NAMED or len({array.shape for array in tall.values()}) > 1:
        return None
    return np.stack([np.asarray(array, float) for array in tall.values()], axis=1), tuple(tall)


def _size(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return " x ".join(map(str, value.shape)) or "1"
    return f"{len(value)} words" if isinstance(value, tuple) else type(value).__name__
