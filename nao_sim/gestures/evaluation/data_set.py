"""Labelled examples, read from the recordings of a manifest."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby
from pathlib import Path, PurePath

import numpy as np
from numpy.typing import NDArray

from nao_sim.errors import NaoSimError, RecordingError
from nao_sim.gestures.directions import ArmReadings, readings_of_features, readings_of_skeleton
from nao_sim.gestures.examples import Example as Shown
from nao_sim.gestures.examples import cut, example_of
from nao_sim.gestures.manifest import Manifest, Row, in_order
from nao_sim.gestures.poses import NONE
from nao_sim.gestures.streaming import PAUSE
from nao_sim.gestures.windows import FEWEST, RATE, Window, window_of
from nao_sim.motion import Skeleton
from nao_sim.recordings import Label, Recording, read
from nao_sim.recordings.angles import thesis_table
from nao_sim.recordings.archive import unpacked
from nao_sim.recordings.source import Source

Progress = Callable[[int, int], None]
SHORTEST = (FEWEST - 1) / RATE  # s, of a movement


@dataclass(frozen=True, eq=False)
class Example:
    """A stretch of somebody's motion, or a picture of it.

    Attributes:
        label: what it shows; `none` where no gesture.
        user: who made it.
        split: whether it is to learn from or to be judged by; empty where nobody said.
        readings: (T) frames of the arms.
        person: (T) the same frames; None for a posture of a table, which has no more than arms.
        place: which recording it is from, and where in it; for messages.
        line: of the manifest.
    """

    label: str
    user: str
    split: str
    readings: ArmReadings
    person: Skeleton | None
    place: str
    line: int

    @property
    def known(self) -> bool:
        """Whether it shows a gesture."""
        return self.label != NONE

    @property
    def lasts(self) -> float:
        """Seconds; 0 for a picture."""
        return self.person.duration if self.person else 0.0

    @property
    def held(self) -> bool:
        """Whether it looks like a pose, by the rule of `nao_sim.gestures.examples`; a picture always does."""
        return self.shown is None or self.shown.kind == "pose"

    @cached_property
    def pose(self) -> ArmReadings:
        """The arms while they keep still."""
        return self.readings if self.shown is None else self.shown.readings

    @property
    def moves(self) -> bool:
        """Whether it lasts long enough to be a movement."""
        return self._window is not None

    @property
    def window(self) -> Window:
        """It as a movement.

        Raises:
            ValueError: it is shorter than `SHORTEST`.
        """
        if self._window is None:
            raise ValueError(f"{self.lasts:.2f} s; expected {SHORTEST:.2f} s or more")
        return self._window

    @cached_property
    def shown(self) -> Shown | None:
        """Where in it the gesture is; None for a posture of a table, and where no arm is seen."""
        return example_of(self.person) if self.person is not None and self.readings.trust.any() else None

    @cached_property
    def _window(self) -> Window | None:
        long = self.person is not None and self.lasts > SHORTEST - 0.5 / RATE
        try:
            return window_of(self.person) if self.person is not None and long else None
        except ValueError:
            return None


@dataclass(frozen=True, eq=False)
class DataSet:
    """All examples of a manifest.

    Attributes:
        manifest: where they are from.
        examples: in an order that does not depend on the manifest's.
        skipped: recordings that could not be read, and why.
    """

    manifest: Manifest
    examples: tuple[Example, ...]
    skipped: tuple[str, ...] = ()

    @property
    def users(self) -> tuple[str, ...]:
        """Sorted."""
        return tuple(sorted({example.user for example in self.examples}))

    @property
    def labels(self) -> tuple[str, ...]:
        """Sorted, without `none`."""
        return tuple(sorted({example.label for example in self.examples if example.known}))

    def without_splits(self) -> DataSet:
        """The same, nothing of it set apart."""
        return replace(self, examples=tuple(replace(each, split="") for each in self.examples))


def read_examples(
    manifest: Manifest, rate: float | None = None, skip_unreadable: bool = False, progress: Progress | None = None
) -> DataSet:
    """Read every recording of a manifest, once each.

    Args:
        manifest: the data set.
        rate: frames a second (Hz), for files without times.
        skip_unreadable: leave out recordings that cannot be read, and say so, instead of refusing all.
        progress: called with how many recordings are read, and of how many.

    Raises:
        RecordingError: a recording cannot be read, or a row asks for what is not in it; names the line.
    """
    rows = in_order(manifest.rows)
    groups = [list(group) for _, group in groupby(rows, key=lambda row: (row.path, row.layout))]
    found, broken = list[Example](), list[RecordingError]()
    with unpacked(manifest.file_of(group[0]) for group in groups) as places:
        for number, group in enumerate(groups, start=1):
            try:
                opened = _open(manifest, group[0], places[manifest.file_of(group[0])], rate)
            except RecordingError as error:
                broken.append(error)
            else:
                found += [example for row in group for example in opened(row)]
            if progress:
                progress(number, len(groups))
    if broken and not (skip_unreadable and found):
        raise _all_of(broken)
    return DataSet(manifest, tuple(found), tuple(map(str, broken)))


def _all_of(broken: Sequence[RecordingError]) -> RecordingError:
    """One error for recordings that cannot be read: the first, and how many more there are."""
    first, others = broken[0], len(broken) - 1
    more = f" (and {others} other recording{'s' * (others > 1)})" if others else ""
    way = f"{first.expected}; --skip-unreadable leaves out what cannot be read"
    return RecordingError(first.path, f"{first.found}{more}", way, first.line, first.column)


def _open(
    manifest: Manifest, row: Row, place: Path | RecordingError, rate: float | None
) -> Callable[[Row], Iterator[Example]]:
    """What gives the examples of a row's recording."""
    try:
        if isinstance(place, RecordingError):
            raise place
        source = Source(place, rate=rate, layout=manifest.layout_of(row))
        recording = read(source)
        if recording.format == thesis_table.NAME:
            return _Table(manifest, source)
        if isinstance(recording.motion, Skeleton):
            return _Recorded(manifest, recording, recording.motion)
        raise source.error(f"a robot's joint angles ({recording.format})", "a person, or a table of postures")
    except NaoSimError as error:
        raise _blamed(manifest, row, error) from None


