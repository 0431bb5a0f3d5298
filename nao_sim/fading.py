"""What comes and goes in a film, smoothly and for long enough to be seen."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array


def shown(active: Array, times: Array, step_times: Array, hold: float, fade: float) -> Array:
    """Opacities (N, K), 0 to 1, of K things at the times of a film's frames.

    Args:
        active: (T, K) 1 in the steps in which a thing is there, otherwise 0.
        times: (N,) s, of the frames.
        step_times: (T,) s, of the steps; evenly.
        hold: s for which it stays at least.
        fade: s in which it comes and goes.
    """
    step = float(step_times[0] if len(step_times) == 1 else step_times[1] - step_times[0])
    held = _trailing(active, round(hold / step)) > 0.0
    faded = _trailing(held.astype(np.float64), round(fade / step))
    return np.stack([np.interp(times, step_times, each) for each in faded.T], axis=1)


def _trailing(values: Array, steps: int) -> Array:
    """Means (T, N) of each value and the `steps - 1` before it, those before the first being 0."""
    steps = max(1, steps)
    sums = np.concatenate([np.zeros((steps, values.shape[1])), np.cumsum(values, axis=0)])
    return (sums[steps:] - sums[:-steps]) / steps
