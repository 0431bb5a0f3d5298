"""Short gaps are filled between the frames around them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nao_sim.motion import Skeleton
from nao_sim.robot import Array

FILLED = 0.25  # confidence of a filled point, of what its neighbours have
LONGEST_GAP = 0.5  # s; in a longer one a person may have done anything
_RUN_UP = 0.15  # s over which the speed into and out of a gap is taken; less follows noise, more misses turns
_STEEPEST = 3.0  # times the mean speed across the gap (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980)


@dataclass(frozen=True)
class Fill:
    """Fills gaps of single joints with cubic curves that leave and arrive at the speed the joint had.

    Measured on gaps cut into the shared recordings, this beat straight lines
    and PCHIP, and it does not depend on how the room's axes lie.  Before a
    joint's first frame and after its last nothing is filled.

    Attributes:
        longest: s from the frame before a gap to the one behind it; longer gaps stay.
    """

    longest: float = LONGEST_GAP

    def __post_init__(self) -> None:
        if not (math.isfinite(self.longest) and self.longest >= 0.0):
            raise ValueError(f"longest is {self.longest}; expected seconds, 0 or more")

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The skeleton without short gaps; filled points have `FILLED` times the confidence around them."""
        positions, confidence = np.array(skeleton.positions), np.array(skeleton.confidence)
        for joint in range(len(skeleton.joints)):
            self._fill(skeleton.times, positions[:, joint], confidence[:, joint])
        return replace(skeleton, positions=positions, confidence=confidence)

    def _fill(self, times: Array, track: Array, confidence: Array) -> None:
        """Fill a track (T, 3) in place."""
        there = np.flatnonzero(np.isfinite(track).all(axis=1))
        gaps = (np.diff(there) > 1) & (np.diff(times[there]) <= self.longest)
        speeds = _speeds(times[there], track[there])
        for gap in np.flatnonzero(gaps):
            before, behind = there[gap], there[gap + 1]
            inside = slice(before + 1, behind)
            ends = times[[before, behind]], track[[before, behind]]
            track[inside] = _curve(*ends, (speeds[0][gap], speeds[1][gap + 1]), times[inside])
            confidence[inside] = FILLED * min(confidence[before], confidence[behind])


def _speeds(times: Array, track: Array) -> tuple[Array, Array]:
    """Velocities (N, 3) m/s over the run-up to each frame and over the way on from it; nan where there is none."""
    frames = np.arange(len(times))
    first = np.searchsorted(times, times - _RUN_UP)
    last = np.searchsorted(times, times + _RUN_UP, side="right") - 1
    return _mean_speed(times, track, first, frames), _mean_speed(times, track, frames, last)


def _mean_speed(times: Array, track: Array, first: NDArray[np.intp], last: NDArray[np.intp]) -> Array:
    took = np.where(last > first, times[last] - times[first], np.nan)
    return (track[last] - track[first]) / took[:, None]


def _curve(times: Array, places: Array, speeds: tuple[Array, Array], at: Array) -> Array:
    """Cubic Hermite curve (N, 3) between two places (2, 3) at two times (2,)."""
    took = times[1] - times[0]
    straight = (places[1] - places[0]) / took
    leave, arrive = (_limited(speed, straight) for speed in speeds)
    u = ((at - times[0]) / took)[:, None]
    line = places[0] + u * (places[1] - places[0])
    return line + took * u * (1.0 - u) * ((1.0 - u) * (leave - straight) - u * (arrive - straight))


def _limited(speed: Array, straight: Array) -> Array:
    """The speed, but no faster than lets the curve stay near the straight way."""
    if not np.isfinite(speed).all():
        return straight
    fastest, fast = _STEEPEST * float(np.linalg.norm(straight)), float(np.linalg.norm(speed))
    return speed * (fastest / fast) if fast > fastest else speed
