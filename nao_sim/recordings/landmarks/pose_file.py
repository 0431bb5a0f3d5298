"""`.pose` files of the pose-format library: binary, with the points' names in a header.

The header says the version, the picture's size, and for each component its name, point names and format (`XYC`,
`XYZC`); the body the rate and, since v0.1, an array of coordinates (T, people, points, dimensions) and one of
confidences.  v0.0 has each frame on its own with the people in it, v0.1 counts the frames in 16 bits, which is not
always enough, so that the file's length tells (sign-language-processing/pose, docs/specs).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from nao_sim.body import joint_called
from nao_sim.recordings.landmarks.landmark_parts import BODIES, HANDS, Part, ordered
from nao_sim.recordings.landmarks.landmark_shapes import NAMED
from nao_sim.recordings.landmarks.landmark_words import part_of
from nao_sim.recordings.landmarks.people import choose
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.points import Points, understand
from nao_sim.recordings.source import Source
from nao_sim.robot import Array

NAME = ".pose file"
LOOKS = "a .pose file of pose-format v0.0, v0.1 or v0.2"
KIND = "binary"
VERSIONS = (0.0, 0.1, 0.2)
LARGEST = 1 << 31  # bytes
_START = struct.Struct("<f4HH")  # version, width, height, depth, components, length of the first one's name
_DAMAGED = (struct.error, ValueError, IndexError, TypeError, OverflowError, MemoryError)  # UnicodeError is a ValueError


@dataclass(frozen=True, eq=False)
class _Body:
    """What a file holds of everybody.

    Attributes:
        values: (T, P, N, D) coordinates.
        confidence: (T, P, N), 0 for points that are not there.
        rate: Hz.
        ids: (P,) who they are.
    """

    values: Array
    confidence: Array
    rate: float
    ids: tuple[str, ...]


@dataclass(frozen=True)
class _Header:
    """What a file says before its frames.

    Attributes:
        version: 0.0, 0.1 or 0.2.
        size: the picture's width and height in pixels; None where a file has none.
        components: the names of the points of each component.
        dimensions: how many coordinates each point of a component has.
        end: where the frames start.
    """

    version: float
    size: tuple[float, float] | None
    components: Mapping[str, tuple[str, ...]]
    dimensions: tuple[int, ...]
    end: int

    @property
    def points(self) -> int:
        """How many points a person has."""
        return sum(len(points) for points in self.components.values())


def recognise(source: Source) -> str | None:
    """Why the file is a .pose file, or None."""
    if len(source.start) < _START.size:
        return None
    version, _, _, _, components, length = _START.unpack_from(source.start)
    name = source.start[_START.size : _START.size + length]
    known = any(abs(version - known) < 1e-6 for known in VERSIONS)  # noqa: PLR2004
    if not known or not 0 < components < 100 or not 0 < length < 100 or len(name) < length:  # noqa: PLR2004
        return None
    readable = name.isascii() and name.decode("ascii").isprintable()
    return f"version {version:.1f}, component {name.decode('ascii')}" if readable else None


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file, with the caller's person.
        reason: why it is taken for this format.

    Returns:
        The recording: one person, planar where the file has no depth.

    Raises:
        RecordingError: the file is damaged, or holds nobody's body.
    """
    points, notes = points_of(source)
    return understand(source, points).recording(source, NAME, reason, len(points.values), notes)


def points_of(source: Source) -> tuple[Points, tuple[str, ...]]:
    """The points of one person, and what a user should know.

    Raises:
        RecordingError: as `read`.
    """
    with source.open() as stream:
        content = stream.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise source.error(f"more than {LARGEST >> 20} MB", "a smaller .pose file")
    header = _header(source, content)
    body = (
        _frames_apart(source, header, content) if header.version == 0.0 else _frames_together(source, header, content)
    )
    tracked = {name: int((body.confidence[:, person] > 0.0).any(axis=1).sum()) for person, name in enumerate(body.ids)}
    if not any(tracked.values()):
        raise source.error("nobody in any frame", "a person")
    chosen, notes = choose(source, {name: frames for name, frames in tracked.items() if frames})
    parts = _parts(source, header, body, body.ids.index(chosen))
    points, told = ordered(parts, None, header.size)
    if np.isfinite(body.rate) and body.rate > 0.0:
        points = replace(points, times=np.arange(len(body.values)) / body.rate, time_unit=1.0)
    return points, (*notes, *told)


