"""Text of numbers without names: a skeleton's joints line by line, told by a layout or by the body they make."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.skeletons.readings import gather
from nao_sim.recordings.source import Source, is_skipped
from nao_sim.recordings.tables.number_rows import Block, Frames, are_numbers, style_of
from nao_sim.recordings.tables.row_candidates import FEWEST, WIDEST_JOINT, chosen, opening
from nao_sim.recordings.tables.row_shapes import Plan
from nao_sim.robot import Array

NAME = "skeleton text"
LOOKS = "a line of numbers a frame (or a joint), x y z of each joint in a known order"
LOOKED_AT = 13  # lines


def recognise(source: Source) -> str | None:
    """Why the file is text of numbers, or None."""
    if source.layout is not None:
        return f"layout {source.layout}, as told"
    lines = [text for _, text in islice((line for line in source.lines() if not is_skipped(line[1])), LOOKED_AT)]
    rows = [style_of(text).cells(text) for text in lines]
    if not all(are_numbers(row) for row in rows) or not rows:
        return None
    widths = [len(row) for row in rows[opening(rows) :]]
    if widths[0] >= 2 * FEWEST:
        return f"{widths[0]} numbers a line without names"
    if widths[0] == 2 and widths[1:2] == [1]:  # noqa: PLR2004
        return "frames that open with the number of their lines"
    if 3 <= widths[0] <= WIDEST_JOINT and len(lines) == LOOKED_AT and len(set(widths)) == 1:  # noqa: PLR2004
        return f"{widths[0]} numbers a line without names"
    return None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's layout, rate and person.
        reason: why it is taken for this format.

    Returns:
        The recording: the person, and how the numbers were understood.

    Raises:
        RecordingError: something in the file is not as it should be, or no layout fits.
    """
    points, notes = points_of(source)
    understood = understand(source, points)
    return understood.recording(source, NAME, reason, len(understood.skeleton), notes)


def points_of(source: Source) -> tuple[Points, tuple[str, ...]]:
    """The points of the file's person, and notes."""
    found, block = chosen(source)
    who, notes = _who(source, found, block)
    frames = Frames(source, block)
    gathered = _Gathered(source, found, who)
    for lines, numbers in frames.chunks():
        gathered.add(lines, numbers)
    return gathered.points(), (*notes, *frames.notes)


def _who(source: Source, found: Plan, block: Block) -> tuple[float | None, tuple[str, ...]]:
    """Whose lines count, and a note; None where everyone's do."""
    column = next((found.aside[name] for name in ("person", "take") if name in found.aside), None)
    if column is None and source.person is not None and not block.counted:
        raise source.error(f"person '{source.person}'", "no --person: no column of the file says whose a line is")
    if column is None:
        return None, ()
    counts = Counter[float]()
    for _, numbers in Frames(source, block).chunks():
        there = np.abs(np.nan_to_num(found.points(numbers))).any(axis=(1, 2))
        counts.update(numbers[there, column].tolist())
    if not counts:
        raise source.error("no tracked point", "a person")
    ids = {f"{person:.12g}": person for person in counts}
    if source.person is not None:
        if source.person not in ids:
            raise source.error(f"no person {source.person}", f"one of {', '.join(ids)} (--person)")
        return ids[source.person], ()
    longest = max(counts, key=lambda person: counts[person])
    others = f"{len(ids)} people or takes: {longest:.12g}, the longest ({counts[longest]} frames), taken (--person)"
    return longest, (others,) * (len(ids) > 1)


class _Gathered:
    """The points of all frames, grown in place so that a long file is held once."""

    def __init__(self, source: Source, found: Plan, who: float | None) -> None:
        self._source, self._plan, self._who = source, found, who
        self._values, self._trust, self._times = bytearray(), bytearray(), bytearray()
        self._lines = array("q")
        self._clock = found.aside.get("time", found.aside.get("frame"))

    def add(self, lines: Sequence[int], numbers: Array) -> None:
        """Take some frames: line numbers (N,) and numbers (N, C)."""
        found = self._plan
        self._check_asides(lines, numbers)
        if self._who is not None:
            column = next(found.aside[name] for name in ("person", "take") if name in found.aside)
            mine = numbers[:, column] == self._who
            numbers, lines = numbers[mine], [line for line, it in zip(lines, mine, strict=True) if it]
        columns = found.layout.columns
        self._values += gather(columns, found.points(numbers)).tobytes()
        confidence = found.confidence(numbers)
        if confidence is not None:
            self._check_trust(lines, numbers, confidence)
            least = [confidence[:, points].min(axis=1) for points in columns.values()]
            self._trust += np.stack(least, axis=1).tobytes()
        if self._clock is not None:
            self._times += numbers[:, self._clock].tobytes()
        self._lines.extend(lines)

    def _check_asides(self, lines: Sequence[int], numbers: Array) -> None:
        """Refuse a frame of several lines that do not tell the same time, frame or person."""
        found = self._plan
        for name, column in found.aside.items():
            told = numbers[:, column :: numbers.shape[1] // found.lines]
            wrong = (told != told[:, :1]).any(axis=1) & np.isfinite(told[:, 0])
            if wrong.any():
                line = lines[int(wrong.argmax())]
                raise self._source.error(f"several {name}s", f"one in the {found.lines} lines of a frame", line, name)

    def _check_trust(self, lines: Sequence[int], numbers: Array, confidence: Array) -> None:
        """Refuse a state that none knows."""
        found = self._plan
        assert found.trust is not None
        told = numbers[:, found.trust]
        wrong = np.isnan(confidence) & np.isfinite(told)
        if wrong.any():
            frame, point = np.argwhere(wrong)[0]
            known = ", ".join(f"{state:g}" for state in found.states) or "a confidence from 0 to 1"
            raise self._source.error(f"{told[frame, point]:g}", known, lines[frame], f"state of point {point + 1}")

    def points(self) -> Points:
        """All of it."""
        found = self._plan
        columns = found.layout.columns
        values = np.frombuffer(self._values).reshape(-1, len(columns), 3)
        return Points(
            values,
            times=np.frombuffer(self._times) if self._clock is not None else None,
            confidence=np.frombuffer(self._trust).reshape(-1, len(columns)) if found.trust is not None else None,
            lines=self._lines,
            planar=found.planar,
            time_unit=0.0 if "time" not in found.aside else None,
            layout=replace(found.layout, joints=tuple(columns)),
        )
