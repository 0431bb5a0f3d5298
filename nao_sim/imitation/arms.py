"""From where a person's arm points to the four angles of NAO's arm, in closed form.

At the zero pose NAO's arm points forward (+x).  With ShoulderPitch p about y,
ShoulderRoll r about z, ElbowYaw w about x and ElbowRoll b about z
(`models/nao_h25/facts.json`), the segments of the left arm point along

    upper arm = Ry(p) Rz(r) x = (cos p cos r, sin r, -sin p cos r)
    forearm   = Ry(p) Rz(r) (cos b, sin b cos w, sin b sin w),   b < 0,

which `atan2` inverts without an edge.  The right arm is the left one in a
mirror.  The elbow axis lies 15 mm beside the upper arm's (ElbowOffsetY): that
moves the elbow, but turns neither direction, and is not in these formulas.

Two angles have no answer where their axis lies along the segment they turn:
ShoulderPitch with the arm along the shoulder axis, ElbowYaw with the elbow
straight or folded on itself.  There the previous frame's angle is kept (0
before the first), and it is eased into the formula over the cone that the
robot's joint limits put out of its reach anyway; inside the robot's reach the
formula is exact.  What to do where an answer is beyond the robot's limits is
for `nao_sim.imitation.feasible`.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nao_sim.imitation.features import LEFT, RIGHT
from nao_sim.robot import Array, load_robot

ARM_JOINTS = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll")
Rule = Callable[[Array, Array], Array]  # arms (T, A, 2, 3) after angles (A, 4), all of them left: (T, A, 4)
REST = (0.0, 0.0, 0.0, 0.0)  # rad, what is kept before the first frame
MIRROR = np.array([1.0, -1.0, 1.0])  # of a direction
MIRROR_ANGLES = np.array([1.0, -1.0, -1.0, -1.0])  # of the four angles, as `Robot.mirror_sign`

_robot = load_robot()
_TURN = float(_robot.upper[_robot.index["LShoulderPitch"]])  # rad, ShoulderPitch and ElbowYaw reach this far
_OUT_OF_REACH = (
    math.cos(_robot.upper[_robot.index["LShoulderRoll"]]),  # sine of the widest angle to the shoulder axis
    math.sin(-_robot.upper[_robot.index["LElbowRoll"]]),  # sine of the least bend of the elbow
)
_SIDES = [[_robot.index[letter + name] for name in ARM_JOINTS] for letter in "LR"]  # joints by `LEFT`, `RIGHT`


def arm_angles(upper_arm: Array, forearm: Array, side: int, previous: ArrayLike = REST) -> Array:
    """The arm angles that point the robot's arm as the person's, frame after frame.

    Args:
        upper_arm: (T, 3) directions shoulder to elbow, of any length, torso
            frame (x forward, y left, z up).
        forearm: (T, 3) directions elbow to wrist.
        side: `LEFT` or `RIGHT`.
        previous: (4,) rad, the angles of the frame before the first; 0 where nan.

    Returns:
        (T, 4) rad: ShoulderPitch, ShoulderRoll, ElbowYaw, ElbowRoll with NAOqi
        signs and without its limits; nan where a direction is not finite or
        has no length.  ShoulderPitch and ElbowYaw go on past half a turn, into
        the angles that no NAO reaches, until the joint's other end is nearer.
    """
    return on_its_side(left_arm_angles, upper_arm, forearm, side, previous)


def arm_positions(directions: Array, previous: Array | None = None) -> Array:
    """Both arms' angles in the robot's joint vector.

    Args:
        directions: (T, 2, 2, 3), as `features.directions_of` returns.
        previous: (26,) the frame before the first.

    Returns:
        (T, 26), nan for every joint but the eight of `ARM_JOINTS`.
    """
    return joint_vector(left_arm_angles(as_left_arms(directions), arms_before(previous)))


def arm_directions_of(positions: Array) -> Array:
    """Where the robot's arms point, the formulas above.

    Args:
        positions: (T, 26) in the joint vector's units.

    Returns:
        (T, 2, 2, 3) unit vectors, side, segment, coordinate, as
        `features.directions_of` returns; nan where a joint that turns the
        segment is not finite.
    """
    angles = np.where(np.isfinite(positions), positions, np.nan)[:, _SIDES]
    angles[:, RIGHT] *= MIRROR_ANGLES
    pitch, roll, yaw, bend = np.moveaxis(angles, -1, 0)
    bent = (np.cos(bend), np.sin(bend) * np.cos(yaw), np.sin(bend) * np.sin(yaw))
    upper_arm = np.stack(turned_out((1.0, 0.0, 0.0), pitch, roll), axis=-1)
    directions = np.stack([upper_arm, np.stack(turned_out(bent, pitch, roll), axis=-1)], axis=2)
    directions[:, RIGHT] *= MIRROR
    return directions


def direction_error(positions: Array, directions: Array) -> Array:
    """Angles between where the robot's arms point and where they should.

    Args:
        positions: (T, 26) in the joint vector's units.
        directions: (T, 2, 2, 3) vectors of any length.

    Returns:
        (T, 2, 2) rad, side and segment; nan where one of the two is not known.
    """
    return angle_between(arm_directions_of(positions), directions)


def angle_between(one: Array, other: Array) -> Array:
    """Angle (...) rad between vectors (..., 3) of any length; nan where one has none or is not finite.

    atan2(|a x b|, a . b): exact near 0 and pi, where acos is not.
    """
    with np.errstate(invalid="ignore"):  # 0 / 0 and inf / inf are the nan that is wanted
        one = one / np.max(np.abs(one), axis=-1, keepdims=True)
        other = other / np.max(np.abs(other), axis=-1, keepdims=True)
        across: Array = np.linalg.norm(np.cross(one, other), axis=-1)
        return np.arctan2(across, np.sum(one * other, axis=-1))


def on_its_side(rule: Rule, upper_arm: Array, forearm: Array, side: int, previous: ArrayLike) -> Array:
    """What a rule for left arms says of one arm, on its own side or in a mirror."""
    mirror, signs = (MIRROR, MIRROR_ANGLES) if side == RIGHT else (np.ones(3), np.ones(4))
    arm = np.stack([np.asarray(upper_arm, float), np.asarray(forearm, float)], axis=1)[:, None] * mirror
    before = np.asarray(previous, float)[None] * signs
    return rule(arm, _known_or_rest(before))[:, 0] * signs


def as_left_arms(directions: Array) -> Array:
    """The arms (T, 2, 2, 3) with the right one mirrored into a left one."""
    directions = np.array(directions, float)
    directions[:, RIGHT] *= MIRROR
    return directions


def arms_before(previous: Array | None) -> Array:
    """The angles (2, 4) of both arms, as left arms, in the joint vector before the first frame; 0 where nan."""
    if previous is None:
        return np.tile(REST, (2, 1))
    before = np.asarray(previous, float)[_SIDES]
    before[RIGHT] *= MIRROR_ANGLES
    return _known_or_rest(before)


def joint_vector(angles: Array) -> Array:
    """Both arms' angles (T, 2, 4), as left arms, in the joint vector (T, 26); nan for every other joint."""
    positions = np.full((len(angles), len(_robot.joint_names)), np.nan)
    positions[:, _SIDES[LEFT]] = angles[:, LEFT]
    positions[:, _SIDES[RIGHT]] = angles[:, RIGHT] * MIRROR_ANGLES
    return positions


