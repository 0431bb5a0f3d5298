"""Biovision hierarchy (BVH): a skeleton, and how its joints turn in each frame.

Every joint has an OFFSET from its parent and CHANNELS, whose values stand in
each row of MOTION in the order of the hierarchy; turns are in degrees about
the joint's own axes, the first channel's first.  The lengths have no unit.
Read here and not by a library, so that every mistake has its line and a row is
gone before the next thousands are read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Set
from dataclasses import dataclass
from itertools import chain, islice

import numpy as np

from nao_sim.recordings.angles.fixed_options import refuse_options
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.rigs.bvh_hierarchy import Hierarchy, hierarchy_of
from nao_sim.recordings.rigs.rig import Frames, Rig, check_size, numbers, rows_at_a_time, scalar, track
from nao_sim.recordings.rigs.rig_joints import FACE, FACE_NOTE, WANTED, joints_of, unit_of, with_face
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Line, Source, is_skipped
from nao_sim.robot import Array

NAME = "BVH"
LOOKS = "a first line HIERARCHY"
FRAME_TIMES = (1e-6, 60.0)  # s
_APART = 5.0  # times the largest step of the next frames
_FRAMES = re.compile(r"frames\s*:\s*(.*)", re.IGNORECASE)
_FRAME_TIME = re.compile(r"frame\s+time\s*:\s*(.*)", re.IGNORECASE)


@dataclass(frozen=True)
class Motion:
    """What stands above the rows.

    Attributes:
        frames: how many are announced.
        line: on which line.
        step: s from frame to frame.
    """

    frames: int
    line: int
    step: float


def recognise(source: Source) -> str | None:
    """Why the file is BVH, or None."""
    line = source.header()
    return "the first line is HIERARCHY" if line and line[1].split()[0].upper() == "HIERARCHY" else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file; its `person` is the name of a ROOT.
        reason: why it is taken for this format.

    Returns:
        The recording: the person's joints that the rig has.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    points, notes = points_of(source)
    return understand(source, points).recording(source, NAME, reason, len(points.values), notes)


def points_of(source: Source) -> tuple[Points, tuple[str, ...]]:
    """The joints' places in the file's unit and axes, under the names of `nao_sim.body`, and what to tell the user.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    refuse_options(source, "BVH", "deg", "has its frame time")
    if source.rig is not None:
        raise source.error("a skeleton by rig option", "none: BVH has its own")
    lines = (line for line in source.lines() if not is_skipped(line[1]))
    hierarchy, line = hierarchy_of(source, lines)
    motion = _motion(source, lines, line)
    root, notes = _person(source, hierarchy.rig)
    rig, joints = with_face(hierarchy.rig, joints_of(hierarchy.rig, root))
    rows = _Rows(source, Hierarchy(rig, hierarchy.channels), motion, rig.movers(joints.values()))
    values = track(rig, rows.chunks(lines), tuple(joints.values()))
    times = motion.step * np.arange(len(values), dtype=float)
    unit = unit_of(rig, joints)
    points = Points(values, tuple(joints), times, unit=unit, frozen_is_missing=False, time_unit=1.0)
    face = (FACE_NOTE,) if FACE[0] in joints else ()
    apart = ("the first frame is far from the second, as a rest pose that some programs put before a motion",)
    return points, (*notes, *rows.notes, *face, *(apart if _first_is_apart(values) else ()))


def _first_is_apart(values: Array) -> bool:
    """Whether the step from the first frame to the second (T, J, 3) is like no other."""
    some = values[:500] - values[:500, :1]
    steps = np.linalg.norm(np.diff(some, axis=0), axis=2).max(axis=1)
    return len(steps) > 1 and bool(steps[0] > max(_APART * steps[1:].max(), np.ptp(some[0]) / _APART**2))


def _motion(source: Source, lines: Iterator[Line], begun: int) -> Motion:
    """Read how many frames there are and how long one lasts, below the line `begun`."""
    number, count = _value(source, lines, begun, _FRAMES, "Frames: and how many")
    if not (count.isdecimal() and count.isascii() and len(count) < 16 and int(count) > 0):  # noqa: PLR2004
        raise source.error(f"'{count[:40]}' frames", "how many frames there are, at least one", number)
    line, text = _value(source, lines, number, _FRAME_TIME, "Frame Time: and seconds")
    step = scalar(source, line, "Frame Time", text)
    if not FRAME_TIMES[0] <= step <= FRAME_TIMES[1]:
        raise source.error(f"{step:g} s", f"{FRAME_TIMES[0]:g} to {FRAME_TIMES[1]:g} s a frame", line, "Frame Time")
    return Motion(int(count), number, step)


