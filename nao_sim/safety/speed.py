"""Speed, acceleration and braking: how a joint moves toward what is asked of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim.robot import Array, Mask, Robot

ROUNDING = 1.0 + 1e-6
EDGE = 1e-9  # rad
STANDS = 1e-6  # share of its speed, with which a joint that brakes counts as standing


@dataclass(frozen=True, eq=False)
class Pace:
    """How fast joints may be and become.

    Attributes:
        top: (26,) rad/s (hands 1/s).
        acceleration: (26,) rad/s^2 (hands 1/s^2).
        together: (26,) joints that brake in step, so that a stop keeps the pose
            on a straight line (feet that stand flat stay flat); None for no joint.
    """

    top: Array
    acceleration: Array
    together: Mask | None = None

    def braking(self, speed: Array, dt: float) -> Array:
        """Speeds (26,) one step of `dt` into a full stop from speeds (26,)."""
        return np.asarray(speed * np.maximum(1.0 - 1.0 / np.maximum(self._steps(speed, dt), 1.0), 0.0))

    def stop(self, position: Array, speed: Array, dt: float) -> Array:
        """Poses (N, 26) of one step at `speed` and the full stop after it; the last one stands."""
        left = self._left(speed, dt)
        if len(left) == 1:
            return np.asarray((position + dt * speed)[None])
        return np.asarray(position + dt * np.cumsum(left, axis=0) * speed)

    def reach(self, speed: Array, dt: float) -> Array:
        """(N, 26) s, the derivatives of those poses by the speeds of the first step."""
        return np.asarray(dt * np.cumsum(self._left(speed, dt) > STANDS, axis=0), np.float64)

    def in_reach(self, asked: Array, position: Array, speed: Array, bounds: tuple[Array, Array], dt: float) -> bool:
        """Whether speeds (26,) are among those of `range`, but for rounding."""
        after = position + asked * dt + 0.5 * asked * np.abs(asked) / self.acceleration
        return bool(
            (np.abs(asked) <= self.top * ROUNDING).all()
            and (np.abs(asked - speed) <= self.acceleration * (dt * ROUNDING)).all()
            and (after >= bounds[0] - EDGE).all()
            and (after <= bounds[1] + EDGE).all()
        )

    def range(self, position: Array, speed: Array, bounds: tuple[Array, Array], dt: float) -> tuple[Array, Array]:
        """Lowest and highest speeds (26,) that the motors reach in a step and from which the bounds allow a stop.

        A stop at full deceleration is always in it: whoever came here could stop.
        What brakes in step may need longer; that is looked at along the stop.
        """
        change, brake = self.acceleration * dt, self.braking(speed, dt)
        down = stopping_speed(position - bounds[0], self.acceleration, dt)
        up = stopping_speed(bounds[1] - position, self.acceleration, dt)
        low = np.maximum(np.maximum(speed - change, -self.top), -down)
        high = np.minimum(np.minimum(speed + change, self.top), up)
        return np.minimum(low, brake), np.maximum(high, brake)

    def _left(self, speed: Array, dt: float) -> Array:
        """(N, 26) share of its speed that each joint has in one step at it and those of the full stop after it."""
        steps = self._steps(speed, dt)
        count = max(1, int(np.ceil(steps.max() - STANDS)))
        return np.maximum(1.0 - np.arange(count)[:, None] / np.maximum(steps, 1.0), 0.0)

    def _steps(self, speed: Array, dt: float) -> Array:
        """How many steps (26,) a stop takes, not rounded."""
        steps = np.abs(speed) / (self.acceleration * dt)
        if self.together is not None:
            steps[self.together] = steps[self.together].max()
        return steps


def speed_limits(robot: Robot, fraction: float) -> Array:
    """Largest commanded speed (26,), rad/s (hands 1/s): what a motor follows, at most a share of its no-load speed."""
    return np.minimum(robot.max_speed, fraction * robot.no_load_speed)


def stopping_speed(distance: Array, acceleration: Array, dt: float) -> Array:
    """Largest speed of the next step of `dt` after which a stop within `distance` is possible.

    The root of v dt + v^2 / (2 a) = distance, so it holds whatever the length
    of the steps after the next one.
    """
    way = 2.0 * np.maximum(distance, 0.0)
    return np.asarray(way / (dt + np.sqrt(dt**2 + way / acceleration)))


def tracking_speed(request: Array, before: Array, position: Array, pace: Pace, dt: float) -> Array:
    """Speeds (26,) of the next step toward a request that moves.

    Seen from the request the joint comes to a stop there: one that keeps up
    stays on it, one that is behind catches up without passing it.

    Args:
        request: (26,) where to be at the end of the step.
        before: (26,) the request one step before.
        position: (26,) the previous command.
        pace: speed and acceleration limits.
        dt: s.
    """
    drift = (request - before) / dt
    drift = np.where(np.abs(drift) > pace.top * ROUNDING, 0.0, drift)  # a jump is no speed
    gap = request - drift * dt - position
    return np.asarray(drift + np.sign(gap) * stopping_speed(np.abs(gap), pace.acceleration, dt))