def left_arm_angles(arms: Array, previous: Array) -> Array:
    """`arm_angles` of left arms (T, A, 2, 3) side by side, after angles (A, 4): (T, A, 4)."""
    upper_arm, forearm = np.moveaxis(arms, (2, 3), (0, 1))
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        pitch, roll, off_axis = shoulder_of(upper_arm)
        length = np.hypot(off_axis, upper_arm[1])
        known = np.isfinite(length) & (length > 0.0)
        pitch = _followed(pitch, off_axis / length / _OUT_OF_REACH[0], known, previous[:, 0])
        yaw, bend, length, across = elbow_of(forearm, pitch, roll)
        bent = known & np.isfinite(length) & (length > 0.0)
        yaw = _followed(yaw, across / length / _OUT_OF_REACH[1], bent, previous[:, 2])
    roll, bend = np.where(known, roll, np.nan), np.where(bent, -bend, np.nan)
    return np.stack([pitch, roll, yaw, bend], axis=-1)


def shoulder_of(upper_arm: Array) -> tuple[Array, Array, Array]:
    """ShoulderPitch and ShoulderRoll of upper arms (3, ...), and how far they are off the shoulder axis."""
    x, y, z = upper_arm
    off_axis = np.hypot(x, z)
    return np.arctan2(-z, x), np.arctan2(y, off_axis), off_axis