def _header(source: Source, content: bytes) -> _Header:
    from pose_format.pose_header import PoseHeader  # type: ignore[import-untyped]
    from pose_format.utils.reader import BufferReader  # type: ignore[import-untyped]

    reader = BufferReader(content)
    try:
        header = PoseHeader.read(reader)
        components = {str(component.name): tuple(component.points) for component in header.components}
        dimensions = tuple(len(component.format) - 1 for component in header.components)
    except _DAMAGED:
        raise source.error("a damaged header", LOOKS) from None
    if any(not 2 <= count <= 3 for count in dimensions) or not any(components.values()):  # noqa: PLR2004
        raise source.error("points that are not of format XYC or XYZC", LOOKS)
    width, height = header.dimensions.width, header.dimensions.height
    size = (float(width), float(height)) if width > 0 and height > 0 else None
    return _Header(round(header.version, 1), size, components, dimensions, reader.read_offset)


def _frames_together(source: Source, header: _Header, content: bytes) -> _Body:
    """The body since v0.1: all coordinates, then all confidences."""
    start = struct.Struct("<fIH" if header.version > 0.1 else "<HHH")  # noqa: PLR2004
    if len(content) < header.end + start.size:
        raise source.error("a file that ends before its frames", "a whole .pose file")
    rate, frames, people = start.unpack_from(content, header.end)
    size, width = len(content) - header.end - start.size, max(header.dimensions)
    each = people * header.points * (width + 1) * 4
    there = size // each if each else 0
    exact = frames == there if header.version > 0.1 else frames == there % 65536  # noqa: PLR2004
    if not there or size % each or not exact:
        found = f"{there} whole frames where the header says {frames}" if each else "no people"
        raise source.error(f"a damaged file ({found})", "a whole .pose file")
    numbers = np.frombuffer(content, "<f4", offset=header.end + start.size)
    values, confidence = np.split(numbers, [there * people * header.points * width])
    shape = (there, people, header.points)
    ids = tuple(str(person + 1) for person in range(people))
    return _Body(values.reshape(*shape, width), confidence.reshape(shape), float(rate), ids)


def _frames_apart(source: Source, header: _Header, content: bytes) -> _Body:
    """The body of v0.0: frame by frame the people, with an id each, point by point."""
    width, points = max(header.dimensions), header.points
    found: dict[str, dict[int, Array]] = {}
    place = header.end + 4
    try:
        rate, frames = struct.unpack_from("<HH", content, header.end)
        for frame in range(frames):
            (people,) = struct.unpack_from("<H", content, place)
            place += 2
            for _ in range(people):
                (number,) = struct.unpack_from("<h", content, place)
                person, place = _person(header, content, place + 2)
                found.setdefault(str(number), {})[frame] = person
    except _DAMAGED:
        raise source.error("a damaged file (it ends before its last frame)", "a whole .pose file") from None
    if place != len(content):
        raise source.error(f"{len(content) - place} bytes after the last frame", "a whole .pose file")
    table = np.zeros((frames, len(found), points, width + 1), np.float32)
    for column, person_frames in enumerate(found.values()):
        for frame, person in person_frames.items():
            table[frame, column] = person
    return _Body(table[..., :width], table[..., width], float(rate), tuple(found))


def _person(header: _Header, content: bytes, place: int) -> tuple[Array, int]:
    """The points (N, D + 1) of one person in one frame, confidence last, and where the next one starts."""
    found = np.zeros((header.points, max(header.dimensions) + 1))
    row = 0
    for points, width in zip(header.components.values(), header.dimensions, strict=True):
        numbers = np.frombuffer(content, "<f4", len(points) * (width + 1), place).reshape(len(points), width + 1)
        found[row : row + len(points), :width] = numbers[:, :width]
        found[row : row + len(points), -1] = numbers[:, -1]
        place, row = place + numbers.nbytes, row + len(points)
    return found, place


def _parts(source: Source, header: _Header, body: _Body, person: int) -> dict[str, Part]:
    """Body and hands of one person."""
    found: dict[str, Part] = {}
    first = 0
    for (name, points), width in zip(header.components.items(), header.dimensions, strict=True):
        columns = slice(first, first + len(points))
        first += len(points)
        part = part_of(name) or ("body" if sum(joint_called(point) is not None for point in points) >= NAMED else None)
        if part in (*BODIES, *HANDS) and part not in found:
            keys = points if part in BODIES else range(len(points))
            found[part] = _part(
                tuple(keys), body.values[:, person, columns], body.confidence[:, person, columns], width
            )
    found = {name: part for name, part in found.items() if np.isfinite(part.values).any()}
    if not any(name in found for name in BODIES):
        raise source.error(f"no body among {', '.join(header.components)}", "a component POSE_LANDMARKS or the like")
    return found


def _part(keys: tuple[str | int, ...], values: Array, confidence: Array, width: int) -> Part:
    """Points (T, N, D) with missing ones nan."""
    solid = np.zeros((*values.shape[:2], 3))
    solid[:, :, :width] = values[:, :, :width]
    there = (confidence > 0.0) & np.isfinite(solid).all(axis=2)
    solid[~there] = np.nan
    return Part(keys, solid, np.clip(np.nan_to_num(confidence.astype(float)), 0.0, 1.0), planar=width < 3)  # noqa: PLR2004
