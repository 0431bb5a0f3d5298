"""When the frames of a recording of points were: from its times, its frame numbers, or a rate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from nao_sim.recordings.skeletons.layout_file import TIMES, read_layout
from nao_sim.recordings.source import Source
from nao_sim.robot import Array

SLOWEST, FASTEST, USUAL = 5.0, 1000.0, 30.0  # Hz, of anything that records people
CLEAR = 0.5  # of a log ratio, by which one unit's rate must be nearer to the usual one than another's
NUMBERS = 5.0  # whole numbers with a smaller step count frames: a step of 5 ms is 200 Hz
COLUMN = "time"


def seconds(
    source: Source,
    times: Array | None,
    frames: int,
    rate: float | None,
    unit: float | None,
    lines: Sequence[int] | None,
) -> tuple[Array, tuple[str, ...]]:
    """When the frames were.

    Args:
        source: the file, with the caller's rate.
        times: (T,) as the file has them, or None.
        frames: how many there are, T.
        rate: Hz, the usual rate of such files.
        unit: seconds in one unit of the times; 0 for frame numbers, None where nothing tells.
        lines: (T,) where the frames stand in the file, for messages.

    Returns:
        Times (T,) s, from 0 and strictly increasing but for frames to leave
        out, which are nan; and what a user should know of them.

    Raises:
        RecordingError: no times and no rate, times and a rate, times that go
            backwards or may be in several units.
    """
    if times is None:
        chosen, note = _rate(source, rate, "no times")
        return np.arange(frames) / chosen, (note,)
    repeated, notes = _repeated(source, times, lines)
    since = np.where(repeated, np.nan, times - times[0])
    unit, unit_notes = _unit(source, times[~repeated], unit)
    if unit == 0.0:
        chosen, note = _rate(source, rate, "frame numbers for times")
        return since / chosen, (*notes, note)
    if source.rate is not None:
        where = lines[0] if lines is not None else None
        raise source.error(f"times and a rate of {source.rate:g} Hz", "no rate for a file with times", where, COLUMN)
    return since * unit, (*notes, *unit_notes)


def _rate(source: Source, usual: float | None, what: str) -> tuple[float, str]:
    if source.rate is not None:
        return source.rate, f"{what}: {source.rate:g} frames a second, as told"
    if usual is not None:
        own = source.layout is not None and read_layout(source.layout).rate is not None
        whose = f"as layout {source.layout} says" if own else "as usual for such files"
        return usual, f"{what}: {usual:g} frames a second, {whose} (--rate tells another)"
    raise source.error(what, "times, or the frame rate (--rate HZ)")


def _repeated(source: Source, times: Array, lines: Sequence[int] | None) -> tuple[NDArray[np.bool_], tuple[str, ...]]:
    """Which frames have the time of the one before, and a note of how many."""
    step = np.diff(times, prepend=-np.inf)
    if not np.isfinite(times).all() or (step < 0.0).any():
        bad = int((~np.isfinite(times) | (step < 0.0)).argmax())
        line = lines[bad] if lines is not None else bad + 1
        expected = f"a time after {times[bad - 1]:.12g}" if np.isfinite(times[bad]) else "a finite time"
        raise source.error(f"{times[bad]:.12g}", expected, int(line), COLUMN)
    repeated = np.asarray(step == 0.0)
    count = int(repeated.sum())
    note = f"{count} frame{'s' * (count > 1)} at the time of the one before left out"
    return repeated, (note,) if count else ()


def _unit(source: Source, times: Array, told: float | None) -> tuple[float, tuple[str, ...]]:
    """Seconds in one unit of the times, 0 for frame numbers, and a note where it was found."""
    if told is not None or len(times) < 2:  # noqa: PLR2004
        return (1.0 if told is None else told), ()
    step = float(np.median(np.diff(times)))
    if step < NUMBERS and np.equal(times, np.round(times)).all():
        return 0.0, ()
    rates = {name: 1.0 / (step * unit) for name, unit in TIMES.items() if unit > 0.0}
    far = {name: abs(np.log(rate / USUAL)) for name, rate in rates.items() if SLOWEST <= rate <= FASTEST}
    if not far:
        return 1.0, (f"times taken as seconds: {rates['s']:.3g} frames a second",)
    first, *others = sorted(far, key=lambda name: far[name])
    if others and far[others[0]] - far[first] < CLEAR:
        ways = " or ".join(f"{rates[name]:.3g} Hz in {name}" for name in (first, others[0]))
        raise source.error(
            f"a step of {step:.12g}, which is {ways}", "a time_unit in a layout (--layout)", None, COLUMN
        )
    note = f"times are in {first}: {rates[first]:.3g} frames a second"
    return TIMES[first], () if first == "s" else (note,)
