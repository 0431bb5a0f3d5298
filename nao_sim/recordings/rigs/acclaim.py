"""Acclaim motion (AMC): how the bones of an ASF skeleton turn in each frame.

A frame is its number on a line and below it a line for each bone that can
turn.  The file knows neither its skeleton nor, as a rule, its rate: the
skeleton is the caller's `rig`, an ASF file of the same subject nearby
(`13_30.amc` moves `13.asf`), or a typical one; the rate is the caller's or
CMU's.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.recordings.recording import Recording
from nao_sim.recordings.rigs.acclaim_skeleton import (
    GIVE,
    ROOT,
    TYPICAL,
    AcclaimRig,
    channels,
    skeleton_of,
    skeleton_path,
)
from nao_sim.recordings.rigs.rig import Frames, check_size, row, scalar, track
from nao_sim.recordings.rigs.rig_joints import FACE, FACE_NOTE, WANTED, joints_of, with_face
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Line, Source, Unit, is_skipped
from nao_sim.robot import Array

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

NAME = "Acclaim AMC"
LOOKS = "a first line :FULLY-SPECIFIED or :DEGREES"
RATE = 120.0  # Hz, of the CMU motion capture database
SLOWEST, FASTEST = 1.0, 10_000.0  # Hz, that a file may state
CHUNK = 1024  # frames
_UNITS: dict[str, Unit] = {":degrees": "deg", ":radians": "rad"}
_HEADER = (*_UNITS, ":fully-specified", ":samples-per-second", ":asf-file", ":asf-path", ":frame-range")
_SKELETON = (":version", ":name", ":units", ":documentation", ":root", ":bonedata", ":hierarchy")
_LARGEST_NUMBER = 10**12  # of a frame
_Bone = tuple[int, str, list[str]]  # line, name, values


def recognise(source: Source) -> str | None:
    """Why the file is AMC, or an ASF skeleton that goes with one, or None."""
    line = source.header()
    word = line[1].split()[0].lower() if line else ""
    return f"the first line is {word.upper()}" if word in (*_HEADER, *_SKELETON) else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's skeleton and rate.
        reason: why it is taken for this format.

    Returns:
        The recording: the person's joints that the skeleton has.

    Raises:
        RecordingError: something in the file, or in its skeleton, is not as it should be.
    """
    points, notes = points_of(source)
    understood = understand(source if points.rate else replace(source, rate=None), points)
    return understood.recording(source, NAME, reason, len(points.values), notes)


def points_of(source: Source) -> tuple[Points, tuple[str, ...]]:
    """The joints' places in the file's unit and axes, under the names of `nao_sim.body`, and what to tell the user.

    Raises:
        RecordingError: something in the file, or in its skeleton, is not as it should be.
    """
    if source.person is not None:
        raise source.error(f"person '{source.person}'", "no choice: an AMC file holds one person")
    lines = ((number, text.strip()) for number, text in source.lines() if not is_skipped(text))
    header = _header(source, lines)
    path, told = skeleton_path(source)
    skeleton = skeleton_of(Source(path))
    rig, joints = with_face(skeleton.rig, joints_of(skeleton.rig))
    if "left_shoulder" not in joints and "right_shoulder" not in joints:
        raise Source(path).error(f"bones of no known person: {', '.join(rig.names[:8])}", WANTED)
    name = "the typical skeleton" if path == TYPICAL else path.name
    reader = _Reader(source, skeleton, header, name, rig.movers(joints.values()))
    values = track(rig, reader.chunks(lines), tuple(joints.values()))
    points = Points(
        values,
        tuple(joints),
        np.array(reader.numbers, float),
        unit=skeleton.unit,
        rate=None if header.rate else RATE,
        frozen_is_missing=False,
        time_unit=1.0 / header.rate if header.rate else 0.0,
    )
    return points, (*told, *reader.notes, *((FACE_NOTE,) if FACE[0] in joints else ()))


@dataclass
class _Header:
    """What stands above the frames."""

    unit: Unit
    rate: float | None
    first: Line  # the line with the first frame's number


