"""Motion that motors can follow, without lag: a bound on speed, then smoothing that keeps it."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array

_PASSES = 2  # of smoothing, forwards and backwards each


def calm(times: Array, values: Array, fastest: Array, softness: Array) -> Array:
    """Values that change no faster than `fastest`, and without jerks.

    The speed is bounded by the middle between the lowest curve above and the
    highest curve below that are slow enough: right in time, where a limiter
    that only looks back would lag.  The smoothing is exponential, forwards and
    backwards, and takes any frame times.

    Args:
        times: (T,) s.
        values: (T, N).
        fastest: (N,) a second.
        softness: (T,) s, the time constant of the smoothing.

    Returns:
        (T, N) within the range of `values`.
    """
    steps = np.diff(times)[:, None]
    slow = (slow_above(values, steps * fastest) - slow_above(-values, steps * fastest)) / 2.0
    for _ in range(_PASSES):
        slow = _forwards(slow, steps / softness[1:, None])
        slow = _forwards(slow[::-1], steps[::-1] / softness[-2::-1, None])[::-1]
    return slow


def slow_above(values: Array, farthest: Array) -> Array:
    """The lowest curve (T, N) above `values` that moves by at most `farthest` (T - 1, N) between frames."""
    high = np.array(values)
    for i in range(1, len(high)):
        np.maximum(high[i], high[i - 1] - farthest[i - 1], out=high[i])
    for i in range(len(high) - 2, -1, -1):
        np.maximum(high[i], high[i + 1] - farthest[i], out=high[i])
    return high


def filled(times: Array, values: Array, otherwise: Array) -> Array:
    """Values (T, N) with straight lines through the gaps; `otherwise` (N,) in a column that is never known."""
    full = np.array(values)
    for i, column in enumerate(values.T):
        known = np.isfinite(column)
        full[:, i] = np.interp(times, times[known], column[known]) if known.any() else otherwise[i]
    return full


def _forwards(values: Array, steps: Array) -> Array:
    """Values (T, N) smoothed by the ones before them; steps (T - 1, 1) in time constants.

    Exact for values that go straight from frame to frame: their lead l over
    the smoothed ones follows l' = values' - l, so no step makes these faster.
    """
    decay, gain = np.exp(-steps), -np.expm1(-steps) / steps
    moves = gain * np.diff(values, axis=0)
    lead = np.zeros(values.shape)
    for i in range(1, len(values)):
        lead[i] = decay[i - 1] * lead[i - 1] + moves[i - 1]
    return values - lead
