"""The smoothest way from one place to another: minimum jerk (T. Flash and N. Hogan, J. Neuroscience 5(7), 1985)."""

from __future__ import annotations

from typing import TypeVar

from nao_sim.robot import Array

PEAK_SPEED, PEAK_ACCELERATION = 1.875, 5.774  # of a way of length 1 in 1 s
_Share = TypeVar("_Share", float, Array)


def minimum_jerk(share: _Share) -> _Share:
    """How far on the way, 0 to 1, at a share of the time, 0 to 1."""
    return share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