def _header(source: Source, lines: Iterator[Line]) -> _Header:
    words, number = dict[str, tuple[int, str]](), 1
    for number, text in lines:
        key, _, value = text.partition(" ")
        if key.lower() in _SKELETON:
            expected = "its motion: give the .amc file, whose skeleton is found beside it or told with --rig"
            raise source.error("a skeleton (ASF) and no motion", expected, number)
        if not key.startswith(":"):
            return _Header(_unit(source, words), _told_rate(source, words), (number, text))
        words[key.lower()] = number, value
    raise source.error("a header and no frames", "at least one frame", number)


def _unit(source: Source, words: dict[str, tuple[int, str]]) -> Unit:
    said = [unit for word, unit in _UNITS.items() if word in words]
    if len(said) > 1 or (said and source.unit not in (None, said[0])):
        other = f"and unit '{source.unit}' by unit option" if len(said) == 1 else "and :RADIANS"
        raise source.error(f"{'/'.join(said)} by the file {other}", "one unit", None)
    if not said and source.unit is None:
        raise source.error("no unit", ":DEGREES or :RADIANS above the frames, or --unit deg (or rad)")
    return said[0] if said else source.unit or "deg"


def _told_rate(source: Source, words: dict[str, tuple[int, str]]) -> float | None:
    if ":samples-per-second" not in words:
        return None
    line, text = words[":samples-per-second"]
    rate = scalar(source, line, ":SAMPLES-PER-SECOND", text)
    if not SLOWEST <= rate <= FASTEST:
        raise source.error(f"{rate:g} Hz", f"{SLOWEST:g} to {FASTEST:g} Hz", line, ":SAMPLES-PER-SECOND")
    if source.rate not in (None, rate):
        raise source.error(f"{rate:g} Hz by the file but {source.rate:g} Hz by rate option", "one rate", line)
    return rate


