"""Key frames as NAOqi plays them: cubic Bezier curves in time and value.

Between two keys the curve is the cubic Bezier through (t0, v0), the first
key's handle after it, the second key's handle before it, and (t1, v1); a key
without handles gets those of `automatic_handles` (ALMotion's
angleInterpolationBezier; libalmath, almath/interpolation/alinterpolationbezier.cpp
and almath/scenegraph/qianim/bezierautotangent.h).  A handle of no length on
both sides is a straight line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from nao_sim.motion import JointTrajectory
from nao_sim.recordings.source import Source
from nao_sim.robot import Array, load_robot

RATE = 50.0  # Hz, ALMotion's own
NEAR = 1e-3  # s; a sample this near to a key is the key
LONGEST_S = 6 * 3600.0  # samples are kept in memory
BEFORE, AFTER = 0, 1  # sides of a key
HALVINGS = 50  # of the interval in which a curve's parameter is looked for: down to 1e-15


class Kind(IntEnum):
    """How a curve runs on one side of a key, as NAOqi numbers it (libalmath, alinterpolationtypes.h)."""

    CONSTANT = 0
    LINEAR = 1
    BEZIER = 2
    BEZIER_AUTO = 3


@dataclass(frozen=True, eq=False)
class Curve:
    """One joint's keys.

    Attributes:
        joint: index in the joint vector.
        times: (K,) s, strictly increasing, K >= 1.
        values: (K,) rad, or opening of a hand.
        handles: (K, 2, 2) where the handles before and after each key are, as (s, rad) from it; nan: automatic.
        held: (K,) whether the value stays until the next key.
    """

    joint: int
    times: Array
    values: Array
    handles: Array
    held: NDArray[np.bool_]


def automatic_handles(times: Array, values: Array) -> Array:
    """Handles of keys that have none.

    They are a third of the way to the neighbouring keys in time; their slope
    is 0 at an extreme and otherwise that from the one neighbour to the other,
    but never so steep that the handle would pass a neighbour's value.

    Args:
        times: (K,) s.
        values: (K,).

    Returns:
        (K, 2, 2) as in `Curve`.
    """
    before, after = np.diff(times, prepend=times[:1]), np.diff(times, append=times[-1:])
    fell, rises = np.diff(values, prepend=values[:1]), np.diff(values, append=values[-1:])
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (fell + rises) / (before + after)
        steepest = 3.0 * np.minimum(np.abs(fell) / before, np.abs(rises) / after)
    slope = np.where(fell * rises > 0.0, np.sign(slope) * np.minimum(np.abs(slope), steepest), 0.0)
    ways = np.stack([-before, after], axis=1) / 3.0
    return np.stack([ways, ways * slope[:, None]], axis=2)


def trajectory(source: Source, curves: Sequence[Curve], end: float = np.inf) -> JointTrajectory:
    """Sample curves at every key, and at `RATE` wherever one of them is not straight.

    Before its first key a joint has that key's value, after its last key that one's.

    Args:
        source: the file, to be blamed.
        curves: one a joint, at least one.
        end: s, when the motion stops.

    Raises:
        RecordingError: it lasts too long.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # of angles that no robot has
        curves = [_with_all_handles(curve) for curve in curves]
        times = _sample_times(source, curves)
        times = times if end >= times[-1] else np.append(times[times < end - NEAR], end)
        positions = np.full((len(times), len(load_robot().joint_names)), np.nan)
        for curve in curves:
            positions[:, curve.joint] = evaluate(curve, times)
    given = np.isin(np.arange(positions.shape[1]), [curve.joint for curve in curves])
    return JointTrajectory(times, positions, given)


def _sample_times(source: Source, curves: Sequence[Curve]) -> Array:
    """Times (T,) s of all keys, and between them as often as it takes."""
    keys = np.unique(np.concatenate([curve.times for curve in curves]))
    if not any(_bent(curve).any() for curve in curves):
        return keys
    if keys[-1] > LONGEST_S:
        raise source.error(f"curves up to {keys[-1]:.6g} s", f"at most {LONGEST_S / 3600.0:g} hours of them")
    return np.union1d(keys, _ticks(curves, keys))


