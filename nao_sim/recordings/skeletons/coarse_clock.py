"""Clocks that stand still for several frames, as one of whole seconds does."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nao_sim.recordings.source import Source
from nao_sim.robot import Array

MOST = 0.6  # of the frames at the time of the one before: more are no slips of a good clock
FEWEST = 3  # times that tell how fast frames follow each other
NEAR = 0.25  # sizes of the body, from a frame to the next of the same person
SAMPLE = 500  # pairs of frames that tell whether somebody moves
COLUMN = "time"


def finer(source: Source, times: Array, values: Array) -> tuple[Array, tuple[str, ...]]:
    """Times between the ticks of a clock that is too coarse for the frames.

    Frames that say the same as the one before are no new ones, and far from it
    somebody else; both are left alone.

    Args:
        source: the file.
        times: (T,) as the file has them.
        values: (T, J, 3) the points.

    Returns:
        Times (T,), evenly spread from each tick to the next, or as they were; and a note.

    Raises:
        RecordingError: there are too few ticks to tell.
    """
    same = np.flatnonzero(np.diff(times) == 0.0) + 1
    ordered = bool(np.isfinite(times).all() and (np.diff(times) >= 0.0).all())
    if not ordered or len(same) <= MOST * len(times) or not _moves(values, same):
        return times, ()
    ticks = np.flatnonzero(np.diff(times, prepend=-np.inf) > 0.0)
    if len(ticks) < FEWEST:
        raise source.error(f"{len(times)} frames at {len(ticks)} times", "a time for each frame", column=COLUMN)
    note = f"a clock of {len(ticks)} times for {len(times)} frames: spread evenly between them"
    return _spread(times, ticks), (note,)


def _moves(values: Array, frames: NDArray[np.intp]) -> bool:
    """Whether somebody moves a little from the frames before to some frames (N,)."""
    some = frames[:: max(len(frames) // SAMPLE, 1)]
    now, before = np.asarray(values[some]), np.asarray(values[some - 1])
    steps = np.linalg.norm(now - before, axis=2)
    known = np.isfinite(steps) & (now != 0.0).any(axis=2) & (before != 0.0).any(axis=2)
    if not known.any():
        return False
    there = now[known.any(axis=1)]
    size = np.nanmedian(
        np.nanstd(np.where((there != 0.0).any(axis=2, keepdims=True), there, np.nan), axis=1).max(axis=1)
    )
    return bool((steps[known] > 0.0).mean() > MOST and np.median(steps[known]) < NEAR * size)


def _spread(times: Array, ticks: NDArray[np.intp]) -> Array:
    """Times (T,) between the frames (N,) at which the clock moved on; the first tick may have begun before the file."""
    whole = ticks[1:]
    pace = float((times[whole[-1]] - times[whole[0]]) / (whole[-1] - whole[0]))
    frames = np.arange(len(times))
    found: Array = np.interp(frames, whole, times[whole])
    found[: whole[0]] = times[whole[0]] + pace * (frames[: whole[0]] - whole[0])
    found[whole[-1] :] = times[whole[-1]] + pace * (frames[whole[-1] :] - whole[-1])
    return found
