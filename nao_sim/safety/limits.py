"""Position limits and the limits that depend on another joint."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array, Coupling, Robot

# The command stays this far inside, so that the simulated joint, with its sag
# and overshoot, stays inside the documented limit.
MARGIN_RAD = np.radians(0.3)
COUPLING_MARGIN_RAD = np.radians(1.0)


def command_bounds(robot: Robot) -> tuple[Array, Array]:
    """Lowest and highest command (26,) of each joint; hands may close and open fully."""
    margin = np.where(robot.is_hand, 0.0, MARGIN_RAD)
    return robot.lower + margin, robot.upper - margin


def coupled_bounds(coupling: Coupling, start: float, end: float) -> tuple[float, float]:
    """Tightest limits of the coupled joint while the other passes from `start` to `end` (rad).

    The limits are linear between the table's knots, so their extremes lie at
    the ends of the way or at a knot on it.
    """
    low, high = min(start, end), max(start, end)
    on_the_way = coupling.knots[(coupling.knots > low) & (coupling.knots < high)]
    lower, upper = coupling.bounds(np.concatenate(([low, high], on_the_way)))
    return float(lower.max()) + COUPLING_MARGIN_RAD, float(upper.min()) - COUPLING_MARGIN_RAD


def coupling_excess(coupling: Coupling, positions: Array) -> Array:
    """How far (rad) the coupled joint of positions (..., 26) is outside its limits there, 0 inside."""
    lower, upper = coupling.bounds(positions[..., coupling.by])
    angle = positions[..., coupling.joint]
    return np.maximum(np.maximum(lower - angle, angle - upper), 0.0)


def limit_excess(robot: Robot, positions: Array) -> Array:
    """How far (..., 26) positions are outside the documented limits, 0 inside."""
    return np.maximum(np.maximum(robot.lower - positions, positions - robot.upper), 0.0)
