"""One point as JSON has it: `{"x": 1, "y": 2, "z": 3, "visibility": 1}`, `[x, y, z]` or either in a `position`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from operator import itemgetter

from nao_sim.errors import RecordingError
from nao_sim.recordings.landmarks.json_text import Json
from nao_sim.recordings.landmarks.landmark_words import keys_of, part_of, plain
from nao_sim.recordings.source import Source

Point = tuple[float, float, float, float]  # x, y, z, confidence; nan where not given
NOTHING: Point = (math.nan, math.nan, math.nan, math.nan)
_AT_MOST = 5  # numbers of a point: x, y, z, visibility, presence
_AXES = ("x", "y", "z")
_FORMS = ("{}", "camera{}", "pos{}", "position{}")  # how the keys of x, y and z are made
# Kinect's tracking states; the numbers 0, 1, 2 mean the same (Kinect for Windows SDK, enumeration TrackingState).
STATES = {"nottracked": 0.0, "inferred": 0.5, "tracked": 1.0}


class Numbers:
    """Reads the numbers of one file, whose mistakes are told with frame and landmark.

    Attributes:
        frame: the frame that is read, counted from 1; None outside of frames.
        line: the line that it starts on, where a file has one frame a line.
    """

    def __init__(self, source: Source) -> None:
        self.source = source
        self.frame: int | None = None
        self.line: int | None = None

    def error(self, found: str, expected: str) -> RecordingError:
        """The error that blames this place of the file."""
        place = f"frame {self.frame}, " if self.frame is not None else ""
        return self.source.error(place + found, expected, self.line)

    def number(self, value: Json, what: str) -> float:
        """A number; nan for null."""
        if value is None:
            return math.nan
        try:
            if isinstance(value, bool) or not isinstance(value, int | float | str):
                raise ValueError
            return float(value)
        except (ValueError, OverflowError):
            raise self.error(f"{what} is {shown(value)}", "a number or null") from None

    def point(self, node: Json, key: str | int) -> Point:
        """The point that a node is.

        Raises:
            RecordingError: it is none.
        """
        what = f"landmark {key}" if isinstance(key, int) else f"'{key}'"
        if node is None:
            return NOTHING
        if isinstance(node, list) and len(node) <= _AT_MOST:
            numbers = [self.number(value, what) for value in node[:4]]
            return (*numbers, *NOTHING)[:4]  # type: ignore[return-value]
        plan = _plan(tuple(node)) if isinstance(node, dict) else None
        if plan is None:
            raise self.error(f"{what} is {shown(node)}", "its x and y (z, visibility)")
        if plan.inside is not None:
            x, y, z, confidence = self.point(node[plan.inside], key)
        else:
            x, y, confidence = self.number(node[plan.x], what), self.number(node[plan.y], what), math.nan
            z = math.nan if plan.z is None else self.number(node[plan.z], what)
        if plan.confidence is not None:
            confidence = self.number(node[plan.confidence], f"{what}'s {plan.confidence}")
        elif plan.state is not None:
            confidence = state_confidence(node[plan.state])
        return x, y, z, confidence


@dataclass(frozen=True)
class _Plan:
    """Which keys of a table are a point's coordinates, or where its coordinates are, and what else it tells."""

    x: str = ""
    y: str = ""
    z: str | None = None
    inside: str | None = None
    confidence: str | None = None
    state: str | None = None
    names: tuple[str, ...] = ()
    numbers: tuple[str, ...] = ()
    only: bool = True  # whether no other key names a part of a person


@lru_cache(maxsize=4096)
def _plan(keys: tuple[str, ...]) -> _Plan | None:
    """How a table with these keys is a point, or None."""
    by_plain = {plain(key): key for key in reversed(keys)}
    told = _Plan(
        confidence=next(iter(keys_of(keys, "confidence")), None),
        state=next(iter(keys_of(keys, "state")), None),
        names=keys_of(keys, "name"),
        numbers=keys_of(keys, "index"),
        only=not any(part_of(key) for key in keys),
    )
    for form in _FORMS:
        x, y, z = (by_plain.get(form.format(axis)) for axis in _AXES)
        if x and y:
            return replace(told, x=x, y=y, z=z)
    inside = next(iter(keys_of(keys, "position")), None)
    return replace(told, inside=inside) if inside else None


def quick(node: Sequence[Json]) -> list[Point] | None:
    """Points in an order that are all alike and whole, in one go; None for anything that needs a closer look."""
    first = node[0]
    try:
        if type(first) is list:
            rows = [tuple(point) for point in node] if 3 <= len(first) <= 4 else []  # noqa: PLR2004
            alike = len(set(map(len, rows))) == 1
        else:
            plan = _plan(tuple(first))
            if (
                plan is None
                or not plan.x
                or plan.z is None
                or plan.state
                or plan.names
                or plan.numbers
                or not plan.only
            ):
                return None
            keys = (plan.x, plan.y, plan.z, plan.confidence) if plan.confidence else (plan.x, plan.y, plan.z)
            rows = list(map(itemgetter(*keys), node))
            alike = True
    except (TypeError, KeyError):
        return None
    if not alike or not {type(value) for row in rows for value in row} <= {float}:
        return None
    return rows if len(rows[0]) == len(NOTHING) else [(*row, math.nan) for row in rows]


def name_of(node: Json, place: int) -> str | int:
    """What a point of a list is called: its name, its number, or its place."""
    plan = _plan(tuple(node)) if isinstance(node, dict) else None
    if plan is None:
        return place
    for key in plan.names:
        if isinstance(node[key], str) and node[key]:
            return node[key]
    numbers = (node[key] for key in plan.numbers)
    return next((number for number in numbers if isinstance(number, int) and not isinstance(number, bool)), place)


def state_confidence(state: Json) -> float:
    """Confidence of a Kinect tracking state, by name or number; nan for anything else."""
    if isinstance(state, str):
        return STATES.get(plain(state), math.nan)
    if isinstance(state, int | float) and state in (0, 1, 2):
        return float(state) if isinstance(state, bool) else state / 2.0
    return math.nan


def shown(value: Json) -> str:
    """A value as a message shows it."""
    if isinstance(value, dict):
        return f"a table of {len(value)}" + (f" ({', '.join(list(value)[:3])})" if value else "")
    if isinstance(value, list):
        return f"a list of {len(value)}"
    text = repr(value) if not isinstance(value, bool) else str(value).lower()
    return text if len(text) <= 40 else text[:37] + "..."  # noqa: PLR2004


def is_point(node: Json) -> bool:
    """Whether a node looks like a point."""
    if isinstance(node, dict):
        plan = _plan(tuple(node))
        if plan is None:
            return False
        if plan.inside is not None:
            return is_point(node[plan.inside])
        return not any(isinstance(value, list | dict) and _is_part(key) for key, value in node.items())
    return isinstance(node, list) and 2 <= len(node) <= _AT_MOST and is_flat(node) and any(map(_numeric, node))  # noqa: PLR2004


@lru_cache(maxsize=4096)
def _is_part(key: str) -> bool:
    return part_of(key) is not None or plain(key) in _AXES


def _numeric(value: Json) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def is_flat(node: Sequence[Json]) -> bool:
    """Whether a list holds numbers and no further lists; the first ones tell."""
    return bool(node) and not any(isinstance(item, list | dict) for item in node[:9]) and any(map(_numeric, node[:9]))
