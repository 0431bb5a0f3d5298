"""The frames that a JSON file holds, wherever in it they are, and what else it says of them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from nao_sim.body import joint_called
from nao_sim.recordings.landmarks.detections import by_picture
from nao_sim.recordings.landmarks.json_text import Json, documents
from nao_sim.recordings.landmarks.landmark_points import shown
from nao_sim.recordings.landmarks.landmark_shapes import NAMED, Seen, Shapes
from nao_sim.recordings.landmarks.landmark_words import keys_of, part_of, take
from nao_sim.recordings.skeletons.timestamps import clock, unit_named
from nao_sim.recordings.source import Source
from nao_sim.robot import Array

WANTED = "frames of landmarks: lists of points {x, y, z} or [x, y, z], or joints by name"
_NUMBERED = re.compile(r"[A-Za-z]*[\s_.-]*(\d+(?:\.\d+)?)")
_DEEPEST = 4
_FEW = 6  # a list of more poses than that is no crowd


@dataclass
class Film:
    """What a file holds.

    Attributes:
        frames: (T,) the frames as the file has them.
        people: (T,) who is in them.
        lines: (T,) where they start, in a file of several documents; None in a file of one.
        about: what stands beside or above the frames.
    """

    frames: list[Json]
    people: list[list[Seen]]
    lines: tuple[int, ...] | None
    about: dict[str, Json] = field(default_factory=dict)


def film_of(source: Source) -> Film:
    """Find the frames of a file.

    Raises:
        RecordingError: it is no JSON, has no frames, or a frame is not as it should be.
    """
    found, about = documents(source), dict[str, Json]()
    if len(found) == 1:
        frames, lines = _frames(Shapes(source), found[0][1], about, 0), None
    else:
        while found and isinstance(found[0][1], dict) and not Shapes(source).people(found[0][1]):
            about |= found.pop(0)[1]  # a line that says something of all
        frames, lines = [frame for _, frame in found], tuple(line for line, _ in found)
    frames, firsts = by_picture(frames or [])
    lines = None if lines is None else tuple(lines[first] for first in firsts)
    people = _people(source, frames, lines)
    if not any(people):
        raise source.error(_described(found[0][1] if found else None), WANTED)
    return Film(frames, people, lines, _beside(frames, about))


def _described(node: Json) -> str:
    """What a file without frames holds instead."""
    if isinstance(node, dict):
        return f"JSON with the keys {', '.join(list(node)[:6])}" if node else "JSON with an empty table"
    if isinstance(node, list):
        return f"JSON with a list of {len(node)}" + (f" (first {shown(node[0])})" if node else "")
    return f"JSON with {shown(node)}"


def _people(source: Source, frames: Sequence[Json], lines: Sequence[int] | None) -> list[list[Seen]]:
    """Who is in each frame."""
    shapes, found = Shapes(source), []
    for number, frame in enumerate(frames):
        shapes.frame, shapes.line = number + 1, lines[number] if lines else None
        if frame is not None and not isinstance(frame, list | dict):
            raise shapes.error(shown(frame), "landmarks")
        found.append(shapes.people(frame))
    return found


def _frames(shapes: Shapes, node: Json, about: dict[str, Json], depth: int) -> list[Json] | None:
    """The frames in a node, or None where it has none."""
    if isinstance(node, list):
        return _listed(shapes, node, about, depth)
    if not isinstance(node, dict) or depth > _DEEPEST:
        return None
    frames = _columns(shapes, node) or _tracks(shapes, node) or _numbered(shapes, node) or _poses(node)
    if frames is None and any(person.parts for person in shapes.people(node)):
        return [node]
    if frames is None:
        return _within(shapes, node, about, depth)
    about |= {key: value for key, value in node.items() if keys_of([key], "times") or not _as_long(value, frames)}
    return frames


def _as_long(value: Json, frames: Sequence[Json]) -> bool:
    """Whether a value is a list of something of each frame."""
    return isinstance(value, list) and len(value) == len(frames)


def _within(shapes: Shapes, node: Mapping[str, Json], about: dict[str, Json], depth: int) -> list[Json] | None:
    """The most frames that a value of a table has; of equals those under the likelier key."""
    best: list[Json] = []
    first = keys_of(node, "frames")
    for key in [*first, *(key for key in node if key not in first)]:
        beside: dict[str, Json] = {name: value for name, value in node.items() if name != key}
        frames = _frames(shapes, node[key], beside, depth + 1) if isinstance(node[key], list | dict) else None
        if frames and len(frames) > len(best):
            best, told = frames, beside
    if best:
        about |= told
    return best or None


def _listed(shapes: Shapes, node: list[Json], about: dict[str, Json], depth: int) -> list[Json] | None:
    if shapes.set_of(node):
        return [node]
    for number, item in enumerate(node):
        shapes.frame = number + 1
        if shapes.people(item):
            shapes.frame = None
            return node
    shapes.frame = None
    return _frames(shapes, node[0], about, depth + 1) if len(node) == 1 else None


def _columns(shapes: Shapes, node: Mapping[str, Json]) -> list[Json] | None:
    """Frames of a table that has one list of frames for each part."""
    columns = {
        key: value
        for key, value in node.items()
        if part_of(key) and isinstance(value, list) and not shapes.set_of(value) and _sets(shapes, value)
    }
    return _rows(shapes, columns, "as many frames of each part") or None


def _rows(shapes: Shapes, columns: Mapping[str, list[Json]], expected: str) -> list[Json]:
    """One table a frame of one list a key."""
    lengths = {key: len(value) for key, value in columns.items()}
    if len(set(lengths.values())) > 1:
        raise shapes.error(", ".join(f"{count} {key}" for key, count in lengths.items()), expected)
    return [dict(zip(columns, frame, strict=True)) for frame in zip(*columns.values(), strict=True)]


def _sets(shapes: Shapes, values: Sequence[Json]) -> bool:
    """Whether a list holds sets of points and gaps, and nothing else."""
    there = [value for value in values if value]
    return bool(there) and all(isinstance(value, list | dict) for value in there) and bool(shapes.set_of(there[0]))


def _tracks(shapes: Shapes, node: Mapping[str, Json]) -> list[Json] | None:
    """Frames of a table that has the whole way of each joint."""
    ways = {key: value for key, value in node.items() if isinstance(value, list) and joint_called(key)}
    ways = {key: value for key, value in ways.items() if value and isinstance(value[0], list | dict)}
    if len(ways) < NAMED or shapes.set_of(node) is not None:
        return None
    frames = _rows(shapes, ways, "as many frames of each joint")
    return frames if frames and shapes.set_of(frames[0]) else None


def _numbered(shapes: Shapes, node: Mapping[str, Json]) -> list[Json] | None:
    """Frames of a table whose keys are their numbers."""
    matches = {key: match for key in node if (match := _NUMBERED.fullmatch(key))}
    if len(matches) < len(node) or not node or shapes.set_of(node) is not None:
        return None
    frames = [node[key] for key in sorted(node, key=lambda key: float(matches[key][1]))]
    return frames if any(shapes.people(frame) for frame in frames) else None


def _poses(node: Mapping[str, Json]) -> list[Json] | None:
    """Poses that are frames and not a crowd: they have times, or are many."""
    for key in keys_of(node, "frames"):
        poses = node[key]
        if key in keys_of(node, "people") and isinstance(poses, list) and all(isinstance(p, dict) for p in poses):
            timed = bool(poses) and (keys_of(poses[0], "time") or keys_of(poses[0], "frame"))
            if timed or len(poses) > _FEW:
                return poses
    return None


def _beside(frames: Sequence[Json], about: Mapping[str, Json]) -> dict[str, Json]:
    """What the file says of all frames: at the top, in tables of its own there, and in the first frame."""
    found: dict[str, Json] = {}
    for table in (*_tables(about, 0), next((frame for frame in frames if isinstance(frame, dict)), {})):
        for key, value in table.items():
            found.setdefault(key, value)
    return found


def _tables(node: Mapping[str, Json], depth: int) -> Iterator[Mapping[str, Json]]:
    yield node
    for value in node.values():
        if isinstance(value, dict) and depth < _DEEPEST:
            yield from _tables(value, depth + 1)


def rate_of(source: Source, film: Film) -> float | None:
    """Frames a second (Hz) that the file tells, or None."""
    rate = take(film.about, "rate")
    if rate is None or isinstance(rate, list | dict):
        return None
    value = Shapes(source).number(rate, "the frame rate")
    return value if math.isfinite(value) and value > 0.0 else None


def size_of(film: Film) -> tuple[float, float] | None:
    """The picture's width and height in pixels that the file tells, or None."""
    size = take(film.about, "size")
    if isinstance(size, dict):
        size = [take(size, "width"), take(size, "height")]
    if not isinstance(size, list) or len(size) < 2:  # noqa: PLR2004
        size = [take(film.about, "width"), take(film.about, "height")]
    width, height = size[:2]
    if all(isinstance(side, int | float) and not isinstance(side, bool) and 1 < side < math.inf for side in size[:2]):
        return float(width), float(height)
    return None


