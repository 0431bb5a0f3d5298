"""Joint angles as NumPy arrays (.npz).

Arrays `joint_names` (N,), `positions` (T, N) and `times` (T,) s, and perhaps
`unit`: `rad` (which holds where it is missing, as everywhere inside) or `deg`;
hands run from 0 to 1.  A rollout of `nao-sim play` is such a file, too.
Pickled objects are never loaded.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from typing import Any
from zipfile import BadZipFile, ZipFile

import numpy as np
from numpy.typing import NDArray

from nao_sim.motion import JointTrajectory
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.source import Source
from nao_sim.robot import Array, load_robot

NAME = "joint-angle NPZ"
LOOKS = "a .npz of arrays joint_names (N,), positions (T, N) and times (T,)"
KIND = "binary"
NAMES = ("joint_names", "names", "joints")
POSITIONS = ("positions", "angles", "joint_positions", "joint_angles")
TIMES = ("times", "time")
UNITS = ("unit", "units")
ROLLOUT = ("command", "requested", "base_pose")  # arrays that only a rollout has
LARGEST_ANGLE = 2.0 * np.pi  # rad; no joint of NAO turns as far
LARGEST = 4 << 30  # bytes of one array
_ZIP = b"PK\x03\x04"
_UNREADABLE = (
    OSError, ValueError, TypeError, KeyError, EOFError, MemoryError, NotImplementedError, RuntimeError, SyntaxError,
    BadZipFile, zlib.error, struct.error,
)  # fmt: skip
Arrays = Mapping[str, NDArray[Any]]


def recognise(source: Source) -> str | None:
    """Why the file is a NumPy archive, or None."""
    start = source.start
    if not start.startswith(_ZIP):
        return None
    first = start[30 : 30 + int.from_bytes(start[26:28], "little")]  # the name in a ZIP's local file header
    return "a ZIP archive of NumPy arrays" if first.endswith(b".npy") else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's unit and rate where it has none.
        reason: why it is taken for this format.

    Returns:
        The recording; joints that are not named are not `given`, and a value
        that is not finite asks nothing.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    arrays = _arrays(source)
    joints = _joints(source, _one(source, arrays, NAMES))
    values = _numbers(source, POSITIONS, _one(source, arrays, POSITIONS), 2)
    if values.shape[1] != len(joints) or not len(values):
        found = f"shape {values.shape}"
        raise source.error(found, f"(T, {len(joints)}), a column for each name", column=_called(arrays, POSITIONS))
    unit, unit_note = _unit(source, arrays, values[:, ~load_robot().is_hand[joints]])
    times, time_note = _times(source, arrays, len(values))
    positions = np.full((len(times), len(load_robot().joint_names)), np.nan)
    positions[:, joints] = values * np.where(load_robot().is_hand[joints], 1.0, np.radians(1.0) if unit == "deg" else 1)
    motion = JointTrajectory(times, positions, np.isin(np.arange(positions.shape[1]), joints))
    notes = (unit_note, time_note, _rollout_note(arrays))
    return Recording(source.path, NAME, reason, motion, len(motion), tuple(note for note in notes if note))


def _arrays(source: Source) -> Arrays:
    """The archive's arrays that this format knows."""
    known = {*NAMES, *POSITIONS, *TIMES, *UNITS}
    with source.open() as stream:
        try:
            with ZipFile(stream) as archive:
                large = [entry.filename for entry in archive.infolist() if entry.file_size > LARGEST]
            if large:
                raise source.error(f"{large[0]}: more than {LARGEST >> 30} GB", "joint angles of one recording")
            stream.seek(0)
            with np.load(stream, allow_pickle=False) as file:
                return {name: file[name] if name in known else np.empty(0) for name in file.files}
        except _UNREADABLE as error:
            reason = " ".join(str(error).split()) or type(error).__name__
            raise source.error(f"a damaged or unreadable archive ({reason})", "a .npz of plain arrays") from None


def _called(arrays: Arrays, names: tuple[str, ...]) -> str:
    """The first of the names that an array has."""
    return next((name for name in names if name in arrays), names[0])


