"""Tables of thresholds that decide a gesture: what a decision rule is made of.

A row says that a quantity must be at least, or at most, a value.  A gesture
holds where all its rows hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from nao_sim.robot import Array

AT_LEAST, AT_MOST = ">=", "<="


class Threshold(NamedTuple):
    """A row of the table.

    Attributes:
        label: the class that it is a condition of.
        quantity: the column, from 0.
        relation: `AT_LEAST` or `AT_MOST`.
        value: in the column's unit.
        width: how far inside the typical example of the class is, in the column's unit; it weighs
            a miss, and changes nothing about what holds.
    """

    label: str
    quantity: int
    relation: str
    value: float
    width: float = 1.0

    def margins(self, values: Array) -> Array:
        """How well values (N, F) hold, (N,): below 0 not, 1 as a typical example of the class."""
        above: Array = (values[:, self.quantity] - self.value) / self.width
        return above if self.relation == AT_LEAST else -above


def class_margins(table: Iterable[Threshold], labels: Sequence[object], values: Array) -> Array:
    """How well each class holds: its worst row.

    Args:
        table: the thresholds.
        labels: (K,) the classes.
        values: (N, F) the quantities.

    Returns:
        (N, K) margins, 0 or above where all rows of the class hold; -inf for a class without rows.
    """
    result = np.full((len(values), len(labels)), np.inf)
    for column, label in enumerate(labels):
        rows = [row.margins(values) for row in table if row.label == label]
        result[:, column] = np.min(rows, axis=0) if rows else -np.inf
    return result


def ranges(table: Iterable[Threshold], digits: int = 2) -> dict[str, dict[int, str]]:
    """The table for people: by class, in the table's order, and by column, in which range it must be.

    Args:
        table: the thresholds.
        digits: of the values.
    """
    limits: dict[str, dict[int, dict[str, float]]] = {}
    for row in table:
        limits.setdefault(str(row.label), {}).setdefault(row.quantity, {})[row.relation] = row.value
    return {
        label: {column: _words(limits[label][column], digits) for column in sorted(limits[label])} for label in limits
    }


def _words(limits: dict[str, float], digits: int) -> str:
    if len(limits) == 1:
        ((relation, value),) = limits.items()
        return f"{relation} {value:+.{digits}f}"
    return f"{limits[AT_LEAST]:+.{digits}f} to {limits[AT_MOST]:+.{digits}f}"
