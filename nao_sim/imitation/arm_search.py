"""The shoulder angles that bring both segments of an arm nearest to where they should point.

Given ShoulderPitch p and ShoulderRoll r, the nearest that the elbow can do is
known in closed form (`reach.nearest_elbow`): ElbowYaw and ElbowRoll are longitude and
colatitude of the forearm about the upper arm, and their limits cut a
rectangle out of that sphere.  What is left is a search in p and r for the
least of

    F = h(E_u) + h(E_f),   h(E) = sqrt(E^2 + e^2) + c E^2,   e = 0.75 deg, c = 0.01 / rad,

with E_u and E_f the angles that upper arm and forearm miss their directions
by.  F is the sum of the two angles made smooth: the sum itself has edges and
flat valleys in which its minimum jumps about.  Over 6000 random pairs of
directions out of reach, and brute force in p and r, the mean
of the two angles at the minimum of F is 0.03 deg above the least possible
one, 0.12 deg at most; at the minimum of E_u^2 + E_f^2 it is 1.1 deg above it,
13.6 deg at most.

Newton's method starts from the local minima on a grid of 152 shoulder postures
and from the nearest place of the upper arm alone; all arms go at once, each
on its own, so that an arm's answer does not depend on its neighbours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from nao_sim.imitation.arms import elbow_of, turned_in
from nao_sim.imitation.features import FOREARM, UPPER_ARM
from nao_sim.imitation.reach import ArmLimits, Asked, nearest_elbow, nearest_shoulder, upper_arm_error
from nao_sim.robot import Array, read_only

_EDGE = math.radians(0.75)  # e, rad: where h turns from a parabola into a line
_BOWL = 0.01  # c, 1/rad: keeps valleys of equal sum from being flat
_GRID = (19, 8)  # shoulder postures that a search starts from
_MARGIN = math.radians(10.0)  # rad, what a start may lie above the best one
_TIED = math.radians(3.0)  # rad, what one end of ElbowYaw may lie above the other to be tried as well
_TOGETHER, _GRID_TOGETHER = 1024, 128  # arms at a time: what they need stays in the processor's cache
_TRUST = 0.2  # rad, first step
_STEEP = 1e-2  # least curvature that a step believes
_STEPS, _DONE = 40, 1e-5  # most steps, and the length (rad) of the last one
_TINY = 1e-12


@dataclass(frozen=True, eq=False)
class _Grid:
    """Shoulder postures (2, G) and the axes (3, G) of the upper arm's frame there."""

    shoulder: Array
    x: Array
    y: Array
    z: Array


def local_minima(asked: Asked, limits: ArmLimits) -> tuple[NDArray[np.int_], Array, Array]:
    """Shoulder angles at which F is least around, for each arm.

    A forearm that is about as far beyond one end of ElbowYaw as beyond the
    other has a minimum for either.

    Args:
        asked: of N left arms, all forearms known.
        limits: what the arm can do.

    Returns:
        Which arm (M,); ShoulderPitch and ShoulderRoll (2, M) rad; 1 or -1 (M,)
        for the end of ElbowYaw.  Every arm has one at least.
    """
    found = [_minima(asked[block], limits) for block in _blocks(len(asked.seen), _TOGETHER)]
    arms = [arm + block * _TOGETHER for block, (arm, _, _) in enumerate(found)]
    return (
        np.concatenate([np.empty(0, np.int_), *arms]),
        np.concatenate([np.empty((2, 0)), *(shoulder for _, shoulder, _ in found)], axis=1),
        np.concatenate([np.empty(0), *(end for _, _, end in found)]),
    )


