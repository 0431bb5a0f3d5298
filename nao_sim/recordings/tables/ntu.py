"""NTU RGB+D `.skeleton` files: Kinect v2 skeletons of one or several people, frame by frame.

A line counts the frames.  Each frame has a line that counts its bodies; each
body a line of ten values, its id first, a line that counts its joints, and a
line a joint: x y z (m, camera space), depth and colour image x y, orientation
w x y z, and the tracking state (Shahroudy et al., NTU RGB+D, CVPR 2016).
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.layouts import Layout, builtin
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Line, Source, is_skipped
from nao_sim.recordings.table import Header, numbers

NAME = "NTU RGB+D skeleton"
LOOKS = "a frame count, then per frame a body count and 25 lines of 12 numbers a body (NTU RGB+D .skeleton)"
LAYOUT = "Kinect v2"
BODY, JOINT = 10, 12  # values of a body's line and of a joint's
STATE = 11  # the column of the tracking state
_COLUMNS = ("x", "y", "z", "depth x", "depth y", "colour x", "colour y", "w", "qx", "qy", "qz", "tracking state")


def recognise(source: Source) -> str | None:
    """Why the file is an NTU RGB+D skeleton, or None."""
    lines = [text.split() for _, text in islice((line for line in source.lines() if not is_skipped(line[1])), 2000)]
    if len(lines) < 2 or not (_is_count(lines[0]) and _is_count(lines[1])):  # noqa: PLR2004
        return None
    body = next((place for place, cells in enumerate(lines[2:], start=2) if not _is_count(cells)), None)
    if body is None or len(lines[body]) != BODY or not _is_count(lines[body + 1] if body + 1 < len(lines) else []):
        return None
    return f"a line of {BODY} values a body, as in NTU RGB+D"


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: the person asked for, or the one tracked in most frames.

    Raises:
        RecordingError: something in the file is not as it should be.
    """
    points, notes = points_of(source)
    understood = understand(source, points)
    return understood.recording(source, NAME, reason, len(understood.skeleton), notes)


def points_of(source: Source) -> tuple[Points, tuple[str, ...]]:
    """The points of the file's person, missing where the person is not in the frame, and notes."""
    layout = _layout()
    people = dict[str, _Person]()
    frame, notes = -1, list[str]()
    for frame, (line, bodies) in enumerate(_frames(source, len(layout), notes)):
        for body, joints in bodies:
            people.setdefault(body, _Person()).add(source, frame, line, joints)
    who, said = _who(source, people)
    values = np.full((frame + 1, len(layout), 3), np.nan)
    confidence = np.zeros((frame + 1, len(layout)))
    frames = np.asarray(people[who].frames)
    told = np.frombuffer(people[who].values).reshape(-1, len(layout), 4)
    values[frames], confidence[frames] = told[:, :, :3], told[:, :, 3]
    return Points(values, confidence=confidence, layout=layout), (*notes, *said)


@dataclass(eq=False)
class _Person:
    """One body's joints as they come: frames, and x y z confidence of each joint."""

    frames: array[int] = field(default_factory=lambda: array("q"))
    values: bytearray = field(default_factory=bytearray)

    def add(self, source: Source, frame: int, line: int, joints: list[Line]) -> None:
        header = Header(0, None, _COLUMNS)
        told = numbers(source, header, [number for number, _ in joints], [text for _, text in joints])
        states = _layout().states
        confidence = np.array([states.get(state, np.nan) for state in told[:, STATE].tolist()])
        if np.isnan(confidence).any():
            where = int(np.isnan(confidence).argmax())
            expected = ", ".join(f"{state:g}" for state in states)
            raise source.error(f"{told[where, STATE]:g}", expected, joints[where][0], "tracking state")
        if self.frames and self.frames[-1] == frame:
            raise source.error("a body twice in one frame", "each body once", line)
        self.frames.append(frame)
        self.values += np.column_stack([told[:, :3], confidence]).tobytes()


Bodies = list[tuple[str, list[Line]]]  # ids and joint lines


def _frames(source: Source, joints: int, notes: list[str]) -> Iterator[tuple[int, Bodies]]:
    """Each frame's line number and bodies; a last frame that breaks off is left out, and said so."""
    lines = (line for line in source.lines() if line[1].strip())
    promised = _count(source, next(lines, (1, "")), "frames")
    for number in range(promised):
        opening = next(lines, None)
        bodies = None if opening is None else _bodies(source, opening, lines, joints)
        if opening is None or bodies is None:
            if number == 0:
                raise source.error("no whole frame", f"{promised}, as the first line says", 1)
            notes.append(f"breaks off after {number} of {promised} frames")
            return
        yield opening[0], bodies
    extra = next(lines, None)
    if extra is not None:
        raise source.error(f"more than the {promised} frames of the first line", "the end of the file", extra[0])


def _bodies(source: Source, opening: Line, lines: Iterator[Line], joints: int) -> Bodies | None:
    """The bodies of a frame; None where the file ends before them."""
    found = []
    for _ in range(_count(source, opening, "bodies")):
        body, count = next(lines, None), next(lines, None)
        if body is None or count is None:
            return None
        if len(body[1].split()) != BODY:
            raise source.error(f"{len(body[1].split())} values", f"the {BODY} of a body", body[0])
        if _count(source, count, "joints") != joints:
            raise source.error(f"{count[1].strip()} joints", str(joints), count[0])
        rows = list(islice(lines, joints))
        if len(rows) < joints or len(rows[-1][1].split()) < JOINT:
            return None
        found.append((body[1].split()[0], rows))
    return found


def _count(source: Source, line: Line, what: str) -> int:
    if not _is_count(line[1].split()):
        raise source.error(f"'{line[1].strip()[:40]}'", f"the number of {what}", line[0])
    return int(line[1])


def _is_count(cells: list[str]) -> bool:
    return len(cells) == 1 and cells[0].isascii() and cells[0].isdecimal()


def _who(source: Source, people: dict[str, _Person]) -> tuple[str, tuple[str, ...]]:
    """The id of the person to take, and a note where there are others."""
    if not people:
        raise source.error("no bodies in any frame", "a person")
    if source.person is not None:
        if source.person not in people:
            raise source.error(f"no person {source.person}", f"one of {', '.join(people)} (--person)")
        return source.person, ()
    longest = max(people, key=lambda body: len(people[body].frames))
    note = f"{len(people)} people: {longest}, tracked longest ({len(people[longest].frames)} frames), taken (--person)"
    return longest, (note,) * (len(people) > 1)


def _layout() -> Layout:
    return next(layout for layout in builtin() if layout.name == LAYOUT)