def times_of(source: Source, film: Film) -> tuple[Array | None, float | None]:
    """Times (T,) of the frames, and seconds in their unit; None where the file does not say."""
    times = take(film.about, "times")
    name = next(iter(keys_of(film.about, "times")), "times")
    if not isinstance(times, list) or len(times) != len(film.frames):
        tables = [frame if isinstance(frame, dict) else {} for frame in film.frames]
        name = next((key for frame in tables for key in keys_of(frame, "time")), "")
        times = [frame.get(name) for frame in tables] if name else None
    if times is not None and any(time is not None for time in times):
        return _numbers(source, film, times, name)
    return _counted(source, film)


def _numbers(source: Source, film: Film, times: Sequence[Json], name: str) -> tuple[Array, float | None]:
    shapes, found, unit = Shapes(source), [], unit_named(name)
    for number, time in enumerate(times):
        shapes.frame, shapes.line = number + 1, film.lines[number] if film.lines else None
        told = clock(time) if isinstance(time, str) else None
        found.append(shapes.number(time, name) if told is None else told)
        unit = unit if told is None else 1.0
    return np.array(found), unit


def _counted(source: Source, film: Film) -> tuple[Array | None, float | None]:
    """Times by the frames' own numbers and the file's rate: frames that were dropped are gaps."""
    rate = rate_of(source, film)
    numbers = [take(frame, "frame") if isinstance(frame, dict) else None for frame in film.frames]
    counted = np.arange(len(numbers), dtype=float)
    if all(isinstance(number, int) and not isinstance(number, bool) for number in numbers):
        told = np.array(numbers, float)
        if (np.diff(told) > 0.0).all():
            counted = told - told[0]
            if rate is None:
                return counted, 0.0
    return (None, None) if rate is None else (counted / rate, 1.0)
