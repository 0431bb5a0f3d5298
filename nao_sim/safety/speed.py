"""Speed and acceleration: how a joint moves toward what is asked of it."""

from __future__ import annotations

import numpy as np

from nao_sim.robot import Array, Robot

SPEED_FRACTION = 0.8  # of the no-load speed
ROUNDING = 1.0 + 1e-6


def speed_limits(robot: Robot) -> Array:
    """Largest commanded speed (26,) in rad/s (hands 1/s)."""
    return np.minimum(robot.max_speed, SPEED_FRACTION * robot.no_load_speed)


def stopping_speed(distance: Array, acceleration: Array, dt: float) -> Array:
    """Largest speed of the next step of `dt` from which a stop within `distance` is possible.

    With speeds k, k-1, ... k-n (in units of a dt) in the coming steps, the way
    is a dt^2 (n+1)(n/2 + k-n), n the whole part of k.  This is its inverse.
    """
    steps = np.maximum(distance, 0.0) / (acceleration * dt**2)
    whole = np.floor((np.sqrt(1.0 + 8.0 * steps) - 1.0) / 2.0)
    part = (steps - whole * (whole + 1.0) / 2.0) / (whole + 1.0)
    return (whole + part) * acceleration * dt


def next_speed(
    request: Array, before: Array, position: Array, speed: Array, limits: tuple[Array, Array], dt: float
) -> Array:
    """Speeds (26,) of the next step toward `request`.

    Seen from the request, which itself moves, the joint comes to a stop there:
    one that keeps up stays on it, one that is behind catches up without passing it.

    Args:
        request: (26,) where to be at the end of the step.
        before: (26,) the request one step before.
        position: (26,) the previous command.
        speed: (26,) the speed of the previous command.
        limits: speed and acceleration limits, each (26,).
        dt: s.
    """
    top, acceleration = limits
    drift = (request - before) / dt
    drift = np.where(np.abs(drift) > top * ROUNDING, 0.0, drift)  # a jump is no speed
    gap = request - drift * dt - position
    chosen = drift + np.sign(gap) * stopping_speed(np.abs(gap), acceleration, dt)
    reachable = np.clip(chosen, speed - acceleration * dt, speed + acceleration * dt)
    # a request at the very limit is followed, not left behind by rounding
    followed = np.where(np.abs(chosen - reachable) <= (ROUNDING - 1.0) * acceleration * dt, chosen, reachable)
    return np.clip(followed, -top, top)


def braking_path(position: Array, speed: Array, acceleration: Array, dt: float) -> Array:
    """Positions (N, 26), N >= 1, of a stop at full deceleration; the first is `position` itself."""
    steps = int(np.ceil(np.max(np.abs(speed) / (acceleration * dt)) - 1e-9)) if np.any(speed) else 0
    left = np.maximum(np.abs(speed) - acceleration * dt * np.arange(1, steps + 1)[:, None], 0.0)
    moves = np.concatenate([np.zeros((1, len(position))), np.sign(speed) * left * dt])
    return position + np.cumsum(moves, axis=0)
