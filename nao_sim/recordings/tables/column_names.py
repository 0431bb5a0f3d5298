"""What the columns of a table hold, by their names: `ShoulderLeft_x`, `Left Shoulder X (mm)`, `x11`, `LSHO:X`.

A name is a point and an axis, in any order and with anything between them; a point and a word for how sure it is; or
the time, the frame, the person or the label of a row (`landmarks.toml` has the words).  Turns, speeds and the like are
left out.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from nao_sim.recordings.landmarks.landmark_words import part_of, plain, words

Kind = Literal["x", "y", "z", "trust", "state", "inferred"]
AXES: tuple[Kind, ...] = ("x", "y", "z")
TRUST: tuple[Kind, ...] = ("trust", "state", "inferred")
FEWEST = 3  # points that make a table of points
ROW = ("time", "frame", "id", "label")  # what a column may say of a row
_UNITS = {
    "m": ("m", "meter", "meters", "metre", "metres"),
    "cm": ("cm", "centimeter", "centimeters", "centimetres"),
    "mm": ("mm", "millimeter", "millimeters", "millimetres"),
    "in": ("in", "inch", "inches"),
    "px": ("px", "pixel", "pixels"),
}
_UNIT_OF = {word: unit for unit, names in _UNITS.items() for word in names}
_BRACKETS = re.compile(r"[(\[]\s*([A-Za-z0-9 ]*?)\s*[)\]]")
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_EDGES = " _.:-/|$#"


@dataclass(frozen=True)
class Named:
    """What one column's name says.

    Attributes:
        column: its place in the table.
        point: the point's name; empty in a table with one point a row.
        kind: which of its numbers.
        unit: the name of the unit that the column's name tells, or None.
    """

    column: int
    point: str
    kind: Kind
    unit: str | None = None


@dataclass(frozen=True)
class Columns:
    """What the columns of a table are.

    Attributes:
        points: for each point its columns.
        row: the columns that say something of the row, by `ROW`.
        ignored: names of the columns that are left out.
        units: the units that names tell.
        twice: names of columns that say what another one says.
    """

    points: Mapping[str, Mapping[Kind, int]]
    row: Mapping[str, int]
    ignored: tuple[str, ...]
    units: tuple[str, ...]
    twice: tuple[str, ...] = ()

    @property
    def planar(self) -> bool:
        """Whether the points have no depth."""
        return not any("z" in columns for columns in self.points.values())


def columns_of(names: Sequence[str]) -> Columns:
    """What the columns of a table are, by their names."""
    named = [found for column, name in enumerate(names) if (found := _named(column, name))]
    rest = {column: name for column, name in enumerate(names) if column not in {found.column for found in named}}
    named += _run_together(rest)
    points: dict[str, dict[Kind, int]] = {}
    spelling: dict[str, str] = {}
    twice = []
    for found in named:
        columns = points.setdefault(spelling.setdefault(found.point.lower(), found.point), {})
        if found.kind in columns:
            twice.append(names[found.column])
        columns.setdefault(found.kind, found.column)
    whole = _whole(points)
    row = _row(names, {column for columns in points.values() for column in columns.values()})
    used = {column for columns in whole.values() for column in columns.values()} | set(row.values())
    ignored = tuple(name for column, name in enumerate(names) if column not in used and name)
    units = tuple(dict.fromkeys(found.unit for found in named if found.unit and found.kind in AXES))
    return Columns(whole, row, ignored, units, tuple(twice))


def _whole(points: Mapping[str, Mapping[Kind, int]]) -> dict[str, Mapping[Kind, int]]:
    """The points that have all their coordinates: x and y, and z where most have it."""
    flat = {name: columns for name, columns in points.items() if "x" in columns and "y" in columns}
    solid = {name: columns for name, columns in flat.items() if "z" in columns}
    return solid if 2 * len(solid) >= len(flat) else flat


def _named(column: int, name: str) -> Named | None:
    """The point and the number of it that a name tells."""
    brackets = _BRACKETS.search(name)
    unit = _UNIT_OF.get(brackets[1].lower()) if brackets else None
    if unit:
        name = _BRACKETS.sub("", name, count=1)
    found = _WORD.findall(name)
    spans = [match.span() for match in _WORD.finditer(name)]
    if len(found) > 1 and found[-1].lower() in _UNIT_OF and any(word.lower() in AXES for word in found[-3:-1]):
        unit = _UNIT_OF[found[-1].lower()]
        name, found, spans = name[: spans[-1][0]], found[:-1], spans[:-1]
    for kind, start, stop in _kinds(found):
        before, after = name[: spans[start][0]], name[spans[stop - 1][1] :]
        point = _point(before, after)
        if point is not None:
            return Named(column, point, kind, unit)
    return None


def _kinds(found: Sequence[str]) -> list[tuple[Kind, int, int]]:
    """Where words may say which number of a point it is: at the end, at the start, or after `pos`."""
    count = len(found)
    places = [(count - 2, count), (count - 1, count), (0, 1), (0, 2)]
    places += [(1, 2)] if found and plain(found[0]) in words("position") else []
    kinds: list[tuple[Kind, int, int]] = []
    for start, stop in places:
        kind = _kind(plain("".join(found[start:stop]))) if start >= 0 and stop <= count else None
        if kind is not None and (kind in AXES or stop - start < count):
            kinds.append((kind, start, stop))
    return kinds


def _kind(word: str) -> Kind | None:
    for axis in AXES:
        if word == axis:
            return axis
    return next((kind for kind in TRUST if word in words(kind)), None)


def _point(before: str, after: str) -> str | None:
    """The point's name beside an axis; None beside a turn or a speed."""
    names = [_bare(before), _bare(after)]
    return None if None in names else " ".join(name for name in names if name)