def evaluate(curve: Curve, times: Array) -> Array:
    """Values (N,) at `times` (N,) of a curve whose handles are all there; exact at its keys."""
    if len(curve.times) == 1:
        return np.full(len(times), curve.values[0])
    left = np.clip(np.searchsorted(curve.times, times, side="right") - 1, 0, len(curve.times) - 2)
    v0, v1 = curve.values[left], curve.values[left + 1]
    share = np.clip((times - curve.times[left]) / np.diff(curve.times)[left], 0.0, 1.0)
    values = v0 * (1.0 - share) + v1 * share
    bent = ~_straight(curve)[left]
    values[bent] = _on_bezier(curve, left[bent], share[bent])
    values = np.where((share == 0.0) | curve.held[left] & (share < 1.0), v0, values)
    return np.where(share == 1.0, v1, values)


def _on_bezier(curve: Curve, left: NDArray[np.int_], share: Array) -> Array:
    """Values (N,) where `share` (N,) of the time from key `left` (N,) to the next has passed."""
    span = np.diff(curve.times)[left]
    after, before = curve.handles[left, AFTER], curve.handles[left + 1, BEFORE]
    v0, v1 = curve.values[left], curve.values[left + 1]
    u = _parameter(share, after[:, 0] / span, 1.0 + before[:, 0] / span)
    return _bezier(u, v0, v0 + after[:, 1], v1 + before[:, 1], v1)


def _with_all_handles(curve: Curve) -> Curve:
    """Fill in the automatic handles, and shorten those that reach past a neighbouring key.

    Shortened they keep their slope, as libalmath does (qianim/surgeon.cpp): so
    the curve never runs back in time.
    """
    handles = np.where(np.isnan(curve.handles), automatic_handles(curve.times, curve.values), curve.handles)
    spans = np.diff(curve.times)
    ways = np.stack([np.append(np.inf, spans), np.append(spans, np.inf)], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        fits = np.nan_to_num(np.minimum(1.0, ways / np.abs(handles[:, :, 0])), nan=1.0)
    return Curve(curve.joint, curve.times, curve.values, handles * fits[:, :, None], curve.held)


def _straight(curve: Curve) -> NDArray[np.bool_]:
    """(K - 1,) whether both handles between two keys lie on the line that joins these."""
    slopes = np.diff(curve.values) / np.diff(curve.times)
    handles = np.stack([curve.handles[:-1, AFTER], curve.handles[1:, BEFORE]], axis=1)
    off = np.abs(handles[:, :, 1] - handles[:, :, 0] * slopes[:, None]).max(axis=1)
    return np.asarray(off <= 1e-12)  # noqa: PLR2004  rad


def _bent(curve: Curve) -> NDArray[np.bool_]:
    """(K - 1,) where the curve is more than its keys joined by straight lines."""
    return ~_straight(curve) | curve.held[:-1]


def _ticks(curves: Sequence[Curve], keys: Array) -> Array:
    """Times (T,) s at which `RATE` ticks while some curve is bent, but for those that are as good as a key."""
    wanted = np.zeros(int(np.ceil(keys[-1] * RATE)) + 2, np.int_)
    for curve in curves:
        bent = _bent(curve)
        np.add.at(wanted, np.ceil(curve.times[:-1][bent] * RATE).astype(int), 1)
        np.add.at(wanted, np.floor(curve.times[1:][bent] * RATE).astype(int) + 1, -1)
    ticks = np.flatnonzero(np.cumsum(wanted) > 0) / RATE
    following = np.clip(np.searchsorted(keys, ticks), 1, len(keys) - 1)
    return ticks[np.minimum(ticks - keys[following - 1], keys[following] - ticks) >= NEAR]


def _parameter(share: Array, x1: Array, x2: Array) -> Array:
    """Where (0..1) on Beziers with abscissae 0, x1, x2 and 1 the abscissa is `share`; these never run back."""
    low, high = np.zeros_like(share), np.ones_like(share)
    even = (np.abs(x1 - 1.0 / 3.0) < 1e-9) & (np.abs(x2 - 2.0 / 3.0) < 1e-9)  # noqa: PLR2004
    if even.all():
        return share
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        over = _bezier(middle, 0.0, x1, x2, 1.0) > share
        low, high = np.where(over, low, middle), np.where(over, middle, high)
    return np.where(even, share, (low + high) / 2.0)


def _bezier(u: Array, p0: Array | float, p1: Array, p2: Array, p3: Array | float) -> Array:
    v = 1.0 - u
    return v**3 * p0 + 3.0 * v**2 * u * p1 + 3.0 * v * u**2 * p2 + u**3 * p3
