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
formula is exact.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from nao_sim.imitation.features import FOREARM, LEFT, RIGHT, UPPER_ARM
from nao_sim.robot import Array, load_robot

ARM_JOINTS = ("ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll")
_MIRROR = np.array([1.0, -1.0, -1.0, -1.0])  # of the four angles, as `Robot.mirror_sign`
_REST = (0.0, 0.0, 0.0, 0.0)

_robot = load_robot()
_TURN = float(_robot.upper[_robot.index["LShoulderPitch"]])  # rad, ShoulderPitch and ElbowYaw reach this far
_OUT_OF_REACH = (
    math.cos(_robot.upper[_robot.index["LShoulderRoll"]]),  # sine of the widest angle to the shoulder axis
    math.sin(-_robot.upper[_robot.index["LElbowRoll"]]),  # sine of the least bend of the elbow
)


def arm_angles(upper_arm: Array, forearm: Array, side: int, previous: ArrayLike = _REST) -> Array:
    """The arm angles that point the robot's arm as the person's, frame after frame.

    Args:
        upper_arm: (T, 3) directions shoulder to elbow, of any length, torso
            frame (x forward, y left, z up).
        forearm: (T, 3) directions elbow to wrist.
        side: `LEFT` or `RIGHT`.
        previous: (4,) rad, the angles of the frame before the first.

    Returns:
        (T, 4) rad: ShoulderPitch, ShoulderRoll, ElbowYaw, ElbowRoll with NAOqi
        signs and without its limits; nan where a direction is not finite or
        has no length.  ShoulderPitch and ElbowYaw go on past half a turn, into
        the angles that no NAO reaches, until the joint's other end is nearer.
    """
    mirror = np.array([1.0, -1.0 if side == RIGHT else 1.0, 1.0])
    signs = _MIRROR if side == RIGHT else np.ones(4)
    state = np.asarray(previous, float) * signs
    angles = np.empty((len(upper_arm), 4))
    for frame, (upper, fore) in enumerate(zip(upper_arm * mirror, forearm * mirror, strict=True)):
        angles[frame] = _left_arm(upper, fore, state)
        state = np.where(np.isfinite(angles[frame]), angles[frame], state)
    return angles * signs


def arm_positions(directions: Array, previous: Array | None = None) -> Array:
    """Both arms' angles in the robot's joint vector.

    Args:
        directions: (T, 2, 2, 3), as `features.directions_of` returns.
        previous: (26,) the frame before the first.

    Returns:
        (T, 26), nan for every joint but the eight of `ARM_JOINTS`.
    """
    robot = load_robot()
    positions = np.full((len(directions), len(robot.joint_names)), np.nan)
    for side, letter in ((LEFT, "L"), (RIGHT, "R")):
        joints = [robot.index[letter + name] for name in ARM_JOINTS]
        before = _REST if previous is None else previous[joints]
        positions[:, joints] = arm_angles(directions[:, side, UPPER_ARM], directions[:, side, FOREARM], side, before)
    return positions


def _left_arm(upper: Array, forearm: Array, previous: Array) -> tuple[float, float, float, float]:
    """One frame of the left arm."""
    x, y, z = upper.tolist()
    length = math.sqrt(x * x + y * y + z * z)
    if not (math.isfinite(length) and length > 0.0):
        return math.nan, math.nan, math.nan, math.nan
    off_axis = math.hypot(x, z)
    pitch = _follow(math.atan2(-z, x), float(previous[0]), off_axis / length / _OUT_OF_REACH[0])
    roll = math.atan2(y, off_axis)
    return pitch, roll, *_left_elbow(_in_upper_arm(forearm, pitch, roll), float(previous[2]))


def _left_elbow(forearm: tuple[float, float, float], previous: float) -> tuple[float, float]:
    """ElbowYaw and ElbowRoll from the forearm's direction in the upper arm's frame."""
    x, y, z = forearm
    length = math.sqrt(x * x + y * y + z * z)
    if not (math.isfinite(length) and length > 0.0):
        return math.nan, math.nan
    bend = math.hypot(y, z)
    return _follow(math.atan2(-z, -y), previous, bend / length / _OUT_OF_REACH[1]), -math.atan2(bend, x)


def _in_upper_arm(direction: Array, pitch: float, roll: float) -> tuple[float, float, float]:
    """Rz(-roll) Ry(-pitch) direction."""
    x, y, z = direction.tolist()
    ahead = math.cos(pitch) * x - math.sin(pitch) * z
    up = math.sin(pitch) * x + math.cos(pitch) * z
    return math.cos(roll) * ahead + math.sin(roll) * y, math.cos(roll) * y - math.sin(roll) * ahead, up


def _follow(angle: float, previous: float, trust: float) -> float:
    """Go from `previous` towards `angle` the short way, the whole way from trust 1 up.

    The weight 3 t^2 - 2 t^3 is smooth at both ends, so the angle is as well.
    """
    trust = min(trust, 1.0)
    weight = trust * trust * (3.0 - 2.0 * trust)
    angle = previous + weight * math.remainder(angle - previous, math.tau)
    return angle - math.copysign(math.tau, angle) if abs(angle) > math.tau - _TURN else angle
