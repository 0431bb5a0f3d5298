"""What NAO's arm reaches within its limits, shoulder and elbow each on its own.

ShoulderPitch and ShoulderRoll are longitude and latitude of the upper arm
about the shoulder axis; ElbowYaw and minus ElbowRoll are longitude and
colatitude of the forearm about the upper arm.  The limits cut a rectangle out
of either sphere.  The nearest point of such a rectangle is on the direction's
own meridian where that is within it, and otherwise on the meridian of the
nearer end.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.imitation.arms import ARM_JOINTS, elbow_of, shoulder_of, turned_in
from nao_sim.robot import Array, Robot

EXACT = 1e-9  # rad, an error that is none


@dataclass(frozen=True)
class ArmLimits:
    """What a left arm can do, rad; ShoulderPitch and ElbowYaw reach as far both ways.

    Attributes:
        pitch: the end of ShoulderPitch.
        roll: both ends of ShoulderRoll.
        yaw: the end of ElbowYaw.
        bend: both ends of minus ElbowRoll.
    """

    pitch: float
    roll: tuple[float, float]
    yaw: float
    bend: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Asked:
    """What is asked of N left arms.

    Attributes:
        upper_arm: (3, N) unit vectors, torso frame.
        forearm: (3, N) unit vectors; any where it is not known.
        seen: (N,) where the forearm is known.
    """

    upper_arm: Array
    forearm: Array
    seen: NDArray[np.bool_]

    def __getitem__(self, which: NDArray[Any] | slice) -> Asked:
        return Asked(self.upper_arm[:, which], self.forearm[:, which], self.seen[which])


@cache
def arm_limits(robot: Robot) -> ArmLimits:
    """The documented limits of the robot's left arm; the right one's are their mirror image."""
    joints = [robot.index["L" + name] for name in ARM_JOINTS]
    lower, upper = robot.lower[joints].tolist(), robot.upper[joints].tolist()
    return ArmLimits(upper[0], (lower[1], upper[1]), upper[2], (-upper[3], -lower[3]))


def nearest_shoulder(upper_arm: Array, limits: ArmLimits, end: Array | None = None) -> Array:
    """The shoulder angles within the limits that point the upper arm nearest.

    Args:
        upper_arm: (3, N) unit vectors, torso frame.
        limits: what the arm can do.
        end: (N,) 1 or -1, the end that ShoulderPitch stays at where it is not in reach; the nearer one unless given.

    Returns:
        (2, N) rad, ShoulderPitch and ShoulderRoll.
    """
    wanted, _, off_axis = shoulder_of(upper_arm)
    pitch = _within(wanted, limits.pitch, end)
    roll = np.arctan2(upper_arm[1], off_axis * np.cos(wanted - pitch))
    return np.stack([pitch, np.minimum(np.maximum(roll, limits.roll[0]), limits.roll[1])])


def nearest_elbow(
    forearm: Array, shoulder: Sequence[Array | float] | Array, limits: ArmLimits, end: Array | float | None = None
) -> tuple[Array, Array, Array]:
    """The elbow angles within the limits that point the forearm nearest.

    Args:
        forearm: (3, ...) unit vectors, torso frame.
        shoulder: (2, ...) rad, ShoulderPitch and ShoulderRoll.
        limits: what the arm can do.
        end: (...) 1 or -1, the end that ElbowYaw stays at where it is not in reach; the nearer one unless given.

    Returns:
        ElbowYaw, ElbowRoll, and the angle that is missing then: (...) rad.
    """
    wanted, bend, _, _ = elbow_of(forearm, *shoulder)
    yaw = _within(wanted, limits.yaw, end)
    beside = wanted - yaw
    nearest = np.where(beside == 0.0, bend, np.arctan2(np.sin(bend) * np.cos(beside), np.cos(bend)))
    nearest = np.minimum(np.maximum(nearest, limits.bend[0]), limits.bend[1])
    haversine = np.sin((nearest - bend) / 2.0) ** 2 + np.sin(nearest) * np.sin(bend) * np.sin(beside / 2.0) ** 2
    return yaw, -nearest, _arc(np.sqrt(haversine))


def upper_arm_error(upper_arm: Array, shoulder: Sequence[Array | float] | Array) -> Array:
    """The angle (...) rad by which upper arms (3, ...) miss their unit vectors with the shoulder (2, ...) there."""
    x, y, z = turned_in(upper_arm, *shoulder)
    return _arc(np.sqrt((1.0 - x) ** 2 + y * y + z * z) / 2.0)


def _within(wanted: Array, limit: float, end: Array | float | None) -> Array:
    angle = np.minimum(np.maximum(wanted, -limit), limit)
    return angle if end is None else np.where(angle == wanted, angle, end * limit)


def _arc(half_chord: Array) -> Array:
    return 2.0 * np.arcsin(np.minimum(half_chord, 1.0))
