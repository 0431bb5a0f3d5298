"""Position limits and the limits that depend on another joint."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from nao_sim.robot import Array, Coupling, Robot

# The command stays this far inside, so that the simulated joint, with its sag
# and overshoot, stays inside the documented limit.
MARGIN_RAD = np.radians(0.3)
COUPLING_MARGIN_RAD = np.radians(1.0)


def command_bounds(robot: Robot) -> tuple[Array, Array]:
    """Lowest and highest command (26,) of each joint; hands may close and open fully."""
    margin = np.where(robot.is_hand, 0.0, MARGIN_RAD)
    return robot.lower + margin, robot.upper - margin


def coupled_bounds(coupling: Coupling, start: ArrayLike, end: ArrayLike) -> tuple[Array, Array]:
    """Tightest limits, less a margin, of the coupled joint while the other passes from `start` to `end`.

    The limits are linear between the table's knots, so their extremes lie at
    the ends of the way or at a knot on it.

    Args:
        coupling: the rule.
        start: (...) rad.
        end: (...) rad.

    Returns:
        Lower and upper limits (...), rad.
    """
    way = np.stack(np.broadcast_arrays(start, end))
    low, high = way.min(axis=0), way.max(axis=0)
    lower, upper = coupling.bounds(way)
    passed = (coupling.knots > low[..., None]) & (coupling.knots < high[..., None])
    lower = np.maximum(lower.max(axis=0), np.where(passed, coupling.lower, -np.inf).max(axis=-1))
    upper = np.minimum(upper.min(axis=0), np.where(passed, coupling.upper, np.inf).min(axis=-1))
    return lower + COUPLING_MARGIN_RAD, upper - COUPLING_MARGIN_RAD


def always_allowed(coupling: Coupling, angle: ArrayLike) -> bool:
    """Whether angles (...) of the coupled joint suit any angle of the other; then nothing more need be asked."""
    lower = coupling.lower.max() + COUPLING_MARGIN_RAD
    return bool(np.all((angle >= lower) & (angle <= coupling.upper.min() - COUPLING_MARGIN_RAD)))


def coupling_conflict(coupling: Coupling, path: Array) -> float:
    """Largest excess (rad) of the coupled joint on a path of poses (N, 26), margin included, 0 inside.

    Each step's angle must suit the whole way that the other joint has gone in that step.
    """
    other, angle = path[:, coupling.by], path[1:, coupling.joint]
    if always_allowed(coupling, angle):
        return 0.0
    lower, upper = coupled_bounds(coupling, other[:-1], other[1:])
    return float(np.maximum(lower - angle, angle - upper).max(initial=0.0))


def coupling_excess(coupling: Coupling, positions: Array) -> Array:
    """How far (rad) the coupled joint of positions (..., 26) is outside its limits there, 0 inside."""
    lower, upper = coupling.bounds(positions[..., coupling.by])
    angle = positions[..., coupling.joint]
    return np.maximum(np.maximum(lower - angle, angle - upper), 0.0)


def limit_excess(robot: Robot, positions: Array) -> Array:
    """How far (..., 26) positions are outside the documented limits, 0 inside."""
    return np.maximum(np.maximum(robot.lower - positions, positions - robot.upper), 0.0)