def _minima(asked: Asked, limits: ArmLimits) -> tuple[NDArray[np.int_], Array, Array]:
    arm, start = _starts(asked, limits)
    shoulder = _descend(start, asked[arm], limits)
    yaw = elbow_of(asked.forearm[:, arm], *shoulder)[0]
    end = np.where(yaw < 0.0, -1.0, 1.0)
    beyond = np.flatnonzero(np.abs(yaw) > limits.yaw)
    if not len(beyond):
        return arm, shoulder, end
    here, there = (
        nearest_elbow(asked.forearm[:, arm[beyond]], shoulder[:, beyond], limits, side)[2]
        for side in (end[beyond], -end[beyond])
    )
    tied = beyond[there <= here + _TIED]
    if not len(tied):
        return arm, shoulder, end
    other = _descend(shoulder[:, tied], asked[arm[tied]], limits, -end[tied])
    return (
        np.concatenate([arm, arm[tied]]),
        np.concatenate([shoulder, other], axis=1),
        np.concatenate([end, -end[tied]]),
    )


@cache
def _grid(limits: ArmLimits) -> _Grid:
    ends = np.linspace(-limits.pitch, limits.pitch, _GRID[0]), np.linspace(*limits.roll, _GRID[1])
    shoulder = np.reshape(np.meshgrid(*ends, indexing="ij"), (2, -1))
    columns = [turned_in(unit[:, None], *shoulder) for unit in np.eye(3)]  # of the turn into the upper arm's frame
    x, y, z = np.swapaxes(columns, 0, 1)
    return _Grid(read_only(shoulder), read_only(x), read_only(y), read_only(z))


def _grid_errors(asked: Asked, limits: ArmLimits) -> Array:
    """E_u + E_f (N, G); the few degrees that an elbow cannot be straight are left out."""
    grid = _grid(limits)
    x, y, z = (_dots(asked.forearm, axis) for axis in (grid.x, grid.y, grid.z))
    cos_yaw, sin_yaw = math.cos(limits.yaw), math.sin(limits.yaw)
    cos_bend, sin_bend = math.cos(limits.bend[1]), math.sin(limits.bend[1])
    across = np.sqrt(y * y + z * z)
    across = np.where(-y < cos_yaw * across, sin_yaw * np.abs(z) - cos_yaw * y, across)  # along the end's meridian
    in_reach = np.where(across > 0.0, np.sqrt(x * x + across * across), x)
    cosine = np.where(x * sin_bend < across * cos_bend, x * cos_bend + across * sin_bend, in_reach)
    shoulder = np.minimum(np.maximum(_dots(asked.upper_arm, grid.x), -1.0), 1.0)
    return np.arccos(shoulder) + np.arccos(np.minimum(cosine, 1.0))


def _dots(vectors: Array, axes: Array) -> Array:
    """Vectors (3, N) by axes (3, G): (N, G).  Not a matrix product, whose last digit may depend on N."""
    (x, y, z), (a, b, c) = vectors[:, :, None], axes
    return x * a + y * b + z * c


def _lowest_around(asked: Asked, limits: ArmLimits) -> tuple[NDArray[np.bool_], Array]:
    """The grid's local minima (N, G) that come near its least E_u + E_f, and the limit (N,) of that."""
    count = len(asked.seen)
    padded = np.full((count, _GRID[0] + 2, _GRID[1] + 2), np.inf)
    errors = padded[:, 1:-1, 1:-1]
    errors[:] = _grid_errors(asked, limits).reshape(errors.shape)
    beside = np.minimum(padded[:, :-2, 1:-1], padded[:, 2:, 1:-1])
    beside = np.minimum(beside, np.minimum(padded[:, 1:-1, :-2], padded[:, 1:-1, 2:]))
    worst: Array = errors.min(axis=(1, 2)) + _MARGIN
    return ((errors <= beside) & (errors <= worst[:, None, None])).reshape(count, -1), worst


def _starts(asked: Asked, limits: ArmLimits) -> tuple[NDArray[np.int_], Array]:
    """Arms (M,) and shoulder angles (2, M) from which to search."""
    parts = [_lowest_around(asked[block], limits) for block in _blocks(len(asked.seen), _GRID_TOGETHER)]
    lowest, worst = (np.concatenate(column) for column in zip(*parts, strict=True))
    arm, place = np.nonzero(lowest)
    alone = nearest_shoulder(asked.upper_arm, limits)
    error = upper_arm_error(asked.upper_arm, alone) + nearest_elbow(asked.forearm, alone, limits)[2]
    also = np.flatnonzero(error <= worst)
    return np.concatenate([arm, also]), np.concatenate([_grid(limits).shoulder[:, place], alone[:, also]], axis=1)


