"""A part of the comparison: a table with words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nao_sim.gestures.training_table import GESTURES


@dataclass(frozen=True)
class Section:
    """A part of the comparison.

    Attributes:
        title: what it is about.
        head: names of the columns.
        rows: of the table, as text.
        remarks: why figures differ, and what cannot be known.
        picture: name of the plot that belongs to it, if one does.
    """

    title: str
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    remarks: tuple[str, ...] = ()
    picture: str | None = None


def nearest(output: float) -> str:
    """The gesture that an output is rounded to, half-way to the higher."""
    return GESTURES[int(np.clip(np.floor(output + 0.5), 1, len(GESTURES))) - 1]


def share(right: int, count: int) -> str:
    """How many of how many, in words."""
    return f"{right} of {count} ({100 * right / count:.0f} %)"
