"""Which of several answers an arm takes: the one nearest to the frame before.

The best answer is not always one.  An arm behind the back is as near to one
end of ShoulderPitch as to the other, a forearm that cannot turn out any
further as near to one end of ElbowYaw as to the other.  With the upper arm
along the shoulder axis ShoulderPitch hardly matters, with the elbow straight
ElbowYaw.  Of all answers that cost next to nothing more than the best
(`TOLERANCE`), the one nearest to the frame before is taken; as the direction
comes into the robot's reach, next to nothing becomes nothing.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nao_sim.imitation.arms import elbow_of, shoulder_of
from nao_sim.imitation.reach import EXACT, ArmLimits, Asked, nearest_elbow, upper_arm_error
from nao_sim.robot import Array

TOLERANCE = math.radians(0.55)  # rad, what an answer may cost more than the best: the sum of both segments' errors
_RISE_SHOULDER, _RISE_ELBOW = 0.1, 0.25  # and at most this share of what roll, or bend, is out of reach by
_PLACES = 49  # along ShoulderPitch, at which an arm near the shoulder axis is tried


class Choice(NamedTuple):
    """One answer to choose.

    Attributes:
        angles: rad, of ShoulderPitch, ShoulderRoll, ElbowYaw and ElbowRoll; the elbow's nan for an upper arm alone.
        low: rad, ShoulderPitch may as well be anywhere from here
        high: rad, to here.
        level: rad, the most that a straight elbow may cost.
    """

    angles: list[float]
    low: float
    high: float
    level: float


def choices_of(
    asked: Asked, arm: NDArray[np.int_], shoulder: Array, end: Array, limits: ArmLimits
) -> tuple[NDArray[np.int_], Array, dict[int, list[Choice]]]:
    """The answers that shoulders (2, M) of arms (M,) lead to, with ElbowYaw, if too far, at `end` (M,).

    Returns:
        The arms (K,), the best angles (4, K) of each, and the choices of those
        arms that have one: where several answers are about as good, where the
        upper arm is so near to the shoulder axis that ShoulderRoll does not
        reach as far, where the elbow is straighter than it can be.
    """
    elbow, error = _answers(asked[arm], shoulder, limits, end)
    order = np.lexsort((error, arm))
    arm, error, angles = arm[order], error[order], np.concatenate([shoulder, elbow])[:, order]
    first = np.searchsorted(arm, arm)
    best = np.flatnonzero(first == np.arange(len(arm)))
    near = np.flatnonzero(error <= error[first] + TOLERANCE)
    return arm[best], angles[:, best], _open(asked, arm[near], angles[:, near], error[first[near]], limits)


def chosen(choices: list[Choice], asked: Asked, arm: int, before: list[float], limits: ArmLimits) -> list[float]:
    """The angles nearest to those before that the choices of an arm allow."""
    joints = 4 if asked.seen[arm] else 2
    adapted = [_adapted(choice, asked, arm, before, limits) for choice in choices]
    return min(adapted, key=lambda angles: math.dist(angles[:joints], before[:joints]))


def _adapted(choice: Choice, asked: Asked, arm: int, before: list[float], limits: ArmLimits) -> list[float]:
    """A choice's angles, brought as near to those before as it allows."""
    pitch, (_, roll, yaw, bend) = max(choice.low, min(before[0], choice.high)), choice.angles
    if math.isnan(yaw):
        return [pitch, roll, yaw, bend]
    if pitch != choice.angles[0]:
        yaw, bend = map(float, nearest_elbow(asked.forearm[:, arm], (pitch, roll), limits, math.copysign(1.0, yaw))[:2])
    if bend == -limits.bend[0]:
        wanted, straighter, _, _ = map(float, elbow_of(asked.forearm[:, arm], pitch, roll))
        allowed = choice.level - float(upper_arm_error(asked.upper_arm[:, arm], (pitch, roll)))
        yaw = _yaw_of_straight_elbow(wanted, straighter, allowed, yaw, before[2], limits)
    return [pitch, roll, yaw, bend]


def _end(yaw: Array) -> Array:
    return np.where(yaw < 0.0, -1.0, 1.0)


