"""A way through poses, gone as fast as every joint may and never beside it."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array, read_only

SAMPLING = 0.06  # rad (hands 0..1); between two looks along a way no joint moves farther
_STANDS = 1e-12  # rad; a shorter piece is none


def looks(start: Array, end: Array) -> Array:
    """Poses (M, 26) after `start`, up to and with `end`, between which no joint moves farther than `SAMPLING`."""
    move = end - start
    pieces = max(int(np.ceil(np.abs(move).max() / SAMPLING)), 1)
    poses = start + move * (np.arange(1, pieces + 1) / pieces)[:, None]
    poses[-1] = end
    return poses


def coarse_first(poses: Array) -> Array:
    """Poses (M, 26) of a way in another order: at each time about evenly spread, so that what bars it is found soon."""
    bits = len(poses).bit_length()
    return poses[sorted(range(len(poses)), key=lambda i: int(f"{i + 1:0{bits}b}"[::-1], 2))]


def places(path: Array, shares: Array) -> Array:
    """Where shares (S,) of the length of a path (K, 26) are on it: 1.5 is halfway from its second pose to its third.

    Length is what the joint goes that moves farthest.
    """
    ends = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(path, axis=0)).max(axis=1))])
    return np.interp(shares * ends[-1], ends, np.arange(len(path)))


def short_cut(path: Array, first: float, second: float) -> tuple[Array, Array, Array]:
    """A path (K, 26) before a place on it, the straight way (2, 26) from there to a later one, and what follows."""
    cut = np.stack([_pose_at(path, first), _pose_at(path, second)])
    return path[: int(np.ceil(first))], cut, path[int(second) + 1 :]


def _pose_at(path: Array, place: float) -> Array:
    before = int(place)
    return path[before] if place == before else path[before] + (path[before + 1] - path[before]) * (place - before)


def travel_time(moves: Array, top: Array, acceleration: Array) -> Array:
    """Shortest times (...) s in which all joints together go straight moves (..., 26) from rest to rest.

    Share of the move s(t): speed rises at the rate a = min(acceleration / |move|), is held at
    v = min(top / |move|) where that is reached, and falls at the rate a.
    """
    speed, rate = _shares(moves, top, acceleration)
    return np.where(speed**2 < rate, 1.0 / speed + speed / rate, 2.0 / np.sqrt(rate))


def _shares(moves: Array, top: Array, acceleration: Array) -> tuple[Array, Array]:
    """Top speed (1/s) and acceleration (1/s^2), each (...), of the share of straight moves (..., 26)."""
    size = np.maximum(np.abs(moves), _STANDS)
    return (top / size).min(axis=-1), (acceleration / size).min(axis=-1)


class Route:
    """The straight pieces of a way, one after the other, each from rest to rest.

    Args:
        path: (K, 26) poses, K >= 1.
        top: (26,) greatest speed of each joint, rad/s (hands 1/s), above 0.
        acceleration: (26,) greatest acceleration, rad/s^2 (hands 1/s^2), above 0.

    Attributes:
        duration: s from the first pose to the last.
    """

    def __init__(self, path: Array, top: Array, acceleration: Array) -> None:
        moved = np.abs(np.diff(path, axis=0)).max(axis=1) > _STANDS
        self._path = read_only(np.concatenate([path[:1], path[1:][moved]]))
        self._end = read_only(path[-1])
        moves = np.diff(self._path, axis=0)
        self._speed, self._rate = _shares(moves, top, acceleration)
        self._ends = np.cumsum(travel_time(moves, top, acceleration))
        self.duration = float(self._ends[-1]) if len(moves) else 0.0

    def at(self, time: float) -> Array:
        """The pose (26,) `time` s after the start; before it the first one, after the end the last one."""
        if time < 0.0:
            return self._path[0].copy()
        if time >= self.duration:
            return self._end.copy()
        piece = int(np.searchsorted(self._ends, time, side="right"))
        start = self._ends[piece - 1] if piece else 0.0
        share = _share(time - start, self._ends[piece] - start, self._speed[piece], self._rate[piece])
        before, after = self._path[piece : piece + 2]
        return before + (after - before) * share


def _share(since: float, whole: float, speed: float, rate: float) -> float:
    """Share of a piece that is gone `since` s after its start; it takes the `whole` time."""
    rise = min(speed / rate, whole / 2.0)
    if since < rise:
        return rate * since**2 / 2.0
    if since > whole - rise:
        return 1.0 - rate * (whole - since) ** 2 / 2.0
    return rate * rise * (since - rise / 2.0)