def elbow_of(forearm: Array, pitch: Array | float, roll: Array | float) -> tuple[Array, Array, Array, Array]:
    """ElbowYaw, bend (minus ElbowRoll), length, and part across the upper arm of forearms (3, ...)."""
    x, y, z = turned_in(forearm, pitch, roll)
    across = np.hypot(y, z)
    return np.arctan2(-z, -y), np.arctan2(across, x), np.hypot(across, x), across


def turned_in(direction: Array, pitch: Array | float, roll: Array | float) -> tuple[Array, Array, Array]:
    """Rz(-roll) Ry(-pitch) direction (3, ...): as the upper arm sees it."""
    x, y, z = direction
    cos_pitch, sin_pitch, cos_roll, sin_roll = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    ahead = cos_pitch * x - sin_pitch * z
    return cos_roll * ahead + sin_roll * y, cos_roll * y - sin_roll * ahead, sin_pitch * x + cos_pitch * z


def turned_out(direction: tuple[ArrayLike, ArrayLike, ArrayLike], pitch: Array, roll: Array) -> tuple[Array, ...]:
    """Ry(pitch) Rz(roll) direction: the way back of `turned_in`."""
    x, y, z = (np.asarray(coordinate, float) for coordinate in direction)
    ahead, left = np.cos(roll) * x - np.sin(roll) * y, np.sin(roll) * x + np.cos(roll) * y
    return np.cos(pitch) * ahead + np.sin(pitch) * z, left, np.cos(pitch) * z - np.sin(pitch) * ahead


def last_known(known: NDArray[np.bool_]) -> NDArray[np.int_]:
    """The latest frame before each, and before the one after the last, in which `known` (T, A) holds: (T + 1, A).

    -1 where there is none.
    """
    latest = np.full((len(known) + 1, known.shape[1]), -1)
    np.maximum.accumulate(np.where(known, np.arange(len(known))[:, None], -1), axis=0, out=latest[1:])
    return latest


def _known_or_rest(angles: Array) -> Array:
    return np.where(np.isfinite(angles), angles, 0.0)


def _followed(angle: Array, trust: Array, known: NDArray[np.bool_], before: Array) -> Array:
    """Angles (T, A), each following the last known one; `before` (A,) is the one before the first.

    Only where the formula is not trusted, or leads past the joint's end, does the last angle matter.
    """
    angle = np.where(known, angle, np.nan)
    led = known & ((trust < 1.0) | (np.abs(angle) >= _TURN))
    if not led.any():
        return angle
    last = last_known(known)
    for frame, arm in zip(*np.nonzero(led), strict=True):
        since = last[frame, arm]
        previous = angle[since, arm] if since >= 0 else before[arm]
        angle[frame, arm] = _follow(float(angle[frame, arm]), float(previous), float(trust[frame, arm]))
    return angle


def _follow(angle: float, previous: float, trust: float) -> float:
    """Go from `previous` towards `angle` the short way, the whole way from trust 1 up.

    The weight 3 t^2 - 2 t^3 is smooth at both ends, so the angle is as well.
    """
    trust = min(trust, 1.0)
    weight = trust * trust * (3.0 - 2.0 * trust)
    angle = previous + weight * math.remainder(angle - previous, math.tau)
    return angle - math.copysign(math.tau, angle) if abs(angle) > math.tau - _TURN else angle