def _one(source: Source, arrays: Arrays, names: tuple[str, ...]) -> NDArray[Any]:
    if (name := _called(arrays, names)) not in arrays:
        here = ", ".join(arrays) or "nothing"
        raise source.error(f"arrays {here}", f"an array {' or '.join(names)}", column=name)
    return arrays[name]


def _joints(source: Source, names: NDArray[Any]) -> NDArray[np.int_]:
    """Indices (N,) in the joint vector."""
    index, column = load_robot().index, "joint_names"
    if names.dtype.kind not in "US" or names.ndim != 1 or not len(names):
        raise source.error(f"{names.dtype} of shape {names.shape}", "a list of NAOqi joint names", column=column)
    called = [name.decode("utf-8", "replace") if isinstance(name, bytes) else str(name) for name in names.tolist()]
    for number, name in enumerate(called):
        if name not in index:
            raise source.error("unknown joint", "a NAOqi joint name", column=name or column)
        if name in called[:number]:
            raise source.error("named twice", "each joint once", column=name)
    return np.array([index[name] for name in called])


def _numbers(source: Source, names: tuple[str, ...], values: NDArray[Any], dimensions: int) -> Array:
    if values.dtype.kind not in "fiu" or values.ndim != dimensions:
        found = f"{values.dtype} of shape {values.shape}"
        raise source.error(found, f"real numbers in {dimensions} dimension{'s' * (dimensions > 1)}", column=names[0])
    return values.astype(np.float64)


def _unit(source: Source, arrays: Arrays, angles: Array) -> tuple[str, str | None]:
    """The unit of the angles, and what to say of it."""
    said = str(arrays[name].tolist()) if (name := _called(arrays, UNITS)) in arrays else None
    if said not in (None, "rad", "deg"):
        raise source.error(f"'{said[:40] if said else said}'", "rad or deg", column=name)
    if said and source.unit not in (None, said):
        raise source.error(f"'{said}' by the file but '{source.unit}' by unit option", "one unit", column=name)
    if unit := said or source.unit:
        return unit, None if said else f"angles taken as {unit}, as told"
    largest = np.max(np.abs(angles), initial=0.0, where=np.isfinite(angles))
    if largest > LARGEST_ANGLE:
        expected = "radians, or an array unit, or --unit deg"
        raise source.error(f"angles up to {largest:.4g} and no unit", expected, column=_called(arrays, POSITIONS))
    return "rad", None if set(ROLLOUT) <= set(arrays) else "no array unit: angles taken as radians"


def _times(source: Source, arrays: Arrays, frames: int) -> tuple[Array, str | None]:
    """Times (T,) s, and what to say of them."""
    name = _called(arrays, TIMES)
    if name not in arrays:
        if source.rate is None:
            raise source.error("no times", "an array times (s), or the frame rate (--rate HZ)", column=name)
        return np.arange(frames) / source.rate, f"no times: {source.rate:g} frames a second, as told"
    if source.rate is not None:
        raise source.error(f"times and a rate of {source.rate:g} Hz", "no rate for a file with times", column=name)
    times = _numbers(source, TIMES, arrays[name], 1)
    if len(times) != frames:
        raise source.error(f"{len(times)} times for {frames} frames", "a time for each frame", column=name)
    wrong = ~(np.isfinite(times) & (times > np.concatenate([[-np.inf], times[:-1]])))
    if wrong.any():
        first = int(wrong.argmax())
        expected = f"a finite time after {times[first - 1]:g} s" if first else "a finite time in seconds"
        raise source.error(f"{times[first]:g} s in frame {first}", expected, column=name)
    return times, None


def _rollout_note(arrays: Arrays) -> str | None:
    rollout = set(ROLLOUT) <= set(arrays)
    return "a rollout: read is what the simulated joints did, not what was asked of them" if rollout else None


def npz_arrays(motion: JointTrajectory) -> dict[str, Any]:
    """A trajectory's given joints as this format's arrays, exact to the last bit."""
    names = np.array(load_robot().joint_names)[motion.given]
    positions = motion.positions[:, motion.given]
    return {"joint_names": names, "positions": positions, "times": motion.times, "unit": np.array("rad")}
