"""Sets of points, frame by frame, as arrays: the body, its world landmarks, the hands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from nao_sim.body import SIDES, joint_called
from nao_sim.recordings.landmarks.landmark_shapes import Seen, Set
from nao_sim.recordings.landmarks.landmark_words import plain
from nao_sim.recordings.landmarks.landmarks import person
from nao_sim.recordings.landmarks.marks import (
    AXES,
    BODY_25,
    HAND,
    MEDIAPIPE,
    RATE,
    Marks,
    as_points,
    in_order,
    order_of,
)
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.recordings.skeletons.points import Points
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.markers import as_joints
from nao_sim.robot import Array

BODIES = ("body", "world")
HANDS = ("left", "right", "left_world", "right_world")
LARGEST = 1e7  # units of the file; no body, room or picture is larger in any unit
PIXELS = 3.0  # x and y beyond are pixels
ONLY_MEDIAPIPE = {"lefteyeinner", "mouthleft", "leftfootindex", "leftpinky"}  # names that nobody else has


@dataclass(frozen=True, eq=False)
class Part:
    """One set of points over time.

    Attributes:
        keys: (J,) names, or numbers in an order.
        values: (T, J, 3), nan where missing; the third is 0 throughout where depth is not known.
        confidence: (T, J) from 0 to 1.
        planar: whether the depth is not known.
    """

    keys: tuple[str | int, ...]
    values: Array
    confidence: Array
    planar: bool

    @property
    def numbered(self) -> bool:
        """Whether the points are known by their order only."""
        return all(isinstance(key, int) for key in self.keys)

    def in_order(self, joints: Sequence[str]) -> Marks:
        """The points as joints in that order; a number beyond is left out."""
        size = (len(self.values), len(joints))
        values, confidence = np.full((*size, 3), np.nan), np.zeros(size)
        for place, key in enumerate(self.keys):
            if isinstance(key, int) and 0 <= key < len(joints):
                values[:, key], confidence[:, key] = self.values[:, place], self.confidence[:, place]
        return in_order(joints, values, confidence)

    def by_name(self) -> Marks:
        """The points whose names are joints', by the joints' names."""
        found: dict[str, int] = {}
        for place, key in enumerate(self.keys):
            if joint := joint_called(str(key)):
                found.setdefault(joint, place)
        places = list(found.values())
        return Marks(tuple(found), self.values[:, places], self.confidence[:, places])


def parts_of(source: Source, seen: Sequence[Seen | None]) -> dict[str, Part]:
    """The sets of points of one person (T,) that are ever there, by `BODIES` and `HANDS`.

    Raises:
        RecordingError: as `part_of`.
    """
    found = {}
    for name in (*BODIES, *HANDS):
        part = part_of(source, name, [person.parts.get(name) if person else None for person in seen])
        if part is not None and np.isfinite(part.values).any():
            found[name] = part
    return found


def part_of(source: Source, name: str, frames: Sequence[Set | None]) -> Part | None:
    """Put the points of all frames in one array.

    Args:
        source: the file.
        name: what they are, for messages.
        frames: (T,) the points of each frame.

    Returns:
        The points, or None where there are none.

    Raises:
        RecordingError: points known by their order are more or fewer than before.
    """
    keys = tuple(dict.fromkeys(key for points in frames if points for key in points))
    if not keys:
        return None
    first = _first(keys, name)
    _check_counts(source, name, frames)
    column = {key: place for place, key in enumerate(keys)}
    table = np.full((len(frames), len(keys), 4), np.nan)
    for row, points in enumerate(frames):
        if points:
            table[row, [column[key] for key in points]] = list(points.values())
    return cleaned(tuple(key - first if isinstance(key, int) else key for key in keys), table)


def _first(keys: Sequence[str | int], name: str) -> int:
    """The number of the first point of an order: 1 where all from 1 on are there, else 0."""
    known = len(order_of(MEDIAPIPE)) if name in BODIES else len(HAND)
    numbers = sorted(key for key in keys if isinstance(key, int))
    whole = len(numbers) == len(keys) and numbers == list(range(1, len(numbers) + 1))
    return 1 if whole and len(numbers) in (known, *map(len, builtin())) else 0


def _check_counts(source: Source, name: str, frames: Sequence[Set | None]) -> None:
    """Refuse frames with more or fewer points than the first, where they are known by their order."""
    first: tuple[int, int] | None = None
    for number, points in enumerate(frames, start=1):
        if points and all(key == place for place, key in enumerate(points)):
            first = first or (number, len(points))
            if len(points) != first[1]:
                found = f"frame {number}, {name.replace('_', ' ')}: {len(points)} landmarks"
                raise source.error(found, f"{first[1]}, as in frame {first[0]}")


def cleaned(keys: tuple[str | int, ...], table: Array) -> Part:
    """Points (T, J, 4) with missing ones nan; a third number may be a confidence, and no depth."""
    values, confidence = table[:, :, :3], table[:, :, 3]
    third = values[:, :, 2]
    if np.isnan(confidence).all() and _is_confidence(values):
        confidence, third = third, np.zeros_like(third)
    planar = not np.nan_to_num(third).any()
    values = np.dstack([values[:, :, :2], np.zeros_like(third) if planar else third])
    there = np.isfinite(values).all(axis=2) & (np.abs(values) < LARGEST).all(axis=2) & values.any(axis=2)
    missing = ~there | (planar & (confidence == 0.0))
    values = np.where(missing[:, :, None], np.nan, values)
    return Part(keys, values, np.clip(np.where(np.isnan(confidence), 1.0, confidence), 0.0, 1.0), planar)


def _is_confidence(values: Array) -> bool:
    """Whether the third of three numbers is one: from 0 to 1 beside pixels."""
    third, across = values[:, :, 2], np.abs(values[:, :, :2])
    known = third[np.isfinite(third)]
    pixels = bool(np.nanmax(across, initial=0.0) > PIXELS)
    return pixels and len(known) > 0 and bool(known.any()) and known.min() >= 0.0 and known.max() <= 1.0


def body_of(parts: Mapping[str, Part], size: tuple[float, float] | None) -> tuple[Points, tuple[str, ...]]:
    """Body and hands as one set of points.

    Args:
        parts: by `BODIES` and `HANDS`; one of `BODIES` at least.
        size: the picture's width and height in pixels, where known.

    Returns:
        The points, without times, and what a user should know.
    """
    main = parts.get("world") or parts["body"]
    hands = any(name in parts for name in HANDS)
    order = _order(main, hands)
    if order is None and (main.numbered or not main.planar):
        return _unknown(main, hands)
    return ordered(parts, order, size)


def as_they_are(part: Part) -> Points:
    """The points by the file's own names or order, for a layout of the user's own."""
    names = None if part.numbered else tuple(map(str, part.keys))
    return Points(part.values, names, None, part.confidence, planar=part.planar, rate=RATE)


def ordered(
    parts: Mapping[str, Part], order: str | None, size: tuple[float, float] | None = None
) -> tuple[Points, tuple[str, ...]]:
    """Body and hands as one set of points, the body's in the order of a built-in layout or by name (None)."""
    main = parts.get("world") or parts["body"]
    hands = {name: _hand(name, part) for name, part in parts.items() if name in HANDS}
    marks = {name: _joints(parts[name], order) for name in BODIES if name in parts}
    seen = {side: hands[side] for side in SIDES if side in hands}
    in_metres = {side: hands[f"{side}_world"] for side in SIDES if f"{side}_world" in hands}
    found, unit, notes = person(marks.get("body"), marks.get("world"), seen, size, in_metres, main.planar)
    return as_points(found, unit=unit, planar=main.planar), notes


