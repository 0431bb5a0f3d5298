"""Thresholds from labelled data, few enough to be read.

A class is its median, which a few broken rows do not move.  A threshold stands
between the medians of two classes that are clearly further apart than the data
scatters.  In each group of columns a class takes as few thresholds as tell it
from all other classes that this group clearly tells it from; where no group
does, the clearest threshold of all is taken.

Those leave a rule open on sides where no other class needs to be kept out, and
what lies between two classes could enter there.  So each column that reaches
far from a class gets a bound on that side, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nao_sim.gestures.thresholds import AT_LEAST, AT_MOST, Threshold
from nao_sim.robot import Array

APART = 4.0  # standard deviations between two medians, so that their middle is two from each
FAR = 0.4  # of a column's range over all classes: from here on another class is far
SAME = 1e-9  # share of a column's size below which two medians are one
NORMAL = 1.4826  # standard deviations in a median absolute deviation, of normal scatter


class _Way(NamedTuple):
    """From a class to another one, along a column."""

    label: Any
    column: int
    start: float  # the class's median
    length: float  # to the other's; below 0 downwards
    excludes: frozenset[int]  # that one and all beyond
    clarity: float  # its length in standard deviations
    far: bool

    def threshold(self, share: float) -> Threshold:
        """The threshold at a share of the way."""
        relation = AT_MOST if self.length > 0 else AT_LEAST
        return Threshold(self.label, self.column, relation, self.start + share * self.length, share * abs(self.length))

    @property
    def side(self) -> tuple[int, bool]:
        """The column and the direction."""
        return self.column, self.length > 0


def learn(
    values: Array, labels: NDArray[Any], order: Sequence[Any], groups: Sequence[Sequence[int]], reach: float,
    bound: float | None,
) -> tuple[Threshold, ...]:  # fmt: skip
    """The table.

    Args:
        values: (N, F) quantities.
        labels: (N,) of the rows.
        order: (K,) the labels, in the order in which the table has them.
        groups: columns that are decided about together.
        reach: where on the way to the neighbour's median a threshold is.
        bound: the same for the bounds; none of them where None.

    Returns:
        The thresholds, class by class; a class that nothing tells from another has the one
        row that its own data keep, so that it can hold at all.
    """
    medians = np.stack([np.median(values[labels == label], axis=0) for label in order])
    rows = np.array([list(order).index(label) for label in labels.tolist()])
    scatter = NORMAL * np.median(np.abs(values - medians[rows]), axis=0)
    table: list[Threshold] = []
    for place, label in enumerate(order):
        ways = [_ways(place, label, medians, scatter, group) for group in groups]
        chosen = [each for group in ways for each in _cover([way for way in group if way.clarity > APART])]
        rest = frozenset(range(len(order))).difference([place], *(each.excludes for each in chosen))
        chosen += _clearest([way for group in ways for way in group], rest)
        found = [each.threshold(reach) for each in chosen]
        if bound is not None:
            found += [way.threshold(bound) for group in ways for way in _bounds(group, chosen)]
        table += sorted(found, key=lambda row: row.quantity) or [_own(label, values[rows == place])]
    return tuple(table)


def _ways(place: int, label: Any, medians: Array, scatter: Array, columns: Sequence[int]) -> list[_Way]:
    """To each other class, in each column."""
    found = []
    for column in columns:
        lengths = medians[:, column] - medians[place, column]
        far = FAR * np.ptp(medians[:, column])
        for length in lengths[np.abs(lengths) > SAME * np.abs(medians[:, column]).max()].tolist():
            beyond = frozenset(np.flatnonzero(lengths >= length if length > 0 else lengths <= length).tolist())
            clarity = abs(length) / max(scatter[column], SAME * abs(length))
            found.append(
                _Way(label, column, float(medians[place, column]), length, beyond, clarity, bool(abs(length) >= far))
            )
    return found


def _cover(ways: list[_Way]) -> list[_Way]:
    """A small cover: again and again what excludes most of the classes that are left, the clearest first."""
    left = frozenset[int]().union(*(way.excludes for way in ways))
    chosen = []
    while left:
        best = max(ways, key=lambda way: (len(way.excludes & left), way.clarity))
        chosen.append(best)
        left -= best.excludes
    return chosen


def _clearest(ways: list[_Way], rest: frozenset[int]) -> list[_Way]:
    """For each class of the rest what tells it best, if anything does."""
    able = [[way for way in ways if other in way.excludes] for other in sorted(rest)]
    return list(dict.fromkeys(max(each, key=lambda way: way.clarity) for each in able if each))


def _bounds(ways: list[_Way], chosen: list[_Way]) -> list[_Way]:
    """The way to the nearest class that is far and clear, on each side where no threshold is chosen yet."""
    nearest: dict[tuple[int, bool], _Way] = {}
    for way in sorted(ways, key=lambda way: -abs(way.length)):
        if way.far and way.clarity > APART:
            nearest[way.side] = way
    taken = {way.side for way in chosen}
    return [way for side, way in nearest.items() if side not in taken]


def _own(label: Any, values: Array) -> Threshold:
    return Threshold(label, 0, AT_LEAST, float(values[:, 0].min()))
