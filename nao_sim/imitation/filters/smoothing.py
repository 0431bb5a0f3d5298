"""Smoothing without lag, for recordings that are there as a whole.

The smooth track x is nearest to the recorded one y in the sense of

    integral of w |x - y|^2  +  lambda * integral of |x'''|^2

(Whittaker 1923; Reinsch 1967): jerk is what a person's movements have little
of (Flash and Hogan 1985) and noise much.  On evenly spaced frames it passes
the frequency f by 1 / (1 + (s(f) / s(cutoff))^6), s(f) = sin(pi f Delta), which
is a third-order Butterworth filter run forwards and backwards; but it takes any
frame times, weighs each frame by its confidence and needs no run-in at the
ends of a recording.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from nao_sim.motion import Skeleton
from nao_sim.robot import Array, Mask

ORDER = 3  # of the derivative that is kept small
_LEAST_WEIGHT = 0.01  # of a frame of no confidence: it is there, so it counts
# The two keep the equations solvable to a micrometre, and touch no rate below 190 times the cutoff:
_CLOSEST = 0.25  # median spacings; frames nearer to each other are taken for this far apart
_STIFFEST = 1e9


@dataclass(frozen=True)
class Smooth:
    """Zero-lag smoothing of every joint.

    Where a joint is missing its track ends, and begins anew behind; up to
    three frames by themselves stay as they are.

    Attributes:
        cutoff: Hz, the frequency of which half is passed where the frames are of full confidence.  Arms wave and
            shake below 4 Hz; of 3 Hz this one passes 98 %.
    """

    cutoff: float = 6.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.cutoff) and self.cutoff > 0.0):
            raise ValueError(f"cutoff is {self.cutoff}; expected a positive frequency in Hz")

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The skeleton with smooth tracks; times, joints and confidence as they were."""
        positions = np.array(skeleton.positions)
        weights = np.maximum(skeleton.confidence, _LEAST_WEIGHT)
        for joint in range(len(skeleton.joints)):
            there = np.flatnonzero(np.isfinite(positions[:, joint]).all(axis=1))
            positions[there, joint] = smooth(
                skeleton.times[there], positions[there, joint], weights[there, joint], self.cutoff, np.diff(there) == 1
            )
        return replace(skeleton, positions=positions)


def smooth(times: Array, values: Array, weights: Array, cutoff: float, joined: Mask | None = None) -> Array:
    """Smooth a track.

    Args:
        times: (N,) s, strictly increasing.
        values: (N, D) finite.
        weights: (N,) above 0.
        cutoff: Hz.
        joined: (N - 1,) whether a frame and the next belong together; they do where None.

    Returns:
        (N, D); `values` where there are too few of them, or too seldom, to say what is noise.
    """
    joined = np.ones(max(len(times) - 1, 0), bool) if joined is None else joined
    if len(times) <= ORDER or not joined.any():
        return values
    intervals = np.diff(times)
    typical = float(np.median(intervals[joined]))
    if cutoff * typical >= 0.5:  # noqa: PLR2004  the Nyquist frequency: the frames cannot hold what is to be taken away
        return values
    from scipy.linalg import solveh_banded

    # in units of the typical spacing, so that the numbers stay near 1
    spacing = np.maximum(intervals / typical, _CLOSEST)
    stiffness = min((2.0 * math.sin(math.pi * cutoff * typical)) ** (-2 * ORDER), _STIFFEST)
    mass = weights * _stands_for(spacing, joined)
    matrix = stiffness * _roughness(spacing, joined)
    matrix[0] += mass
    middle = values.mean(axis=0)  # far from the origin digits are lost
    return solveh_banded(matrix, mass[:, None] * (values - middle), lower=True) + middle


def _stands_for(spacing: Array, joined: Mask) -> Array:
    """How long a stretch (N,) each frame stands for: the mean distance to those it is joined with, or 1."""
    total, count = np.zeros((2, len(spacing) + 1))
    for side in (slice(1, None), slice(None, -1)):
        total[side] += np.where(joined, spacing, 0.0)
        count[side] += joined
    return np.where(count > 0, total / np.maximum(count, 1), 1.0)


def _roughness(spacing: Array, joined: Mask) -> Array:
    """Integral of the squared third derivative as a matrix (N, N), in SciPy's lower banded form (4, N)."""
    rows, width = _derivatives(spacing)
    width = width * np.lib.stride_tricks.sliding_window_view(joined, ORDER).all(axis=1)
    bands = np.zeros((ORDER + 1, len(spacing) + 1))
    for i in range(ORDER + 1):
        for j in range(i + 1):
            bands[i - j, j : j + len(rows)] += width * rows[:, i] * rows[:, j]
    return bands


def _derivatives(spacing: Array) -> tuple[Array, Array]:
    """Third derivative by divided differences.

    Returns:
        (N - 3, 4) weights of four neighbours each, and (N - 3,) how long a stretch each stands for.
    """
    times = np.concatenate([[0.0], np.cumsum(spacing)])
    windows = np.lib.stride_tricks.sliding_window_view(times, ORDER + 1)
    rows = np.empty(windows.shape)
    for i in range(ORDER + 1):
        others = np.delete(windows, i, axis=1)
        rows[:, i] = math.factorial(ORDER) / np.prod(windows[:, [i]] - others, axis=1)
    return rows, (windows[:, -1] - windows[:, 0]) / ORDER
