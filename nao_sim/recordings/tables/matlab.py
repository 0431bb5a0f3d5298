"""MATLAB's `.mat` files (v5 to v7): an array of joints, coordinates and frames in any order, or a track for each joint.

Which axis is which is told by the sizes that known skeletons have, and by which order makes a body.  v7.3 is another
format (HDF5), which is not read.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from nao_sim.errors import RecordingError
from nao_sim.recordings.landmarks.landmark_words import plain, words
from nao_sim.recordings.recording import Recording
from nao_sim.recordings.skeletons.layout_file import read_layout
from nao_sim.recordings.skeletons.layouts import builtin
from nao_sim.recordings.skeletons.points import Points, Understood, understand
from nao_sim.recordings.skeletons.timestamps import unit_named
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.matlab_arrays import Found, contents
from nao_sim.robot import Array

NAME = "MATLAB .mat"
LOOKS = "a MATLAB .mat file (v5 to v7) with joints x 3 x frames"
KIND = "binary"
RATE = 30.0  # Hz, of depth cameras, most such files' source
SHOWN = 6  # variables in a message
LARGEST = 1e7  # units of the file; no body and no room is larger in any unit
TRIED = 12  # arrays that are tried for a body
COORDINATES = (3, 2)  # sizes of an axis that may be x, y (and z)
_STARTS = {b"MATLAB 5.0 MAT-file": "MATLAB v5 to v7", b"MATLAB 7.3 MAT-file": "MATLAB v7.3", b"\x89HDF\r\n": "HDF5"}


@dataclass(frozen=True, eq=False)
class _Order:
    """One way to take an array.

    Attributes:
        name: the variable.
        axes: what its axes are, for the user.
        values: (T, J, 3).
        names: (J,) or None.
    """

    name: str
    axes: str
    values: Array
    names: tuple[str, ...] | None = None


def recognise(source: Source) -> str | None:
    """Why the file is MATLAB's, or None."""
    return next((name for start, name in _STARTS.items() if source.start.startswith(start)), None)


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file; its `person` is the name of a variable, where several may be meant.
        reason: why it is taken for this format.

    Returns:
        The recording: the one array that makes a person.

    Raises:
        RecordingError: none does, or several do (they are named), or the file is damaged or v7.3.
    """
    if source.start.startswith(b"\x89HDF"):
        raise source.error("HDF5, as MATLAB v7.3 has it", "an older format: save('file.mat', ..., '-v7')")
    found = contents(source)
    order, understood = _chosen(source, found, _orders(source, found))
    reason = f"{reason}, variable {order.name} as {order.axes}; {understood.reason}"
    return Recording(source.path, NAME, reason, understood.skeleton, len(order.values), understood.notes)


def _orders(source: Source, found: Found) -> dict[str, list[_Order]]:
    """The ways to take each variable that may hold a person."""
    sizes = {len(layout) for layout in builtin()} | {len(names) for names in found.names}
    if source.layout is not None:
        sizes = {len(read_layout(source.layout))}
    orders = {
        name or "tracks": [_Order(name or "tracks", f"a track for each of {len(names)} joints", values, names)]
        for name, (values, names) in found.tracks.items()
    }
    for name, array in found.arrays.items():
        ways = [order for order in _ways(name, np.asarray(array, float)) if order.values.shape[1] in sizes]
        if ways:
            orders[name] = [replace(way, names=_names(found, way.values.shape[1])) for way in ways]
    return orders


def _ways(name: str, array: Array) -> Iterator[_Order]:
    """The ways to take an array as (T, J, 3): which axis is frames, joints, coordinates."""
    size = " x ".join(map(str, array.shape))
    if array.ndim == 3:  # noqa: PLR2004
        for frames, joints, coordinates in itertools.permutations(range(3)):
            if array.shape[coordinates] in COORDINATES:
                words_ = {frames: "frames", joints: "joints", coordinates: "coordinates"}
                values = _solid(np.transpose(array, (frames, joints, coordinates)))
                yield _Order(name, f"{size} ({' x '.join(words_[axis] for axis in range(3))})", values)
    if array.ndim == 2:  # noqa: PLR2004
        for turned, table in ((False, array), (True, array.T)):
            where = "columns" if not turned else "rows"
            if table.shape[1] % 3 == 0:
                split = table.reshape(len(table), -1, 3)
                yield _Order(name, f"{size} (x y z of each joint in {where})", split)
                split = np.moveaxis(table.reshape(len(table), 3, -1), 1, 2)
                yield _Order(name, f"{size} (all x, all y, all z in {where})", split)
            if table.shape[1] in COORDINATES:
                yield _Order(name, f"{size} (one frame)", _solid(table[None]))


def _solid(values: Array) -> Array:
    """Points (T, J, 2 or 3) with a third coordinate of 0 where there is none."""
    missing = 3 - values.shape[2]
    return np.pad(values, ((0, 0), (0, 0), (0, missing)))


def _names(found: Found, joints: int) -> tuple[str, ...] | None:
    """The file's own names for so many joints, where it has one list of them."""
    lists = [names for names in found.names if len(names) == joints and len(set(names)) == joints]
    return lists[0] if len(lists) == 1 else None


def _chosen(source: Source, found: Found, orders: Mapping[str, list[_Order]]) -> tuple[_Order, Understood]:
    """The one way to take the file's variables that makes a person."""
    if source.person is not None:
        if source.person not in orders:
            raise source.error(
                f"no variable '{source.person}' that may be a person", _listed(tuple(orders) or found.told)
            )
        orders = {source.person: orders[source.person]}
    if not orders:
        what = _listed(found.told) if found.told else "no variables"
        raise source.error(what, "an array of joints x 3 x frames of a known skeleton, or one with names")
    people, errors = list[tuple[_Order, Understood]](), list[tuple[_Order, RecordingError]]()
    for order in itertools.islice((way for ways in orders.values() for way in ways), TRIED):
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


def _alike(people: list[tuple[_Order, Understood]]) -> bool:
    """Whether several ways to take a variable come to the same."""
    first = people[0][0].values
    return all(first.shape == order.values.shape and np.array_equal(first, order.values) for order, _ in people[1:])


def _points(found: Found, order: _Order) -> Points:
    """The points with the file's times or rate, where it tells them."""
    values = np.where(np.abs(order.values) < LARGEST, order.values, np.nan)
    points = Points(values, order.names, rate=RATE)
    for name, numbers in found.numbers.items():
        key = plain(name.rpartition(".")[2])
        if key in words("rate") and len(numbers) == 1 and numbers[0] > 0.0:
            return replace(points, times=np.arange(len(order.values)) / float(numbers[0]), time_unit=1.0)
        if key in (*words("time"), *words("times")) and len(numbers) == len(order.values) > 1:
            return replace(points, times=numbers, time_unit=unit_named(name))
    return points


def _listed(names: tuple[str, ...] | list[str]) -> str:
    return ", ".join(names[:SHOWN]) + (f" and {len(names) - SHOWN} more" if len(names) > SHOWN else "")