@dataclass
class _Reader:
    """The frames as turns and places of joints."""

    source: Source
    skeleton: AcclaimRig
    header: _Header
    skeleton_name: str
    movers: Set[int]  # the joints whose turns matter
    numbers: array[int] = field(default_factory=lambda: array("q"))
    notes: tuple[str, ...] = ()
    _bones: tuple[str, ...] = ()  # in the order of the first frame

    def __post_init__(self) -> None:
        self._index = {name: joint for joint, name in enumerate(self.skeleton.rig.names)}
        self._widths = {self.skeleton.rig.names[joint]: len(dofs) for joint, dofs in self.skeleton.dofs.items()}

    def chunks(self, lines: Iterator[Line]) -> Iterator[Frames]:
        """Read the frames, some hundreds at a time."""
        waiting = list[list[_Bone]]()
        for frame in self._frames(chain([self.header.first], lines)):
            waiting.append(frame)
            if len(waiting) == CHUNK:
                yield self._turns(waiting)
                waiting = []
        if waiting:
            yield self._turns(waiting)

    def _frames(self, lines: Iterator[Line]) -> Iterator[list[_Bone]]:
        """The bones of each frame, in the order of the first frame."""
        frame, begun = list[_Bone](), 0
        for line, text in lines:
            if text.isdecimal() and text.isascii():
                if begun:
                    yield self._checked(begun, frame)
                self._count(line, text)
                frame, begun = [], line
                continue
            name, *values = text.split()
            if not begun:
                raise self.source.error(f"'{text[:40]}'", "the number of the first frame", line)
            frame.append((line, name, values))
        yield self._checked(begun, frame)

    def _count(self, line: int, text: str) -> None:
        number, before = int(text[:20]), self.numbers[-1] if self.numbers else -1
        if not before < number < _LARGEST_NUMBER:
            raise self.source.error(f"frame {text[:20]}", f"a number above {before}", line)
        self.numbers.append(number)

    def _checked(self, begun: int, frame: list[_Bone]) -> list[_Bone]:
        names = tuple(name for _, name, _ in frame)
        if not self._bones:
            self._begin(begun, frame, names)
        if names != self._bones:
            frame = self._sorted(begun, frame, names)
        for line, name, values in frame:
            if len(values) != self._widths[name]:
                dofs = channels(self.skeleton, self._index[name])
                expected = f"{len(dofs)} ({', '.join(dofs)}), as in {self.skeleton_name}; {GIVE}"
                raise self.source.error(f"{len(values)} values", expected, line, name)
        return frame

    def _begin(self, begun: int, frame: list[_Bone], names: tuple[str, ...]) -> None:
        """Take the first frame's bones for those of all frames."""
        known = {self.skeleton.rig.names[joint] for joint, dofs in self.skeleton.dofs.items() if dofs}
        for line, name, _ in frame:
            if name not in known:
                raise self.source.error(f"'{name[:40]}'", f"a bone that can turn in {self.skeleton_name}; {GIVE}", line)
        if ROOT not in names:
            raise self.source.error("a frame without root", "root and its place and turn", begun)
        self._bones = names
        if still := sorted(known - set(names)):
            self.notes += (f"not in the file, and not turned: {', '.join(still)}",)

    def _sorted(self, begun: int, frame: list[_Bone], names: tuple[str, ...]) -> list[_Bone]:
        by_name = {name: bone for bone in frame for name in [bone[1]]}
        if missing := [name for name in self._bones if name not in by_name]:
            line = frame[-1][0] if frame else begun
            raise self.source.error(f"a frame without {missing[0]}", f"{len(self._bones)} bones, as before", line)
        for place, (line, name, _) in enumerate(frame):
            if name not in self._bones or name in names[:place]:
                raise self.source.error(f"'{name[:40]}'", "the bones of the first frame, each once", line)
        return [by_name[name] for name in self._bones]

    def _turns(self, frames: Sequence[list[_Bone]]) -> Frames:
        values, turns, places, start = self._values(frames), dict[int, "Rotation"](), dict[int, Array](), 0
        for bone, name in enumerate(self._bones):
            joint, width = self._index[name], self._widths[name]
            mine, start = values[:, start : start + width], start + width
            if joint == 0:
                places[joint] = self._places(mine, [frame[bone][0] for frame in frames])
                turns[joint] = self._turn(joint, mine) * self.skeleton.frames[joint]
            elif joint in self.movers:
                frame = self.skeleton.frames[joint]
                turns[joint] = frame * self._turn(joint, mine) * frame.inv()
        return Frames(len(frames), turns, places)

    def _turn(self, joint: int, values: Array) -> Rotation:
        """The turns (T,) that a bone's values (T, W) tell."""
        from scipy.spatial.transform import Rotation

        turned = [(column, "xyz"[axis]) for column, (kind, axis) in enumerate(self.skeleton.dofs[joint]) if kind == "r"]
        if not turned:
            return Rotation.identity(len(values))
        angles = values[:, [column for column, _ in turned]]
        return Rotation.from_euler("".join(axis for _, axis in turned), angles, degrees=self.header.unit == "deg")

    def _places(self, values: Array, lines: Sequence[int]) -> Array:
        """Where the root is (T, 3)."""
        found = np.zeros((len(values), 3))
        for column, (kind, axis) in enumerate(self.skeleton.dofs[0]):
            if kind == "t":
                check_size(self.source, lines, values[:, [column]], [channels(self.skeleton, 0)[column]])
                found[:, axis] = values[:, column]
        return found

    def _values(self, frames: Sequence[list[_Bone]]) -> Array:
        """All values (T, C): fast where all is well, exact where it is not."""
        texts = [" ".join(chain.from_iterable(values for _, _, values in frame)) for frame in frames]
        try:
            values = np.loadtxt(texts, comments=None, ndmin=2)
            if len(values) == len(frames) and np.isfinite(values).all():
                return values
        except ValueError:
            pass
        return np.array([list(chain.from_iterable(self._exact(bone) for bone in frame)) for frame in frames])

    def _exact(self, bone: _Bone) -> list[float]:
        line, name, values = bone
        return row(self.source, line, values, channels(self.skeleton, self._index[name]))
