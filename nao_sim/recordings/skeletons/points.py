"""Points as a file has them, and how they become a skeleton.

Every reader of people ends here: it hands over the numbers in the file's own
order, unit and axes, with the names or the layout that it knows of, and the
rules of this one place find out, or check, what they mean.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from nao_sim.motion import Skeleton
from nao_sim.recordings.recording import Label, Recording
from nao_sim.recordings.skeletons.coarse_clock import finer
from nao_sim.recordings.skeletons.facing import Told
from nao_sim.recordings.skeletons.layout_file import read_layout
from nao_sim.recordings.skeletons.layouts import Layout, builtin
from nao_sim.recordings.skeletons.readings import Reading, best, by_layout, by_name, by_own, gather
from nao_sim.recordings.skeletons.timing import seconds
from nao_sim.recordings.source import Source
from nao_sim.robot import Array

SAMPLE = 240  # frames that decide
CHUNK = 8192  # frames brought to the project's axes at a time
PLANAR = "seen by one camera: depth unknown, lifted to the frontal plane"
UNSURE = "no point has a confidence above 0: confidences not used"


@dataclass(frozen=True, eq=False)
class Points:
    """One person's points.

    Attributes:
        values: (T, J, 3) in the file's unit and axes; nan where missing.
        names: (J,) what the file calls them; None for points that are known by their order only.
        times: (T,) as the file has them; None where it has none.
        confidence: (T, J) from 0 to 1, or None.
        lines: (T,) line or frame numbers, for messages; None where counting from 1 says it.
        planar: whether the third coordinate is unknown.
        unit: metres in one unit of the file, where the format says so.
        axes: the person's (forward, left, up) as signed axes of the file, e.g. ("-z", "-x", "+y"), where the format
            says so.
        rate: Hz, the usual rate of such files, where they have no times.
        frozen_is_missing: whether points at exactly (0, 0, 0) mean "not tracked".
        time_unit: seconds in one unit of `times`, 0 where they count frames; None to tell it by the frame rate.
        layout: what the points are, where the reader has found it out.
    """

    values: Array
    names: tuple[str, ...] | None = None
    times: Array | None = None
    confidence: Array | None = None
    lines: Sequence[int] | None = None
    planar: bool = False
    unit: float | None = None
    axes: tuple[str, str, str] | None = None
    rate: float | None = None
    frozen_is_missing: bool = True
    time_unit: float | None = None
    layout: Layout | None = None


@dataclass(frozen=True, eq=False)
class Understood:
    """Points made sense of.

    Attributes:
        skeleton: the person.
        reason: which layout, unit and axes, and what told so, in a few words for the user.
        notes: what a user should know besides (sides swapped, scaled, frames dropped, names not known).
    """

    skeleton: Skeleton
    reason: str
    notes: tuple[str, ...] = field(default=())

    def recording(  # what a reader knows besides
        self,
        source: Source,
        name: str,
        reason: str,
        frames: int,
        notes: tuple[str, ...] = (),
        labels: tuple[Label, ...] = (),
    ) -> Recording:
        """The file as read.

        Args:
            source: the file.
            name: the format's.
            reason: why it was taken for that format.
            frames: how many frames the file holds.
            notes: the reader's own, which come before those of the points.
            labels: the stretches that the file names.
        """
        why = f"{reason}; {self.reason}"
        return Recording(source.path, name, why, self.skeleton, frames, (*notes, *self.notes), labels)


def understand(source: Source, points: Points) -> Understood:
    """Find out which joints the points are, in what unit and axes, and bring them to the project's.

    Raises:
        RecordingError: no layout fits, or several do (they are named), or times are wrong.
    """
    if len(points.values) == 0:
        raise source.error("no frames", "at least one")
    sample = sample_of(points.values, points.frozen_is_missing)
    if not np.isfinite(sample).any():
        raise source.error("no tracked point", "a person")
    planar = points.planar or _is_flat(sample)
    reading = _reading(source, points, flattened(sample) if planar else sample, planar)
    layout = reading.layout
    unit = points.time_unit if layout is None or layout.time_unit is None else layout.time_unit
    rate = (layout.rate if layout else None) or points.rate
    told, clock_notes = (None, ()) if points.times is None else finer(source, points.times, points.values)
    times, time_notes = seconds(source, told, len(points.values), rate, unit, points.lines)
    skeleton, notes = _skeleton(source, points, reading, times, planar)
    reason = "; ".join((reading.name, *reading.fit.reasons))
    return Understood(skeleton, reason, (*reading.notes, *reading.fit.notes, *clock_notes, *time_notes, *notes))


def sample_of(values: Array, zeros_missing: bool = True) -> Array:
    """Some frames (S, J, 3) with somebody in them, spread over a recording (T, J, 3); nan where nothing is tracked."""
    tracked = np.flatnonzero(_tracked(values, zeros_missing).any(axis=1))
    if len(tracked) == 0:
        return np.full((1, values.shape[1], 3), np.nan)
    chosen = tracked[np.unique(np.linspace(0, len(tracked) - 1, SAMPLE).astype(int))]
    found = np.array(values[chosen], float)
    found[~_tracked(found, zeros_missing)] = np.nan
    return found


def flattened(values: Array) -> Array:
    """The same points (S, J, 3) without their third coordinate."""
    found = values.copy()
    found[:, :, 2] = np.where(np.isnan(found[:, :, 0]), np.nan, 0.0)
    return found


def _tracked(values: Array, zeros_missing: bool) -> NDArray[np.bool_]:
    """Which points (..., J) are there."""
    found: NDArray[np.bool_] = np.asarray(np.isfinite(values[..., :2]).all(axis=-1))
    return found & np.asarray((values != 0.0).any(axis=-1)) if zeros_missing else found


def _is_flat(sample: Array) -> bool:
    """Whether the third coordinate is the same or missing throughout."""
    depth = sample[:, :, 2][np.isfinite(sample[:, :, 0])]
    return not np.isfinite(depth).any() or bool(np.nanmax(depth) == np.nanmin(depth))


def _reading(source: Source, points: Points, sample: Array, planar: bool) -> Reading:
    """The way the points are to be taken."""
    if source.layout is not None:
        own = points.layout or read_layout(source.layout)
        told = Told(own.unit or points.unit, own.axes or points.axes, firm=True, planar=planar)
        return by_own(source, sample, points.names, own, told)
    if points.layout is not None:
        return by_layout(sample, points.layout, told_by(points.layout, points, planar))
    if points.names is not None:
        return by_name(source, sample, points.names, Told(points.unit, points.axes, planar=planar))
    number = sample.shape[1]
    known = [layout for layout in builtin() if len(layout) == number]
    readings = [by_layout(sample, layout, told_by(layout, points, planar)) for layout in known]
    return best(source, readings, [sample] * len(readings), f"{number} points a frame")


def told_by(layout: Layout, points: Points | None = None, planar: bool = False) -> Told:
    """What a built-in layout, and the format before it, say of the numbers."""
    unit, axes = (points.unit, points.axes) if points else (None, None)
    return Told(unit or layout.unit, axes or layout.axes, usual=axes is None, planar=planar)


def _skeleton(
    source: Source, points: Points, reading: Reading, times: Array, planar: bool
) -> tuple[Skeleton, tuple[str, ...]]:
    """The person, without frames that have no time, or at the ends nobody; and notes."""
    confidence = confidence_of(points, reading)
    positions = positions_of(points, reading, confidence, planar)
    timed = np.isfinite(times)
    there = np.flatnonzero(timed & np.isfinite(positions[:, :, 2]).any(axis=1))
    if len(there) == 0:
        raise source.error("no tracked joint", "a person")
    kept = timed.copy()
    kept[: there[0]] = kept[there[-1] + 1 :] = False
    empty = int(timed.sum() - kept.sum())
    if not kept.all():
        positions, times = positions[kept], times[kept]
        confidence = None if confidence is None else confidence[kept]
    positions.setflags(write=False)  # so that the skeleton need not copy it
    notes = [f"{empty} frame{'s' * (empty > 1)} at the ends without anybody left out"] * (empty > 0)
    notes += [UNSURE] * (points.confidence is not None and confidence is None) + [PLANAR] * planar
    known = np.ones(()) if confidence is None else confidence
    return Skeleton(times - times[0], positions, reading.fit.joints, known, planar), tuple(notes)


def positions_of(points: Points, reading: Reading, confidence: Array | None, planar: bool) -> Array:
    """Positions (T, K, 3) m in the project's axes, nan where missing; in pieces, as there may be many."""
    zeros_missing = points.frozen_is_missing and (reading.layout is None or reading.layout.zeros_missing)
    positions = np.empty((len(points.values), len(reading.columns), 3))
    for start in range(0, len(positions), CHUNK):
        part = slice(start, start + CHUNK)
        values = np.array(points.values[part], float)
        if planar:
            values[:, :, 2] = 0.0
        values[~_tracked(values, zeros_missing)] = np.nan
        positions[part] = reading.fit.apply(gather(reading.columns, values))
        if confidence is not None:
            positions[part][confidence[part] == 0.0] = np.nan
        if planar:
            positions[part, :, 0] = np.where(np.isnan(positions[part, :, 1]), np.nan, 0.0)
    return positions


def confidence_of(points: Points, reading: Reading) -> Array | None:
    """The joints' confidence (T, K), the least of what makes up a joint; None where nothing is to be trusted."""
    told = points.confidence
    if told is None or not (told > 0.0).any():
        return None
    return np.stack([told[:, list(columns)].min(axis=1) for columns in reading.columns.values()], axis=1)