def _blocks(count: int, size: int) -> list[slice]:
    return [slice(first, first + size) for first in range(0, count, size)]


def _descend(shoulder: Array, asked: Asked, limits: ArmLimits, end: Array | None = None) -> Array:
    """The local minima of F (2, M) by Newton's method from shoulder angles (2, M); `end` as for `nearest_elbow`.

    Where the slope leads out of the limits, that joint stays at its end.  Steps
    are kept within a radius that grows with every step down and shrinks with
    every step up.
    """
    segments = np.stack([asked.upper_arm, asked.forearm], axis=1)
    found = np.empty(shoulder.shape)
    at, radius = np.arange(shoulder.shape[1]), np.full(shoulder.shape[1], _TRUST)
    here = _model(shoulder[0], shoulder[1], segments, limits, end)
    for _ in range(_STEPS):
        by_pitch, by_roll = _step(here, limits)
        length = np.sqrt(by_pitch * by_pitch + by_roll * by_roll)
        share = np.minimum(1.0, radius / np.maximum(length, _TINY))
        length = share * length
        pitch = np.minimum(np.maximum(here[6] + share * by_pitch, -limits.pitch), limits.pitch)
        roll = np.minimum(np.maximum(here[7] + share * by_roll, limits.roll[0]), limits.roll[1])
        there = _model(pitch, roll, segments, limits, end)
        down = there[0] <= here[0]
        radius = np.where(down, np.maximum(radius, 2.0 * length), length / 4.0)
        here = np.where(down, there, here)
        found[:, at] = here[6:]
        on = length > _DONE
        if not on.any():
            break
        if not on.all():
            here, radius, at, segments = here[:, on], radius[on], at[on], segments[:, :, on]
            end = None if end is None else end[on]
    return found


def _step(model: Array, limits: ArmLimits) -> tuple[Array, Array]:
    """Minus the slope by the curvature, with the curvature's two principal values taken positive."""
    _, by_pitch, by_roll, a, b, c, pitch, roll = model
    free_pitch = np.where(by_pitch > 0.0, pitch > -limits.pitch, pitch < limits.pitch)
    free_roll = np.where(by_roll > 0.0, roll > limits.roll[0], roll < limits.roll[1])
    by_pitch, by_roll, b = by_pitch * free_pitch, by_roll * free_roll, b * (free_pitch & free_roll)
    mean, half = (a + c) / 2.0, (a - c) / 2.0
    apart = np.sqrt(half * half + b * b) + _TINY
    one = 0.5 / np.maximum(np.abs(mean + apart), _STEEP)
    other = 0.5 / np.maximum(np.abs(mean - apart), _STEEP)
    same, turn = -one - other, (other - one) / apart
    turn_half, turn_b = turn * half, turn * b
    return (same + turn_half) * by_pitch + turn_b * by_roll, (same - turn_half) * by_roll + turn_b * by_pitch


