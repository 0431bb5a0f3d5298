"""The immutable values that everything passes along."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from nao_sim.body import twin
from nao_sim.robot import Array, load_robot, read_only

_MIRROR = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class JointTrajectory:
    """Joint positions over time.

    Attributes:
        times: (T,) s, strictly increasing, T >= 1.
        positions: (T, 26) in the joint vector's units; a value that is not
            finite means "nothing asked of this joint in this frame".
        given: (26,) which joints the source speaks of; the others hold the
            start posture.
    """

    times: Array
    positions: Array
    given: NDArray[np.bool_] = field(default_factory=lambda: np.ones(len(load_robot().joint_names), bool))

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", read_only(self.times))
        object.__setattr__(self, "positions", read_only(self.positions))
        object.__setattr__(self, "given", read_only(self.given, np.bool_))
        frames, joints = len(self.times), len(load_robot().joint_names)
        if self.times.ndim != 1 or frames == 0:
            raise ValueError(f"times has shape {self.times.shape}; expected (T,) with T >= 1")
        if self.positions.shape != (frames, joints):
            raise ValueError(f"positions has shape {self.positions.shape}; expected ({frames}, {joints})")
        if self.given.shape != (joints,):
            raise ValueError(f"given has shape {self.given.shape}; expected ({joints},)")
        if not np.isfinite(self.times).all() or (np.diff(self.times) <= 0).any():
            raise ValueError("times are not finite and strictly increasing")

    def __len__(self) -> int:
        return len(self.times)

    @property
    def duration(self) -> float:
        """Seconds from the first to the last frame."""
        return float(self.times[-1] - self.times[0])

    def at_speed(self, speed: float) -> JointTrajectory:
        """The same motion `speed` times as fast."""
        return JointTrajectory(self.times[0] + (self.times - self.times[0]) / speed, self.positions, self.given)

    def sample(self, times: Array) -> Array:
        """Positions (N, 26) at `times` (N,), linear between frames.

        Outside the recording the nearest frame holds.  A sample beside a value
        that is not finite is not finite: a gap stays a gap.
        """
        right = np.clip(np.searchsorted(self.times, times, side="right"), 1, max(len(self) - 1, 1))
        left, right = np.minimum(right - 1, len(self) - 1), np.minimum(right, len(self) - 1)
        span = np.where(right > left, self.times[right] - self.times[left], 1.0)
        weight = np.clip((times - self.times[left]) / span, 0.0, 1.0)[:, None]
        a, b = self.positions[left], self.positions[right]
        with np.errstate(invalid="ignore"):
            between = a * (1.0 - weight) + b * weight
        return np.where(weight == 0.0, a, np.where(weight == 1.0, b, between))

    def mirrored(self) -> JointTrajectory:
        """The motion seen in a mirror."""
        robot = load_robot()
        return JointTrajectory(self.times, robot.mirror(self.positions), self.given[robot.mirror_of])


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A person's joints over time.

    Attributes:
        times: (T,) s, strictly increasing, T >= 1.
        positions: (T, J, 3) m, x forward, y left, z up in a frame that stays
            where it is while the person moves; all nan where a joint is missing.
        joints: (J,) names, as `nao_sim.body` has them.
        confidence: (T, J) from 0 (missing) to 1; 1 throughout unless given.
        planar: whether it was seen by one camera that knows no depth, and x is
            0 throughout.
    """

    times: Array
    positions: Array
    joints: tuple[str, ...]
    confidence: Array = field(default_factory=lambda: np.ones(()))
    planar: bool = False

    def __post_init__(self) -> None:
        shape = np.shape(self.positions)
        if len(shape) != 3 or shape[1:] != (len(self.joints), 3):  # noqa: PLR2004
            raise ValueError(f"positions has shape {shape}; expected (T, {len(self.joints)}, 3)")
        if np.shape(self.times) != shape[:1] or shape[0] == 0:
            raise ValueError(f"times has shape {np.shape(self.times)}; expected ({shape[0]},) and at least one frame")
        if len(set(self.joints)) < len(self.joints):
            raise ValueError("a joint is there twice; expected each joint once")
        missing = np.asarray(~np.isfinite(self.positions).all(axis=2))
        confidence = np.asarray(self.confidence, float)
        confidence = np.broadcast_to(confidence, shape[:2]) if confidence.ndim == 0 else confidence
        if confidence.shape != shape[:2]:
            raise ValueError(f"confidence has shape {confidence.shape}; expected {shape[:2]}")
        object.__setattr__(self, "times", read_only(self.times))
        partly = missing & ~np.isnan(self.positions).all(axis=2)  # else a long recording is copied for nothing
        positions = np.where(missing[:, :, None], np.nan, self.positions) if partly.any() else self.positions
        object.__setattr__(self, "positions", read_only(positions))
        object.__setattr__(self, "confidence", read_only(np.where(missing, 0.0, np.nan_to_num(confidence))))
        if not np.isfinite(self.times).all() or (np.diff(self.times) <= 0).any():
            raise ValueError("times are not finite and strictly increasing")

    def __len__(self) -> int:
        return len(self.times)

    @property
    def duration(self) -> float:
        """Seconds from the first to the last frame."""
        return float(self.times[-1] - self.times[0])

    def at_speed(self, speed: float) -> Skeleton:
        """The same motion `speed` times as fast."""
        return replace(self, times=self.times[0] + (self.times - self.times[0]) / speed)

    def track(self, joint: str) -> Array:
        """Positions (T, 3) of a joint; nan throughout where the skeleton has none of that name."""
        if joint not in self.joints:
            return np.full((len(self), 3), np.nan)
        return self.positions[:, self.joints.index(joint)]

    def mirrored(self) -> Skeleton:
        """The person seen in a mirror: left and right change places."""
        return replace(self, positions=self.positions * _MIRROR, joints=tuple(twin(joint) for joint in self.joints))