def _blamed(manifest: Manifest, row: Row, error: NaoSimError) -> RecordingError:
    """The error of a recording as one of the manifest's line."""
    if not isinstance(error, RecordingError):
        return manifest.error(row, f"{row.path}: {error}", "a recording that can be read", "path")
    where = f", line {error.line}" if error.line is not None else ""
    where += f", column {error.column}" if error.column is not None else ""
    return manifest.error(row, f"{row.path}{where}: {error.found}", error.expected, "path")


class _Table:
    """The postures of a table."""

    def __init__(self, manifest: Manifest, source: Source) -> None:
        self._manifest = manifest
        _, features, self._labels = thesis_table.postures(source)
        self._readings = readings_of_features(features)

    def __call__(self, row: Row) -> Iterator[Example]:
        """The examples of a row."""
        first = self._number(row, "start", row.start, 1)
        last = self._number(row, "end", row.end, len(self._readings))
        if not (row.label or self._labels):
            raise self._manifest.error(row, "no label, and the table has no column of them", "a label", "label")
        for place in range(first - 1, last):
            label = row.label or self._labels[place]
            where = f"{PurePath(row.path).name}, posture {place + 1}"
            yield Example(label, row.user, row.split, self._readings[place : place + 1], None, where, row.line)

    def _number(self, row: Row, column: str, value: float | None, otherwise: int) -> int:
        if value is None:
            return otherwise
        many = len(self._readings)
        if value != int(value) or not 1 <= value <= many:
            raise self._manifest.error(row, f"{value:g}", f"the number of a posture, 1 to {many}", column)
        return int(value)


class _Recorded:
    """The stretches of a recorded person."""

    def __init__(self, manifest: Manifest, recording: Recording, person: Skeleton) -> None:
        self._manifest, self._labels, self._person = manifest, recording.labels, person
        self._readings = readings_of_skeleton(person)
        self._since = person.times - person.times[0]
        steps = np.diff(person.times)
        self._slack = float(np.median(steps)) if len(steps) else 0.0  # times of manifests are rounded

    def __call__(self, row: Row) -> Iterator[Example]:
        """The examples of a row."""
        since = self._since
        for column, value in (("start", row.start), ("end", row.end)):
            if value is not None and not -self._slack <= value <= since[-1] + self._slack:
                lasts = f"seconds from 0 to {since[-1]:g}, which it lasts"
                raise self._manifest.error(row, f"{value:g} is outside {row.path}", lasts, column)
        for label in self._stretches(row):
            frames = np.flatnonzero((since >= label.start - 1e-9) & (since <= label.end + 1e-9))
            if not len(frames):
                said = f"no frame of {row.path} between {label.start:g} and {label.end:g} s"
                raise self._manifest.error(row, said, "a stretch with frames", "start")
            yield from self._runs(row, label.name, frames)

    def _stretches(self, row: Row) -> Sequence[Label]:
        start = 0.0 if row.start is None else row.start
        end = float(self._since[-1]) if row.end is None else row.end
        if row.label:
            return [Label(row.label, start, end)]
        found = [Label(each.name, max(each.start, start), min(each.end, end)) for each in self._labels]
        if found := [each for each in found if each.start <= each.end]:
            return found
        raise self._manifest.error(row, f"no label, and {row.path} names nothing there", "a label", "label")

    def _runs(self, row: Row, label: str, frames: NDArray[np.intp]) -> Iterator[Example]:
        """An example for each run of frames without a pause, so that pictures are one each."""
        breaks = np.flatnonzero(np.diff(self._person.times[frames]) > PAUSE) + 1
        for run in np.split(frames, breaks):
            part = slice(int(run[0]), int(run[-1]) + 1)
            person = cut(self._person, part)
            place = f"{PurePath(row.path).name} from {self._since[run[0]]:g} s"
            yield Example(label, row.user, row.split, self._readings[part], person, place, row.line)
