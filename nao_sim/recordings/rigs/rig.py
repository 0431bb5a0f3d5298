"""A tree of bones and where its joints are when they turn.

Motion-capture files hold no positions but turns: a skeleton once, and for each
frame how far every joint turns its bone (and all that hangs on it).  Forward
kinematics of a chunk of frames at a time makes positions of them, so that a
long file is never held as text or as turns of every bone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from nao_sim.recordings.source import Source
from nao_sim.recordings.table import number
from nao_sim.robot import Array, read_only

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

LARGEST = 1e7  # units of the file; no body and no room is larger in any unit
_VALUES = 2_000_000  # numbers held at a time, 16 MB


@dataclass(frozen=True, eq=False)
class Rig:
    """A tree of joints in its rest pose, in which nothing is turned.

    Attributes:
        names: (J,) what the file calls the joints.
        parents: (J,) where each joint's parent is, before it; -1 for a root.
        offsets: (J, 3) from the parent to the joint, in the file's unit.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "offsets", read_only(np.reshape(self.offsets, (-1, 3))))
        if not len(self.names) == len(self.parents) == len(self.offsets):
            raise ValueError("names, parents and offsets differ in length")
        if any(not -1 <= parent < joint for joint, parent in enumerate(self.parents)):
            raise ValueError("a joint stands before its parent")

    @cached_property
    def rest(self) -> Array:
        """Where the joints are (J, 3) when nothing is turned."""
        places = np.array(self.offsets)
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                places[joint] += places[parent]
        return read_only(places)

    def path(self, joint: int) -> list[int]:
        """The joint, its parent and so on to the root."""
        way = []
        while joint >= 0:
            way.append(joint)
            joint = self.parents[joint]
        return way

    def movers(self, joints: Iterable[int]) -> frozenset[int]:
        """The joints whose turning moves one of `joints`."""
        return frozenset(mover for joint in joints for mover in self.path(joint)[1:])

    def with_joint(self, name: str, parent: int, place: Array) -> Rig:
        """The rig with one more joint, at `place` (3,) in the rest pose."""
        offset = place - self.rest[parent]
        return Rig((*self.names, name), (*self.parents, parent), np.vstack([self.offsets, offset]))


@dataclass(frozen=True, eq=False)
class Frames:
    """How some frames turn and shift the joints of a rig.

    Attributes:
        count: how many frames, T.
        turns: by joint, the turn against its parent, one a frame; a joint that is not named does not turn.
        offsets: by joint, (T, 3) in place of the offset from its parent.
    """

    count: int
    turns: Mapping[int, Rotation] = field(default_factory=dict)
    offsets: Mapping[int, Array] = field(default_factory=dict)


def positions(rig: Rig, frames: Frames, joints: Sequence[int]) -> Array:
    """Forward kinematics: p_j = p_parent + R_parent o_j with R_j = R_parent r_j.

    Args:
        rig: the tree.
        frames: the turns r_j, and offsets o_j where they are not the rig's.
        joints: which joints to place, W of them.

    Returns:
        (T, W, 3) in the file's unit and axes.
    """
    places, turned = {-1: np.zeros((frames.count, 3))}, dict[int, "Rotation | None"]()
    for joint in sorted({bone for wanted in joints for bone in rig.path(wanted)}):
        parent = rig.parents[joint]
        offset = np.array(frames.offsets.get(joint, rig.offsets[joint]))  # a copy: SciPy takes no read-only array
        frame, own = turned.get(parent), frames.turns.get(joint)
        places[joint] = places[parent] + (offset if frame is None else frame.apply(offset))
        turned[joint] = frame if own is None else own if frame is None else frame * own
    return np.stack([places[joint] for joint in joints], axis=1) if joints else np.empty((frames.count, 0, 3))


def track(rig: Rig, chunks: Iterable[Frames], joints: Sequence[int]) -> Array:
    """The positions (T, W, 3) of `joints` in all frames of all chunks."""
    grown = bytearray()  # in place: a long recording is held once
    for frames in chunks:
        grown += positions(rig, frames, joints).tobytes()
    return np.frombuffer(grown).reshape(-1, len(joints), 3)


def rows_at_a_time(columns: int) -> int:
    """How many rows of `columns` numbers make a chunk."""
    return min(max(_VALUES // max(columns, 1), 1), 8192)


def numbers(source: Source, lines: Sequence[int], texts: Sequence[str], columns: Sequence[str]) -> Array:
    """Rows of numbers with spaces between them: fast where all is well, exact where it is not.

    Args:
        source: the file.
        lines: (N,) line numbers of the rows.
        texts: (N,) the rows.
        columns: (C,) what the numbers of a row are, for messages.

    Returns:
        (N, C), all finite.

    Raises:
        RecordingError: a row is too short or too long, or a value is no finite number.
    """
    try:
        values = np.loadtxt(texts, comments=None, ndmin=2)
        if values.shape == (len(lines), len(columns)) and np.isfinite(values).all():
            return values
    except ValueError:
        pass
    rows = [row(source, line, text.split(), columns) for line, text in zip(lines, texts, strict=True)]
    return np.array(rows).reshape(-1, len(columns))


def row(source: Source, line: int, cells: Sequence[str], columns: Sequence[str]) -> list[float]:
    """One row of finite numbers.

    Raises:
        RecordingError: too few or too many, or one is no finite number.
    """
    if len(cells) != len(columns):
        values = f"{len(cells)} value{'s' if len(cells) != 1 else ''}"
        raise source.error(values, f"{len(columns)}, one for each channel of the skeleton", line)
    found = []
    for column, cell in zip(columns, cells, strict=True):
        value = number(source, line, column, cell)
        if not np.isfinite(value):
            raise source.error(f"'{cell}'", "a finite number", line, column)
        found.append(value)
    return found


def scalar(source: Source, line: int, name: str, text: str) -> float:
    """One finite number.

    Raises:
        RecordingError: it is not.
    """
    if len(text.split()) != 1:
        raise source.error(f"'{text[:40]}'" if text else "nothing", "a number", line, name)
    return row(source, line, text.split(), [name])[0]


def vector(source: Source, line: int, name: str, cells: Sequence[str]) -> Array:
    """Three finite numbers (3,) of a sensible size.

    Raises:
        RecordingError: they are not.
    """
    columns = [f"{name} {axis}" for axis in "xyz"]
    if len(cells) != len(columns):
        raise source.error(f"{len(cells)} value{'s' if len(cells) != 1 else ''}", "three numbers, x y z", line, name)
    values = np.array(row(source, line, cells, columns))
    check_size(source, [line], values[None], columns)
    return values


def check_size(source: Source, lines: Sequence[int], values: Array, columns: Sequence[str]) -> None:
    """Refuse places (N, C) that no recording can hold.

    Raises:
        RecordingError: a value is beyond `LARGEST`.
    """
    wrong = np.abs(values) > LARGEST
    if wrong.any():
        at, column = divmod(int(wrong.argmax()), len(columns))
        raise source.error(f"{values[at, column]:g}", f"a length below {LARGEST:g}", lines[at], columns[column])
