"""The arm angles within NAO's limits whose segments point nearest to where a person's do.

E_u and E_f are the angles by which upper arm and forearm miss their
directions.  Where the closed form of `arms` is within the limits it is the
answer, and both are 0.  Elsewhere the answer has the least E_u + E_f there is;
their mean was 0.38 deg above that of brute force at most in 9000 random pairs
of directions, 0.03 deg on average:

* The forearm can follow exactly from where the upper arm points nearest: that
  is the answer, for E_u cannot be less.
* Only the bend of the elbow is out of reach, by g: then E_u + E_f cannot be
  less than g, and both segments give way by half of it.
* Otherwise by search (`arm_search`).

Where several answers are about as good, the frame before decides
(`arm_choice`): the arm does not flip to and fro, and passes its singular
postures without a jump.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nao_sim.imitation.arm_choice import TOLERANCE, Choice, choices_of, chosen
from nao_sim.imitation.arm_search import local_minima
from nao_sim.imitation.arms import (
    REST,
    arms_before,
    as_left_arms,
    elbow_of,
    joint_vector,
    last_known,
    on_its_side,
    shoulder_of,
)
from nao_sim.imitation.features import FOREARM, UPPER_ARM
from nao_sim.imitation.reach import (
    EXACT,
    ArmLimits,
    Asked,
    arm_limits,
    nearest_elbow,
    nearest_shoulder,
    upper_arm_error,
)
from nao_sim.robot import Array, Robot

_TOGETHER = 8192  # frames, more would only need more memory
_AHEAD = np.array([[1.0], [0.0], [0.0]])


def feasible_positions(directions: Array, robot: Robot, previous: Array | None = None) -> Array:
    """Both arms' nearest feasible angles in the robot's joint vector, frame after frame.

    Args:
        directions: (T, 2, 2, 3) vectors of any length, as `features.directions_of` returns.
        robot: whose documented limits hold.
        previous: (26,) what each joint was last told before the first frame; 0 where nan.

    Returns:
        (T, 26), nan for every joint but the eight of `ARM_JOINTS`, for an arm
        whose upper arm has no direction, and for an elbow whose forearm has none.
    """
    return joint_vector(_left_arms(as_left_arms(directions), arms_before(previous), arm_limits(robot)))


def feasible_angles(upper_arm: Array, forearm: Array, side: int, robot: Robot, previous: ArrayLike = REST) -> Array:
    """One arm's nearest feasible angles, frame after frame.

    Args:
        upper_arm: (T, 3) directions shoulder to elbow, of any length, torso frame.
        forearm: (T, 3) directions elbow to wrist.
        side: `LEFT` or `RIGHT`.
        robot: whose documented limits hold.
        previous: (4,) rad, what each joint was last told before the first frame; 0 where nan.

    Returns:
        (T, 4) rad, as `arms.arm_angles`, within the limits.
    """
    limits = arm_limits(robot)
    return on_its_side(lambda arms, before: _left_arms(arms, before, limits), upper_arm, forearm, side, previous)


def _left_arms(arms: Array, previous: Array, limits: ArmLimits) -> Array:
    """Left arms (T, A, 2, 3) side by side, after angles (A, 4): (T, A, 4)."""
    angles = np.empty((*arms.shape[:2], 4))
    for first in range(0, len(arms), _TOGETHER):
        block = slice(first, first + _TOGETHER)
        angles[block], previous = _together(arms[block], previous, limits)
    return angles


def _together(arms: Array, previous: Array, limits: ArmLimits) -> tuple[Array, Array]:
    """The angles (T, A, 4) of frames solved together, and the last known ones (A, 4)."""
    frames, abreast = arms.shape[:2]
    (upper_arm, known), (forearm, seen) = _unit(arms[:, :, UPPER_ARM]), _unit(arms[:, :, FOREARM])
    seen &= known
    place = np.flatnonzero(known)
    asked = Asked(upper_arm, np.where(seen, forearm, _AHEAD), seen)[place]
    row = np.full((frames * abreast, 4), np.nan)
    best, choices = _best(asked, limits)
    row[place] = best.T
    row[~seen, 2:] = np.nan
    angles = row.reshape(frames, abreast, 4)
    last = [last_known(mask.reshape(frames, abreast)) for mask in (known, seen)]

    def before(frame: int, arm: int) -> list[float]:
        told: list[float] = previous[arm].tolist()
        for joints, since in zip((slice(0, 2), slice(2, 4)), last, strict=True):
            if since[frame, arm] >= 0:
                told[joints] = angles[since[frame, arm], arm, joints].tolist()
        return told

    for arm, options in choices.items():
        frame, column = divmod(int(place[arm]), abreast)
        angles[frame, column] = chosen(options, asked, arm, before(frame, column), limits)
    return angles, np.array([before(frames, column) for column in range(abreast)])


def _unit(vectors: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Vectors (T, A, 3) as unit vectors (3, T * A), and which of them have a direction."""
    columns = np.ascontiguousarray(vectors.reshape(-1, 3).T)
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        length = np.hypot(np.hypot(columns[0], columns[2]), columns[1])
        return columns / length, np.isfinite(length) & (length > 0.0)


