"""Arrays of numbers that may be a person's points, whichever of their axes is which.

Which is told by the sizes that known skeletons have, and by which order makes a body.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from nao_sim.errors import RecordingError
from nao_sim.recordings.landmarks.landmark_words import plain, words
from nao_sim.recordings.skeletons.layout_file import read_layout
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.recordings.skeletons.points import Points, Understood, understand
from nao_sim.recordings.skeletons.timestamps import unit_named
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.matlab_arrays import Found
from nao_sim.robot import Array

RATE = 30.0  # Hz, of depth cameras, most such files' source
SHOWN = 6  # variables in a message
LARGEST = 1e7  # units of the file; no body and no room is larger in any unit
TRIED = 12  # arrays that are tried for a body
COORDINATES = (3, 2)  # sizes of an axis that may be x, y (and z)


@dataclass(frozen=True, eq=False)
class Order:
    """One way to take an array.

    Attributes:
        name: the variable.
        axes: what its axes are, for the user.
        values: (T, J, 3).
        names: (J,) or None.
        times: (T,) if the array has them.
    """

    name: str
    axes: str
    values: Array
    names: tuple[str, ...] | None = None
    times: Array | None = None


def orders(source: Source, found: Found) -> dict[str, list[Order]]:
    """The ways to take each variable that may hold a person."""
    sizes = {len(layout) for layout in builtin()} | {len(names) for names in found.names}
    if source.layout is not None:
        sizes = {len(read_layout(source.layout))}
    found_orders = {
        name or "tracks": [Order(name or "tracks", f"a track for each of {len(names)} joints", values, names)]
        for name, (values, names) in found.tracks.items()
    }
    for name, array in found.arrays.items():
        ways = [order for order in _ways(name, np.asarray(array, float)) if order.values.shape[1] in sizes]
        if ways:
            found_orders[name] = [replace(way, names=_names(found, way.values.shape[1])) for way in ways]
    return found_orders


def _ways(name: str, array: Array) -> Iterator[Order]:
    """The ways to take an array as (T, J, 3): which axis is frames, joints, coordinates."""
    size = " x ".join(map(str, array.shape))
    if array.ndim == 3:  # noqa: PLR2004
        for frames, joints, coordinates in itertools.permutations(range(3)):
            if array.shape[coordinates] in COORDINATES:
                words_ = {frames: "frames", joints: "joints", coordinates: "coordinates"}
                values = _solid(np.transpose(array, (frames, joints, coordinates)))
                yield Order(name, f"{size} ({' x '.join(words_[axis] for axis in range(3))})", values)
    if array.ndim == 2:  # noqa: PLR2004
        for turned, table in ((False, array), (True, array.T)):
            yield from _table_ways(name, size, table, "columns" if not turned else "rows")


def _table_ways(name: str, size: str, table: Array, where: str) -> Iterator[Order]:
    """The ways to take a table (T, C): x y z of each joint, after a time, or each with how sure it is."""
    width = table.shape[1]
    times, rest = (table[:, 0], table[:, 1:]) if width % 3 == 1 and _are_times(table[:, 0]) else (None, table)
    after = "" if times is None else "a time and "
    if rest.shape[1] % 3 == 0:
        split = rest.reshape(len(rest), -1, 3)
        yield Order(name, f"{size} ({after}x y z of each joint in {where})", split, times=times)
        split = np.moveaxis(rest.reshape(len(rest), 3, -1), 1, 2)
        yield Order(name, f"{size} ({after}all x, all y, all z in {where})", split, times=times)
    if width % 4 == 0 and _is_trust(fourth := table.reshape(len(table), -1, 4)[:, :, 3]):
        split = np.where((fourth == 0.0)[:, :, None], np.nan, table.reshape(len(table), -1, 4)[:, :, :3])
        yield Order(name, f"{size} (x y z and a confidence of each joint in {where})", split)
    if width in COORDINATES:
        yield Order(name, f"{size} (one frame)", _solid(table[None]))


def _are_times(values: Array) -> bool:
    return len(values) > 1 and bool(np.isfinite(values).all() and (np.diff(values) > 0.0).all())


def _is_trust(values: Array) -> bool:
    """Whether numbers are confidences or tracking states: 0 to 1, or 0, 1, 2, and not all 0."""
    known = values[np.isfinite(values)]
    small = len(known) > 0 and known.min() >= 0.0 and known.max() <= 2.0  # noqa: PLR2004
    return bool(small and known.any() and (known.max() <= 1.0 or (known % 1.0 == 0.0).all()))


def _solid(values: Array) -> Array:
    """Points (T, J, 2 or 3) with a third coordinate of 0 where there is none."""
    missing = 3 - values.shape[2]
    return np.pad(values, ((0, 0), (0, 0), (0, missing)))


def _names(found: Found, joints: int) -> tuple[str, ...] | None:
    """The file's own names for so many joints, where it has one list of them."""
    lists = [names for names in found.names if len(names) == joints and len(set(names)) == joints]
    return lists[0] if len(lists) == 1 else None


def chosen(source: Source, found: Found) -> tuple[Order, Understood]:
    """The one way to take a file's variables that makes a person, and what it makes.

    Raises:
        RecordingError: none does, or several do (they are named).
    """
    known = orders(source, found)
    if source.person is not None:
        if source.person not in known:
            raise source.error(
                f"no variable '{source.person}' that may be a person", _listed(tuple(known) or found.told)
            )
        known = {source.person: known[source.person]}
    if not known:
        what = _listed(found.told) if found.told else "no variables"
        raise source.error(what, "an array of joints x 3 x frames of a known skeleton, or one with names")
    people, errors = list[tuple[Order, Understood]](), list[tuple[Order, RecordingError]]()
    for order in itertools.islice((way for ways in known.values() for way in ways), TRIED):
        try:
            people.append((order, understand(source, _points(found, order))))
        except RecordingError as error:
            errors.append((order, error))
    if len(people) == 1 or (people and len({order.name for order, _ in people}) == 1 and _alike(people)):
        return people[0]
    if people:
        names = _listed([f"{order.name} as {order.axes}" for order, _ in people])
        raise source.error(f"several people: {names}", "one of the variables (--person NAME)")
    order, problem = errors[0]
    raise source.error(f"{order.name} as {order.axes}: {problem.found}", problem.expected)


def _alike(people: list[tuple[Order, Understood]]) -> bool:
    """Whether several ways to take a variable come to the same."""
    first = people[0][0].values
    return all(first.shape == order.values.shape and np.array_equal(first, order.values) for order, _ in people[1:])


def _points(found: Found, order: Order) -> Points:
    """The points with the file's times or rate, where it tells them."""
    values = np.where(np.abs(order.values) < LARGEST, order.values, np.nan)
    points = Points(values, order.names, order.times, rate=RATE)
    if order.times is not None:
        return points
    for name, numbers in found.numbers.items():
        key = plain(name.rpartition(".")[2])
        if key in words("rate") and len(numbers) == 1 and numbers[0] > 0.0:
            return replace(points, times=np.arange(len(order.values)) / float(numbers[0]), time_unit=1.0)
        if key in (*words("time"), *words("times")) and len(numbers) == len(order.values) > 1:
            return replace(points, times=numbers, time_unit=unit_named(name))
    return points


def _listed(names: tuple[str, ...] | list[str]) -> str:
    return ", ".join(names[:SHOWN]) + (f" and {len(names) - SHOWN} more" if len(names) > SHOWN else "")