def _bare(text: str) -> str | None:
    """A name without words for a position; None where it ends in a word for something else."""
    found = list(_WORD.finditer(text))
    if found and plain(found[-1][0]) in words("turn"):
        return None
    start, end = 0, len(text)
    while found and plain(found[-1][0]) in words("position"):
        end = found.pop().start()
    while found and plain(found[0][0]) in words("position"):
        start = found.pop(0).end()
    return text[start:end].strip(_EDGES)


def _run_together(rest: Mapping[int, str]) -> list[Named]:
    """Names without a mark before the axis (`lshox`, `lshoy`, `lshoz`), where all of x, y and z are there."""
    stems: dict[str, dict[Kind, int]] = {}
    for column, name in rest.items():
        axis = _kind(name[-1:].lower())
        if axis in AXES and axis is not None and len(name) > 1:
            stems.setdefault(name[:-1], {})[axis] = column
    whole = {stem: axes for stem, axes in stems.items() if len(axes) == len(AXES)}
    if len(whole) < FEWEST:
        return []
    return [Named(column, stem.strip(_EDGES), axis) for stem, axes in whole.items() for axis, column in axes.items()]


def _row(names: Sequence[str], taken: set[int]) -> dict[str, int]:
    """The columns that say something of the row."""
    found: dict[str, int] = {}
    for group in ROW:
        known = words(group)
        ranked = sorted((known[key], column) for column, name in enumerate(names)
                        if column not in taken and (key := plain(name)) in known)  # fmt: skip
        if ranked:
            found[group] = ranked[0][1]
            taken = taken | {ranked[0][1]}
    if "time" not in found:
        timed = [column for column, name in enumerate(names) if column not in taken and re.match(r"time", plain(name))]
        found |= {"time": timed[0]} if timed else {}
    return found


def parts_and_keys(points: Sequence[str]) -> dict[str, tuple[str, str | int]]:
    """For each point which part of a person it is of, and its name or number there.

    `left_hand_4` is number 4 of the left hand, `landmark_11` and `11` number 11 of the body, `nose_world` is in metres,
    and any other name is a joint's of the body.  Numbers of a body that start at 1 are counted from 0.
    """
    found = {point: _part_and_key(point) for point in points}
    numbers = [key for part, key in found.values() if part == "body" and isinstance(key, int)]
    first = 1 if numbers and min(numbers) == 1 and len(numbers) == max(numbers) else 0
    return {
        point: (part, key - first if part == "body" and isinstance(key, int) else key)
        for point, (part, key) in found.items()
    }


def _part_and_key(point: str) -> tuple[str, str | int]:
    match = re.fullmatch(r"(.*?)[\s_.:\-/\[]*(\d+)\]?", point)
    if match:
        stem = plain(match[1])
        if stem in words("point"):
            return "body", int(match[2])
        if (part := part_of(match[1])) is not None:
            return part, int(match[2])
        if "face" in stem:
            return "face", int(match[2])
    bare = re.sub(r"(^|[\s_.:-])world($|[\s_.:-])", " ", point, flags=re.IGNORECASE).strip()
    return ("world", bare) if bare != point else ("body", point)