def _model(pitch: Array, roll: Array, segments: Array, limits: ArmLimits, end: Array | None = None) -> Array:
    """F, its slopes by p and r, its second derivatives by pp, pr and rr, and p and r themselves: (8, N).

    A shoulder turning by (dp, dr) turns a segment d, as the upper arm sees it,
    by the angular velocity -(a dp + z dr), a = (sin r, cos r, 0).  With the
    unit normal n of d and its aim, and t = d x n, the angle E between them has

        E_p = a.n,  E_r = n_z,  E_pp = (a.t) (k a.t + a.d),  E_pr = (a.t) (k t_z + d_z),  E_rr = t_z (k t_z + d_z),

    k being the curvature, across the way to the aim, of the distance on the
    sphere to what the aim is the nearest point of.

    Args:
        pitch: (N,) rad.
        roll: (N,) rad.
        segments: (3, 2, N) unit vectors, `UPPER_ARM` and `FOREARM`, torso frame.
        limits: what the arm can do.
        end: (N,) as for `nearest_elbow`.
    """
    sin_roll, cos_roll = np.sin(roll), np.cos(roll)
    x, y, z = turned_in(segments, pitch, roll)
    (aim_x, aim_y, aim_z), in_reach, on_meridian = _aims(x[FOREARM], y[FOREARM], z[FOREARM], limits, end)
    normal_x, normal_y, normal_z = y * aim_z - z * aim_y, z * aim_x - x * aim_z, x * aim_y - y * aim_x
    sine = np.sqrt(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z)
    cosine = x * aim_x + y * aim_y + z * aim_z
    error, sine = np.arctan2(sine, cosine), np.maximum(sine, _TINY)
    k = cosine / sine  # cot E, to a point
    great = -sine[FOREARM] / np.maximum(cosine[FOREARM], _TINY)  # -tan E, to a great circle
    small = x[FOREARM] / np.maximum(np.sqrt(y[FOREARM] ** 2 + z[FOREARM] ** 2), _TINY)  # cot bend, to a small circle
    k[FOREARM] = np.where(in_reach, small, np.where(on_meridian, great, k[FOREARM]))
    normal_x, normal_y, by_roll = normal_x / sine, normal_y / sine, normal_z / sine
    by_pitch = sin_roll * normal_x + cos_roll * normal_y
    t_pitch = sin_roll * (y * by_roll - z * normal_y) + cos_roll * (z * normal_x - x * by_roll)
    t_roll = x * normal_y - y * normal_x
    root = np.sqrt(error * error + _EDGE * _EDGE)
    slope, bow = error / root + 2.0 * _BOWL * error, _EDGE * _EDGE / (root * root * root) + 2.0 * _BOWL
    along_pitch, along_roll = slope * (k * t_pitch + sin_roll * x + cos_roll * y), slope * (k * t_roll + z)
    shares = np.zeros((8, *x.shape))
    shares[0] = root + _BOWL * error * error
    shares[1], shares[2] = slope * by_pitch, slope * by_roll
    shares[3] = t_pitch * along_pitch + bow * by_pitch * by_pitch
    shares[4] = t_pitch * along_roll + bow * by_pitch * by_roll
    shares[5] = t_roll * along_roll + bow * by_roll * by_roll
    model: Array = shares[:, UPPER_ARM] + shares[:, FOREARM]
    model[6:] = pitch, roll
    return model


def _aims(
    x: Array, y: Array, z: Array, limits: ArmLimits, end: Array | None
) -> tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]:
    """What the segments (N,) as the upper arm sees them can reach at best: `reach.nearest_elbow` without its angles.

    Returns:
        (3, 2, N) unit vectors, and where the forearm is within the reach of
        ElbowYaw (N,) and of ElbowRoll (N,).
    """
    across = np.maximum(np.sqrt(y * y + z * z), _TINY)
    cos_yaw, sin_yaw = math.cos(limits.yaw), math.sin(limits.yaw)
    in_reach = -y >= cos_yaw * across
    side = np.where(in_reach, y / across, -cos_yaw)
    up = np.where(in_reach, z / across, np.copysign(sin_yaw, z) if end is None else -sin_yaw * end)
    bend = np.arctan2(y * side + z * up, x)
    fitted = np.minimum(np.maximum(bend, limits.bend[0]), limits.bend[1])
    sin_bend = np.sin(fitted)
    aims = np.zeros((3, 2, len(x)))
    aims[0, UPPER_ARM] = 1.0
    aims[0, FOREARM], aims[1, FOREARM], aims[2, FOREARM] = np.cos(fitted), sin_bend * side, sin_bend * up
    return aims, in_reach, bend == fitted
