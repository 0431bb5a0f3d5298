"""Position limits: the one rule that nothing switches off."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import LEGS, Array, Robot

# The command stays this far inside, so that the simulated joint, with its sag
# and overshoot, stays inside the documented limit; legs that carry the robot
# in a deep squat sag by 0.7 degrees.
MARGIN_RAD, LEG_MARGIN_RAD = np.radians(0.4), np.radians(0.8)


def command_bounds(robot: Robot) -> tuple[Array, Array]:
    """Lowest and highest command (26,) of each joint; hands may close and open fully.

    The documented limits of knees and ankles differ by up to 0.6 degrees
    between left and right: commands keep the narrower, so that the mirrored
    request has the mirrored answer.
    """
    margin = np.where(robot.is_hand, 0.0, np.where(robot.joints_of(*LEGS), LEG_MARGIN_RAD, MARGIN_RAD))
    ends = np.sort([robot.mirror(robot.lower), robot.mirror(robot.upper)], axis=0)
    return np.maximum(robot.lower, ends[0]) + margin, np.minimum(robot.upper, ends[1]) - margin


def limit_excess(robot: Robot, positions: Array) -> Array:
    """How far (..., 26) positions are outside the documented limits, 0 inside."""
    return np.maximum(np.maximum(robot.lower - positions, positions - robot.upper), 0.0)
