"""Words that several parts of the comparison share."""

from __future__ import annotations

import numpy as np

from nao_sim.gestures.training_table import GESTURES


def nearest(output: float) -> str:
    """The gesture that an output is rounded to, half-way to the higher."""
    return GESTURES[int(np.clip(np.floor(output + 0.5), 1, len(GESTURES))) - 1]


def share(right: int, count: int) -> str:
    """How many of how many, in words."""
    return f"{right} of {count} ({100 * right / count:.0f} %)"
