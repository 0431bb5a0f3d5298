"""Shares of trials, with 95 % intervals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Z = 1.959964  # of 95 % of a normal distribution


@dataclass(frozen=True)
class Share:
    """How many of how many trials.

    Attributes:
        right: of them.
        count: all.
    """

    right: int
    count: int

    @property
    def value(self) -> float:
        """From 0 to 1; nan of no trials."""
        return self.right / self.count if self.count else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's score interval (1927) of independent trials; 0 to 1 of none."""
        if not self.count:
            return 0.0, 1.0
        share, squared = self.value, Z * Z / self.count
        middle = (share + squared / 2.0) / (1.0 + squared)
        half = Z / (1.0 + squared) * math.sqrt(share * (1.0 - share) / self.count + squared / (4.0 * self.count))
        low = 0.0 if self.right == 0 else max(middle - half, 0.0)
        return low, 1.0 if self.right == self.count else min(middle + half, 1.0)

    def __str__(self) -> str:
        """`99.1 % (98.6-99.4)`."""
        return "-" if not self.count else percent(self.value, self.interval)

    def as_report(self) -> dict[str, Any]:
        """As the JSON has it."""
        value = round(self.value, 6) if self.count else None
        return {"right": self.right, "count": self.count, "share": value,
                "interval": [round(bound, 6) for bound in self.interval]}  # fmt: skip


def share_of(right: NDArray[np.bool_]) -> Share:
    """Of trials (N,)."""
    return Share(int(np.sum(right)), len(right))


def between_groups(right: NDArray[np.bool_], groups: NDArray[Any], draws: int = 2000) -> tuple[float, float]:
    """The interval of a share (N,) of trials that belong together in groups (N,): a bootstrap over groups, 0 to 1.

    The groups' names do not matter.
    """
    random = np.random.default_rng(0)
    _, members = np.unique(groups, return_inverse=True)
    counted = sorted((int(right[members == group].sum()), int((members == group).sum())) for group in set(members))
    sums, counts = np.array(counted).T
    drawn = random.integers(len(sums), size=(draws, len(sums)))
    low, high = np.quantile(sums[drawn].sum(axis=1) / counts[drawn].sum(axis=1), [0.025, 0.975])
    return float(low), float(high)


def percent(value: float, interval: tuple[float, float]) -> str:
    """`99.1 % (98.6-99.4)`."""
    return f"{100 * value:.1f} % ({100 * interval[0]:.1f}-{100 * interval[1]:.1f})"