def _value(source: Source, lines: Iterator[Line], before: int, pattern: re.Pattern[str], expected: str) -> Line:
    """The number of the next line and what stands after its keyword."""
    number, text = next(lines, (before, ""))
    match = pattern.fullmatch(text.strip())
    if match is None:
        raise source.error(f"'{text.strip()[:40]}'" if text else "the end of the file", expected, number)
    return number, match[1].strip()


def _person(source: Source, rig: Rig) -> tuple[int, tuple[str, ...]]:
    """The root of the person to read, and what to tell of the others."""
    roots = [joint for joint, parent in enumerate(rig.parents) if parent < 0]
    people = [root for root in roots if {"left_shoulder", "right_shoulder"} & joints_of(rig, root).keys()]
    if not people:
        shown = ", ".join(rig.names[:8]) + ("..." if len(rig.names) > 8 else "")  # noqa: PLR2004
        raise source.error(f"joints of no known rig: {shown}", WANTED)
    names = [rig.names[root] for root in people]
    if source.person is None:
        others = ", ".join(names[1:])
        return people[0], (f"{len(people)} people: {names[0]} was read, not {others} (--person)",) if others else ()
    if source.person not in names:
        raise source.error(f"person '{source.person}'", f"a ROOT of the file: {', '.join(names)}")
    return people[names.index(source.person)], ()


class _Rows:
    """The rows of MOTION as turns and places of joints."""

    def __init__(self, source: Source, hierarchy: Hierarchy, motion: Motion, movers: Set[int]) -> None:
        self._source, self._hierarchy, self._motion = source, hierarchy, motion
        self._columns = hierarchy.columns
        self._moved = self._by_joint("position")
        self._turned = {joint: of for joint, of in self._by_joint("rotation").items() if joint in movers}
        self._added: bool | None = None  # whether positions are added to offsets; the first rows tell
        self.notes: tuple[str, ...] = ()

    def chunks(self, lines: Iterator[Line]) -> Iterator[Frames]:
        """Read the rows, some thousands at a time."""
        count, last = 0, self._motion.line
        while chunk := list(islice(lines, rows_at_a_time(len(self._columns)))):
            numbers_, texts = zip(*chunk, strict=True)
            count, last = count + len(chunk), numbers_[-1]
            yield self._frames(numbers_, numbers(self._source, numbers_, texts, self._columns))
        announced = f"{self._motion.frames} frames, as line {self._motion.line} says"
        if count < self._motion.frames:
            raise self._source.error(f"the file ends after {count} frames", announced, last)
        if count > self._motion.frames:
            self.notes += (f"{count} frames instead of {announced}: all are read",)

    def _by_joint(self, kind: str) -> dict[int, list[tuple[int, int]]]:
        """Column and axis of each channel of a kind, by joint."""
        found = dict[int, list[tuple[int, int]]]()
        for column, (joint, its_kind, axis) in enumerate(self._hierarchy.channels):
            if its_kind == kind:
                found.setdefault(joint, []).append((column, axis))
        return found

    def _frames(self, lines: tuple[int, ...], values: Array) -> Frames:
        from scipy.spatial.transform import Rotation

        places = list(chain(*self._moved.values()))
        columns = [column for column, _ in places]
        check_size(self._source, lines, values[:, columns], [self._columns[column] for column in columns])
        turns = {}
        for joint, channels in self._turned.items():
            angles = values[:, [column for column, _ in channels]]
            turns[joint] = Rotation.from_euler("".join("XYZ"[axis] for _, axis in channels), angles, degrees=True)
        return Frames(len(values), turns, self._offsets(values))

    def _offsets(self, values: Array) -> dict[int, Array]:
        """Places against the parent of the joints that have position channels."""
        rig, found = self._hierarchy.rig, {}
        for joint, channels in self._moved.items():
            found[joint] = np.tile(rig.offsets[joint], (len(values), 1))
            for column, axis in channels:
                found[joint][:, axis] = values[:, column]
        inner = [joint for joint in found if rig.parents[joint] >= 0]
        if self._added is None:
            self._added = _is_added(rig, found, inner)
            if self._added:
                self.notes += ("positions of inner joints are small and taken as added to their OFFSET",)
        if self._added:
            for joint in inner:
                axes = [axis for _, axis in self._moved[joint]]
                found[joint][:, axes] += rig.offsets[joint][axes]
        return found


def _is_added(rig: Rig, places: dict[int, Array], joints: list[int]) -> bool:
    """Whether positions of inner joints are added to their offsets; most programs write them in place of the offsets.

    What is to be added is near zero, what stands in place of the offset is near it.
    """
    if not joints:
        return False
    offsets = rig.offsets[joints][:, None]
    given = np.stack([places[joint] for joint in joints])
    return bool(np.abs(given).sum() < np.abs(given - offsets).sum())
