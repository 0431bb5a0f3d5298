"""The speeds nearest to the wanted ones among those that a few linear rules allow."""

from __future__ import annotations

import daqp
import numpy as np

from nao_sim.robot import Array

SOFT = 8  # daqp's mark of a constraint that may be broken where nothing else is left
UNBOUNDED = 1e30
FLAT = 1e-6  # a row with less slope than this is nothing that anybody can do


def nearest(wanted: Array, weight: Array, limits: tuple[Array, Array], rows: Array, least: Array) -> Array:
    """Minimise sum weight (x - wanted)^2, subject to limits and rows @ x >= least.

    Limits always hold.  Rows that cannot all hold are broken as little as possible.

    Args:
        wanted: (n,).
        weight: (n,) greater than 0.
        limits: lowest and highest values, (n,) each.
        rows: (m, n).
        least: (m,).

    Returns:
        (n,)
    """
    scale = np.sqrt(weight)  # in z = scale x the objective is a plain distance
    scaled = rows / scale
    size = np.linalg.norm(scaled, axis=1)
    felt = size > FLAT
    scaled, least = scaled[felt] / size[felt, None], least[felt] / size[felt]
    low, high = (scale * limit for limit in limits)
    upper = np.concatenate([high, np.full(len(least), UNBOUNDED)])
    lower = np.concatenate([low, least])
    for mark in (0, SOFT):
        sense = np.concatenate([np.zeros(len(low), np.int32), np.full(len(least), mark, np.int32)])
        x, _, flag, _ = daqp.solve(np.eye(len(low)), -scale * wanted, scaled, upper, lower, sense)
        if flag > 0:
            return np.clip(np.asarray(x) / scale, *limits)
    return np.clip(wanted, *limits)