def _order(part: Part, hands: bool) -> str | None:
    """Whose order, or names, the points of a body have; None where that has to be found."""
    if not part.numbered:
        names = {plain(str(key)).removeprefix("poselandmark") for key in part.keys}
        return MEDIAPIPE if ONLY_MEDIAPIPE & names else None
    numbers = sorted(key for key in part.keys if isinstance(key, int))
    most = len(order_of(MEDIAPIPE))
    gaps = numbers != list(range(len(numbers)))
    if len(numbers) == most or (gaps and numbers[-1] < most):
        return MEDIAPIPE
    return BODY_25 if hands and len(numbers) == len(order_of(BODY_25)) else None


def _joints(part: Part, order: str | None) -> Marks:
    return part.in_order(order_of(order)) if order and part.numbered else part.by_name()


def _hand(name: str, part: Part) -> Marks:
    """The 21 points of a hand as joints."""
    side = name.partition("_")[0]
    return part.in_order([f"{side}_{joint}" for joint in HAND])


def _unknown(part: Part, hands: bool) -> tuple[Points, tuple[str, ...]]:
    """A body by its own names, by its markers, or in an order that has to be found."""
    notes = ("hands left out: they are seen in a picture, the body is not",) if hands else ()
    axes = AXES if part.planar else None
    if part.numbered:
        return replace(as_they_are(part), axes=axes), notes
    points = as_points(Marks(tuple(map(str, part.keys)), part.values, part.confidence), axes=axes, planar=part.planar)
    points, told = as_joints(points)
    return points, (*notes, *told)