def _best(asked: Asked, limits: ArmLimits) -> tuple[Array, dict[int, list[Choice]]]:
    """The best angles (4, N) of each arm on its own, and what the frame before has to choose from."""
    wanted_pitch, wanted_roll, _ = shoulder_of(asked.upper_arm)
    shoulder = nearest_shoulder(asked.upper_arm, limits)
    yaw, bend, error = nearest_elbow(asked.forearm, shoulder, limits)
    angles = np.stack([*shoulder, yaw, bend])
    settled = (error <= EXACT) | ~asked.seen
    beyond = np.abs(wanted_pitch) > limits.pitch
    if beyond.any():
        settled[beyond] &= ~_tied(asked[beyond], shoulder[:, beyond], limits)
    arguable = settled & (wanted_roll > limits.roll[1])
    missed = np.flatnonzero((error > EXACT) & asked.seen)
    if len(missed):
        angles[:, missed], settled[missed], arguable[missed] = _halved(asked[missed], angles[:, missed], limits)
    arm, lost = np.flatnonzero(arguable), np.flatnonzero(~settled)
    if len(arm) + len(lost) == 0:
        return angles, {}
    found, candidates, ends = _candidates(asked[lost], limits)
    end = np.copysign(1.0, yaw)
    either = arm[np.abs(yaw[arm]) >= limits.yaw]  # ElbowYaw may be at its other end as well
    shoulder = np.concatenate([shoulder[:, arm], shoulder[:, either], candidates], axis=1)
    end = np.concatenate([end[arm], -end[either], ends])
    arm, best, choices = choices_of(asked, np.concatenate([arm, either, lost[found]]), shoulder, end, limits)
    angles[:, arm] = best
    return angles, choices


def _tied(asked: Asked, shoulder: Array, limits: ArmLimits) -> NDArray[np.bool_]:
    """Whether upper arms beyond one end of ShoulderPitch are about as near to its other end."""
    other = nearest_shoulder(asked.upper_arm, limits, -np.sign(shoulder[0]))
    return upper_arm_error(asked.upper_arm, other) <= upper_arm_error(asked.upper_arm, shoulder) + TOLERANCE


def _halved(asked: Asked, angles: Array, limits: ArmLimits) -> tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]:
    """Angles (4, N) in which both segments give way by half of what the elbow is bent too much.

    An elbow too straight keeps its angles: the least bend is the best, but
    ElbowYaw is the frame before's to choose.

    Returns:
        The angles, where they are the answer (N,), and where they are one to choose from (N,).
    """
    bend = elbow_of(asked.forearm, angles[0], angles[1])[1]
    exact = upper_arm_error(asked.upper_arm, angles[:2]) <= EXACT
    half, sine = (bend - limits.bend[1]) / 2.0, np.maximum(np.sin(bend), EXACT)
    upper_arm = (np.sin(bend - half) * asked.upper_arm + np.sin(half) * asked.forearm) / sine
    pitch, roll, _ = shoulder_of(upper_arm)
    yaw = elbow_of(asked.forearm, pitch, roll)[0]
    within = (np.abs(pitch) <= limits.pitch) & (np.abs(yaw) <= limits.yaw) & (sine > EXACT) & (half > 0.0)
    within &= (roll >= limits.roll[0]) & (roll <= limits.roll[1]) & exact
    halved = np.stack([pitch, roll, yaw, np.full(len(bend), -limits.bend[1])])
    straight = bend < limits.bend[0]
    return np.where(within, halved, angles), within | (straight & exact), straight


def _candidates(asked: Asked, limits: ArmLimits) -> tuple[NDArray[np.int_], Array, Array]:
    """Arms (M,), shoulders (2, M), ends (M,): local minima, or for an upper arm alone both ends of ShoulderPitch."""
    seen, alone = np.flatnonzero(asked.seen), np.flatnonzero(~asked.seen)
    arm, shoulder, end = local_minima(asked[seen], limits)
    ends = [nearest_shoulder(asked.upper_arm[:, alone], limits, np.full(len(alone), side)) for side in (1.0, -1.0)]
    arm, end = np.concatenate([seen[arm], alone, alone]), np.concatenate([end, np.zeros(2 * len(alone))])
    return arm, np.concatenate([shoulder, *ends], axis=1), end
