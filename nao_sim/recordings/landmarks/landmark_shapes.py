"""The shapes in which JSON holds landmarks: a set of points, and the people of a frame.

A set is a list of points in an order, a list or table of points with names, a table of points by number, one flat list
of numbers, or lists of all x, all y and all z; a person is a set, or a table of sets (`landmarks.toml` has the names).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from nao_sim.body import joint_called
from nao_sim.recordings.landmarks.json_text import Json
from nao_sim.recordings.landmarks.landmark_points import Numbers, Point, is_flat, is_point, name_of, quick
from nao_sim.recordings.landmarks.landmark_words import keys_of, part_of, plain, take, words

Set = dict[str | int, Point]  # by name, or by number in an order
FEWEST = 4  # points that make a set
NAMED = 3  # known joints that make a table of points
_COUNTS = (33, 25, 21, 20, 19, 18, 17, 15, 32, 26)  # points of known layouts, for flat lists of numbers
_HOLISTIC = 1662  # numbers: 33 x 4 body, 468 x 3 face, 21 x 3 left hand, 21 x 3 right hand
_DEEPEST = 6


@dataclass
class Seen:
    """One person in one frame.

    Attributes:
        parts: points by what they are: body, world, left, right, left_world, right_world.
        id: the file's own id of the person.
    """

    parts: dict[str, Set] = field(default_factory=dict)
    id: str | None = None


@lru_cache(maxsize=4096)
def _joint(name: str) -> str | None:
    return joint_called(name)


class Shapes(Numbers):
    """Reads the shapes of one file."""

    def people(self, node: Json, depth: int = 0) -> list[Seen]:
        """Everybody in a frame, or in a part of one.

        Raises:
            RecordingError: something in a set of points is no number.
        """
        if not isinstance(node, list | dict) or not node or depth > _DEEPEST:
            return []
        if isinstance(node, list) and len(node) == _HOLISTIC and is_flat(node):
            return [self._holistic(node)]
        if (points := self.set_of(node)) is not None:
            return [Seen({"body": points})] if points else []
        if isinstance(node, list):
            return [person for item in node for person in self.people(item, depth + 1)]
        return self._crowd(node, depth) or self._persons(node, depth)

    def set_of(self, node: Json) -> Set | None:
        """The points of a set; empty where all are missing, None where it is no set."""
        if isinstance(node, list):
            return self._listed(node)
        if not isinstance(node, dict):
            return None
        columns = self._columns(node)
        if columns is not None or (columns := self._table_of_points(node)) is not None:
            return columns
        if len(node) == 1 and part_of(key := next(iter(node))) == "body":
            return self.set_of(node[key])
        return None

    def _crowd(self, node: Mapping[str, Json], depth: int) -> list[Seen]:
        """The people of a table that lists them."""
        for key in keys_of(node, "people"):
            crowd = node[key]
            listed = [(None, item) for item in crowd] if isinstance(crowd, list) else []
            members = crowd.items() if isinstance(crowd, dict) else listed
            found = []
            for name, member in members:
                for person in self.people(member, depth + 1):
                    own = take(member, "id") if isinstance(member, dict) else None
                    person.id = person.id or identity(own) or name
                    found.append(person)
            if found:
                return found
        return []

    def _persons(self, node: Mapping[str, Json], depth: int) -> list[Seen]:
        """The person, or people, of a table of sets."""
        found: list[Seen] = []
        for key, value in node.items():
            part = part_of(key)
            if part is not None:
                _merge(found, part, self.people(value, depth + 1))
            elif plain(key) in words("hands") and isinstance(value, dict):
                _merge(found, "body", self._persons(value, depth + 1))
        return [person for person in found if person.parts]

    def _listed(self, node: Sequence[Json]) -> Set | None:
        if len(node) >= FEWEST and (points := quick(node)) is not None:
            return dict(enumerate(points))
        there = [item for item in node if item is not None]
        if len(node) >= FEWEST and not there:
            return {}
        if is_flat(node):
            return self._unflattened(node)
        if len(node) < FEWEST or 2 * sum(map(is_point, there)) < len(there) or not any(map(is_point, there)):
            return None
        found: Set = {}
        for place, item in enumerate(node):
            key = name_of(item, place)
            if key in found:
                raise self.error(f"landmark '{key}' twice", "each landmark once")
            found[key] = self.point(item, key)
        return found

    def _table_of_points(self, node: Mapping[str, Json]) -> Set | None:
        """Points by name or number, among other things."""
        there = {key: value for key, value in node.items() if is_point(value)}
        numbered = [key for key in there if key.isdecimal() and key.isascii()]
        if len(numbered) >= FEWEST:
            return {int(key): self.point(node[key], key) for key in node if key.isdecimal() and key.isascii()}
        if sum(_joint(key) is not None for key in there) < NAMED:
            return None
        wanted = [key for key in node if key in there or _joint(key) is not None]
        return {key: self.point(node[key], key) for key in wanted}

    def _columns(self, node: Mapping[str, Json]) -> Set | None:
        """All x, all y (and all z) of a set, each in a list."""
        axes = {plain(key): value for key, value in node.items() if plain(key) in "xyz"}
        if not all(isinstance(axes.get(axis), list) and is_flat(axes[axis]) for axis in "xy"):
            return None
        lengths = {axis: len(values) for axis, values in axes.items() if isinstance(values, list)}
        if len(set(lengths.values())) > 1:
            told = ", ".join(f"{count} {axis}" for axis, count in lengths.items())
            raise self.error(told, "as many of each")
        depths = axes.get("z") or [None] * len(axes["x"])
        rows = zip(axes["x"], axes["y"], depths, strict=True)
        return {place: self.point(list(row), place) for place, row in enumerate(rows)}

    def _unflattened(self, node: Sequence[Json]) -> Set | None:
        """One list of numbers: as many of each point as make a known count of points."""
        for width in (3, 4, 2):
            count, rest = divmod(len(node), width)
            if rest == 0 and count in _COUNTS:
                return {place: self.point(node[place * width : (place + 1) * width], place) for place in range(count)}
        return None

    def _holistic(self, node: Sequence[Json]) -> Seen:
        """Body, face and hands of MediaPipe Holistic in one list of numbers; zeros where nothing was seen."""
        body, hands = node[: 33 * 4], node[33 * 4 + 468 * 3 :]
        found = Seen()
        for part, numbers in (("body", body), ("left", hands[: 21 * 3]), ("right", hands[21 * 3 :])):
            points = self._unflattened(numbers)
            if points and any(value != 0 for value in numbers):
                found.parts[part] = points
        return found


def identity(value: Json) -> str | None:
    """An id; none for what trackers write where they have none (-1, [-1], "")."""
    if isinstance(value, list):
        value = value[0] if len(value) == 1 else None
    if isinstance(value, bool) or not isinstance(value, int | float | str) or value in (-1, ""):
        return None
    return str(value)


def _merge(found: list[Seen], part: str, people: Sequence[Seen]) -> None:
    """Put a part of people beside their other parts, in the file's order."""
    while len(found) < len(people):
        found.append(Seen())
    for person, other in zip(found, people, strict=False):
        person.id = person.id or other.id
        for inner, points in other.parts.items():
            person.parts.setdefault(part if inner == "body" else _deeper(part, inner), points)


def _deeper(part: str, inner: str) -> str:
    """What the world landmarks under `left_hand` are."""
    return f"{part}_world" if inner == "world" and part in ("left", "right") else inner
