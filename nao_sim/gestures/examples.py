"""An example of a gesture in a recording: which part of it, and whether it shows a pose or a movement."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from nao_sim.errors import UsageError
from nao_sim.gestures.directions import ArmReadings, readings_of_skeleton
from nao_sim.gestures.pose_examples import hanging
from nao_sim.gestures.streaming import HOLD
from nao_sim.gestures.windows import FEWEST, RATE, Window, window_of
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, Mask

Kind = Literal["pose", "movement"]
QUIET = np.radians(
    8.0
)  # arms that stay so near to their mean are held; signs of small movements turn them by 10 and more
MOSTLY = 0.4  # of the time in which the arms do not hang, from which on arms held still show a pose
AROUND = 0.2  # s before and after the arms hang that belong to a movement


@dataclass(frozen=True, eq=False)
class Example:
    """What a recording shows of a gesture.

    Attributes:
        skeleton: the recording.
        active: the frames from where the arms leave the sides to where they are back, a little more on both
            ends; all where they always hang.
        held: of those, the frames of the longest time in which the arms kept still.
        stillness: how much of the active time that is, 0 to 1.
    """

    skeleton: Skeleton
    active: slice
    held: slice
    stillness: float

    @property
    def kind(self) -> Kind:
        """What it looks like."""
        return "pose" if self.stillness >= MOSTLY else "movement"

    @property
    def movement(self) -> Skeleton:
        """The person while active."""
        return cut(self.skeleton, self.active)

    @property
    def pose(self) -> Skeleton:
        """The person while still."""
        return cut(self.skeleton, self.held)

    @property
    def readings(self) -> ArmReadings:
        """The arms while still."""
        return readings_of_skeleton(self.pose)

    @property
    def window(self) -> Window:
        """The arms while active.

        Raises:
            UsageError: it is too short for a movement.
        """
        lasts = self.movement.duration
        if lasts < FEWEST / RATE:
            raise UsageError(f"moves for {lasts:.2f} s only; expected a movement of {FEWEST / RATE:.2f} s or more")
        return window_of(self.movement)


def example_of(skeleton: Skeleton) -> Example:
    """Find the gesture in a recording of it.

    Raises:
        UsageError: no arm is tracked.
    """
    readings = readings_of_skeleton(skeleton)
    known = readings.trust > 0.0
    if not known.any():
        raise UsageError("no arm is seen in it; expected shoulders, elbows and wrists")
    active = _active(skeleton.times, readings, known)
    start, end = _longest_still(skeleton.times, _smooth(skeleton.times, readings.directions), active)
    lasts = skeleton.times[active.stop - 1] - skeleton.times[active.start]
    still = skeleton.times[end - 1] - skeleton.times[start]
    return Example(skeleton, active, slice(start, end), float(still / lasts) if lasts > 0.0 else 1.0)


def between(skeleton: Skeleton, start: float | None, end: float | None) -> Skeleton:
    """The frames from `start` to `end`, seconds after the first frame.

    Raises:
        UsageError: there is none.
    """
    since = skeleton.times - skeleton.times[0]
    inside = (since >= (-np.inf if start is None else start)) & (since <= (np.inf if end is None else end))
    if not inside.any():
        raise UsageError(f"no frame between --start and --end; it lasts {since[-1]:.2f} s")
    first, last = np.flatnonzero(inside)[[0, -1]]
    return cut(skeleton, slice(int(first), int(last) + 1))


def cut(skeleton: Skeleton, frames: slice) -> Skeleton:
    """Some frames of a recording."""
    return replace(
        skeleton,
        times=skeleton.times[frames],
        positions=skeleton.positions[frames],
        confidence=skeleton.confidence[frames],
    )


def _active(times: Array, readings: ArmReadings, known: Mask) -> slice:
    """The frames from the first to the last in which an arm that is seen does not hang."""
    raised = (~hanging(readings.directions) & known.all(axis=2)).any(axis=1)
    if not raised.any():
        return slice(0, len(times))
    first, last = np.flatnonzero(raised)[[0, -1]]
    return slice(
        int(np.searchsorted(times, times[first] - AROUND)), int(np.searchsorted(times, times[last] + AROUND, "right"))
    )


def _smooth(times: Array, directions: Array) -> Array:
    """Directions (T, 2, 2, 3), 0 where unknown, as unit vectors of their means over `HOLD` seconds."""
    sums = np.cumsum(np.concatenate([np.zeros((1, 2, 2, 3)), np.nan_to_num(directions)]), axis=0)
    first, end = (np.searchsorted(times, times + offset) for offset in (-HOLD / 2.0, HOLD / 2.0 + 1e-6))
    means = sums[end] - sums[first]
    length = np.linalg.norm(means, axis=-1, keepdims=True)
    return np.where(np.isfinite(directions) & (length > 1e-6), means / np.maximum(length, 1e-6), 0.0)  # noqa: PLR2004


def _longest_still(times: Array, directions: Array, active: slice) -> tuple[int, int]:
    """First frame and end of the longest time in which no segment is more than `QUIET` off its mean."""
    best, start = (active.start, active.start + 1), active.start
    total = np.zeros(directions.shape[1:])
    for frame in range(active.start, active.stop):
        total = total + directions[frame]
        while not _alike(directions[start : frame + 1], total):
            total = total - directions[start]
            start += 1
        if times[frame] - times[start] > times[best[1] - 1] - times[best[0]]:
            best = start, frame + 1
    return best


def _alike(directions: Array, mean: Array) -> bool:
    """Whether directions (N, 2, 2, 3), 0 where unknown, are within `QUIET` of vectors (2, 2, 3) of any length."""
    length = np.linalg.norm(mean, axis=-1)
    known = (directions != 0.0).any(axis=-1) & (length > 0.0)
    return bool(((directions * mean).sum(axis=-1) >= np.cos(QUIET) * length)[known].all())