def _answers(asked: Asked, shoulder: Array, limits: ArmLimits, end: Array) -> tuple[Array, Array]:
    """ElbowYaw and ElbowRoll (2, ...), nan for an upper arm alone, and the sum (...) of both segments' errors."""
    seen = asked.seen.reshape(-1, *[1] * (shoulder.ndim - 2))
    upper_arm, forearm = asked.upper_arm.reshape(3, *seen.shape), asked.forearm.reshape(3, *seen.shape)
    *elbow, error = nearest_elbow(forearm, shoulder, limits, end)
    return np.where(seen, np.stack(elbow), np.nan), upper_arm_error(upper_arm, shoulder) + np.where(seen, error, 0.0)


def _open(
    asked: Asked, arm: NDArray[np.int_], angles: Array, best: Array, limits: ArmLimits
) -> dict[int, list[Choice]]:
    """The choices of those arms that have one, of angles (4, M) for arms (M,) whose best error is (M,)."""
    arms = asked[arm]
    bend = elbow_of(arms.forearm, angles[0], angles[1])[1]
    over = shoulder_of(arms.upper_arm)[1] - limits.roll[1]
    low, high = angles[0].copy(), angles[0].copy()
    axial = np.flatnonzero(over > 0.0)
    if len(axial):
        level = best[axial] + np.minimum(TOLERANCE, _RISE_SHOULDER * over[axial])
        low[axial], high[axial] = _reach_of_pitch(arms[axial], angles[:, axial], level, limits)
    missing = np.maximum(limits.bend[0] - bend, 0.0)
    least = np.where(upper_arm_error(arms.upper_arm, angles[:2]) <= EXACT, missing, best)  # no answer can have less
    level = least + np.minimum(TOLERANCE, _RISE_ELBOW * missing)
    choices: dict[int, list[Choice]] = {}
    straight = arms.seen & (missing > 0.0)
    for i in np.flatnonzero((np.bincount(arm)[arm] > 1) | (over > 0.0) | straight).tolist():
        choice = Choice(angles[:, i].tolist(), float(low[i]), float(high[i]), float(level[i]))
        choices.setdefault(int(arm[i]), []).append(choice)
    return choices


def _reach_of_pitch(asked: Asked, angles: Array, level: Array, limits: ArmLimits) -> tuple[Array, Array]:
    """How far ShoulderPitch can go from angles (4, M), and the elbow with it, before the error exceeds a level (M,)."""
    places = np.linspace(-limits.pitch, limits.pitch, _PLACES)
    shoulder = np.stack(np.broadcast_arrays(places, angles[1][:, None]))
    errors = _answers(asked, shoulder, limits, _end(angles[2])[:, None])[1]
    at = _answers(asked, angles[:2], limits, _end(angles[2]))[1]
    high = _first_beyond(angles[0], at, places, errors, level)
    return -_first_beyond(-angles[0], at, places, errors[:, ::-1], level), high  # the places are symmetrical


def _first_beyond(start: Array, at: Array, places: Array, errors: Array, level: Array) -> Array:
    """Where errors (M, K) at places (K,), linear between, first exceed a level (M,) from a start (M,) on."""
    beyond = (places > start[:, None]) & (errors > level[:, None])
    row, place = np.arange(len(start)), beyond.argmax(axis=1)
    before = np.maximum(place - 1, 0)
    inside = places[before] > start
    since, error = np.where(inside, places[before], start), np.where(inside, errors[row, before], at)
    rise = np.maximum(errors[row, place] - error, 1e-12)
    share = np.minimum(np.maximum((level - error) / rise, 0.0), 1.0)
    return np.where(beyond.any(axis=1), since + share * (places[place] - since), places[-1])


def _yaw_of_straight_elbow(
    wanted: float, bend: float, allowed: float, nearest: float, before: float, limits: ArmLimits
) -> float:
    """ElbowYaw next to the one before: the nearest, or one with which the forearm misses no more than allowed.

    At the least bend c and a yaw by d off the wanted one it misses by E,
    sin^2(E/2) = sin^2((c - bend)/2) + sin c sin bend sin^2(d/2).
    """
    least = limits.bend[0]
    room = math.sin(allowed / 2.0) ** 2 - math.sin((least - bend) / 2.0) ** 2
    lever = math.sin(least) * math.sin(bend)
    if room <= 0.0:
        return nearest
    apart = 2.0 * math.asin(math.sqrt(room / lever)) if room < lever else math.pi
    options = [nearest]
    for turn in (-math.tau, 0.0, math.tau):
        low, high = max(wanted + turn - apart, -limits.yaw), min(wanted + turn + apart, limits.yaw)
        if low <= high:
            options.append(max(low, min(before, high)))
    return min(options, key=lambda yaw: abs(yaw - before))
