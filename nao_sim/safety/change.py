"""What the guard changed, and why."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim.robot import Array

NOTICEABLE = 1e-6  # rad; less is rounding


@dataclass(frozen=True, eq=False)
class Change:
    """One reason why the command is not what was asked.

    Attributes:
        reason: name of the rule.
        size: (26,) how far it moved each joint, rad (hands 0..1); 0 where it did not.
        links: the two links that would have met, for self-collision.
    """

    reason: str
    size: Array
    links: tuple[str, ...] = ()


Intervention = tuple[Change, ...]


def note(changes: list[Change], reason: str, size: Array, links: tuple[str, ...] = ()) -> None:
    """Add a change by sizes (26,), of either sign, if any of them is noticeable."""
    size = np.abs(size)
    if (size > NOTICEABLE).any():
        changes.append(Change(reason, np.where(size > NOTICEABLE, size, 0.0), links))
