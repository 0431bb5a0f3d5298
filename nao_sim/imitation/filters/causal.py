"""Smoothing with little lag, for streams: a frame in, a frame out.

A Kalman filter of constant velocity for each joint.  The person's acceleration
is taken for white noise whose density grows with the speed, so that a hand at
rest is quiet and a fast one is followed: the idea of the One-Euro filter
(Casiez, Roussel and Vogel, CHI 2012), which knows no velocity and therefore
lags (`benchmarks/filters.py` has both).  The three coordinates share their
variances, so it makes no difference how the room's axes lie.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from nao_sim.imitation.filters.gaps import FILLED, LONGEST_GAP
from nao_sim.imitation.filters.rejection import MIN_CONFIDENCE
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

NOISE = 0.01  # m rms a coordinate, of depth cameras; the shared Kinect recordings have 0.005 to 0.01
_AT_REST, _MOVING = 0.05, 1.0  # m^2/s^3, and m/s^2 for each m/s more: density of the acceleration
_COASTING = 0.2  # s, in which a hand out of sight slows down to 1/e of its speed
_START_SPEED = 0.5  # m/s rms, of what has just come into sight
_GATE = 5.0  # standard deviations that noise stays within
_BURST = 50.0  # m/s^2 that a movement may begin with and be believed at once; a quicker one is one frame late


class Kalman:
    """A causal filter.  It has a state: one object follows one person.

    A joint that is missing, not trusted or suddenly elsewhere coasts to a
    stop, for `hold` seconds at most; then it is missing.  What was suddenly
    elsewhere is believed when the next frame agrees.

    Args:
        noise: m, rms error of a coordinate of a joint of full confidence.
        hold: s, the longest gap that is bridged.
        min_confidence: below it a joint counts as missing.

    Attributes:
        confidence: (J,) of the last frame's output; 0 where it is missing.
    """

    confidence: Array

    def __init__(self, noise: float = NOISE, hold: float = LONGEST_GAP, min_confidence: float = MIN_CONFIDENCE) -> None:
        if not (math.isfinite(noise) and noise > 0.0):
            raise ValueError(f"noise is {noise}; expected metres above 0")
        if not (math.isfinite(hold) and hold >= 0.0):
            raise ValueError(f"hold is {hold}; expected seconds, 0 or more")
        if not 0.0 < min_confidence <= 1.0:
            raise ValueError(f"min_confidence is {min_confidence}; expected more than 0 and at most 1")
        self._noise, self._hold, self._min_confidence = noise, hold, min_confidence
        self.reset()

    def reset(self) -> None:
        """Forget the person: the next frame is the first."""
        self._time = -math.inf
        self._start(0)

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The whole recording, `step` after `step`, by a fresh filter of the same settings."""
        fresh = Kalman(self._noise, self._hold, self._min_confidence)
        positions, confidence = np.empty(skeleton.positions.shape), np.empty(skeleton.confidence.shape)
        for frame, time in enumerate(skeleton.times.tolist()):
            positions[frame] = fresh.step(time, skeleton.positions[frame], skeleton.confidence[frame])
            confidence[frame] = fresh.confidence
        return replace(skeleton, positions=positions, confidence=confidence)

    def step(self, time: float, positions: Array, confidence: Array | None = None) -> Array:
        """One frame.

        Args:
            time: s, after the last frame's.
            positions: (J, 3) m, nan where missing.
            confidence: (J,) from 0 to 1; 1 throughout where None.

        Returns:
            (J, 3) m, nan where missing.

        Raises:
            ValueError: time does not go on, or there are other joints than before.
        """
        positions = np.asarray(positions, float)
        confidence = np.ones(len(positions)) if confidence is None else np.asarray(confidence, float)
        self._check(time, positions, confidence)
        known = np.isfinite(positions).all(axis=1) & (confidence >= self._min_confidence)
        begins = known & (time - self._seen > self._hold)
        if math.isfinite(self._time):
            self._predict(time - self._time)
            noise = self._noise**2 / np.where(known, confidence, 1.0)
            self._correct(time, positions, noise, known & ~begins)
        self._begin(begins, positions)
        self._seen[begins] = self._time = time
        return self._output(confidence)

    def _check(self, time: float, positions: Array, confidence: Array) -> None:
        if positions.ndim != 2 or positions.shape[1] != 3 or confidence.shape != positions.shape[:1]:  # noqa: PLR2004
            raise ValueError(f"positions {positions.shape}, confidence {confidence.shape}; expected (J, 3) and (J,)")
        if not (math.isfinite(time) and time > self._time):
            raise ValueError(f"time {time} s after {self._time} s; expected times that increase")
        if not math.isfinite(self._time):
            self._start(len(positions))
        elif len(positions) != len(self._seen):
            raise ValueError(f"{len(positions)} joints after {len(self._seen)}; expected the same joints")

    def _start(self, joints: int) -> None:
        self._seen = np.full(joints, -math.inf)  # s, when each joint was last believed
        self._place, self._velocity = np.full((joints, 3), np.nan), np.zeros((joints, 3))
        self._variance = np.zeros((joints, 3))  # of place, of both together, of velocity
        self._doubted = np.full((joints, 3), np.nan)  # where a joint seemed to be in the last frame
        self._trusted = np.zeros(joints)  # confidence when last believed
        self.confidence = np.zeros(joints)

    def _begin(self, which: NDArray[np.bool_], positions: Array) -> None:
        self._place[which], self._velocity[which] = positions[which], 0.0
        self._variance[which] = self._noise**2, 0.0, _START_SPEED**2

    def _predict(self, step: float) -> None:
        """Go on for `step` seconds, slowing down."""
        slower = math.exp(-step / _COASTING)
        way = _COASTING * (1.0 - slower)
        density = _AT_REST + _MOVING * np.linalg.norm(self._velocity, axis=1)
        place, both, velocity = self._variance.T
        self._variance = np.stack(
            [
                place + 2.0 * way * both + way**2 * velocity + density * step**3 / 3.0,
                slower * (both + way * velocity) + density * step**2 / 2.0,
                slower**2 * velocity + density * step,
            ],
            axis=1,
        )
        self._place = self._place + way * self._velocity
        self._velocity = slower * self._velocity

    def _correct(self, time: float, positions: Array, noise: Array, known: NDArray[np.bool_]) -> None:
        """Go towards what is seen, as far as it is trusted, where it can be believed."""
        residual = np.where(known[:, None], positions - self._place, 0.0)
        place, both, velocity = self._variance.T
        total = place + noise
        burst = _BURST / 2.0 * np.where(known, time - self._seen, 0.0) ** 2
        believed = known & (np.linalg.norm(residual, axis=1) <= _GATE * np.sqrt(total) + burst)
        gain = np.where(believed, np.stack([place, both]) / total, 0.0)
        self._place = self._place + gain[0][:, None] * residual
        self._velocity = self._velocity + gain[1][:, None] * residual
        self._variance = np.stack([place - gain[0] * place, both - gain[0] * both, velocity - gain[1] * both], axis=1)
        self._seen[believed] = time
        self._reconsider(time, positions, noise, known & ~believed)

    def _reconsider(self, time: float, positions: Array, noise: Array, doubted: NDArray[np.bool_]) -> None:
        """Believe after all what two frames agree on, and begin anew there; its speed is what they say."""
        step = time - self._time
        moved = positions - self._doubted
        agreed = doubted & (np.linalg.norm(moved, axis=1) <= _GATE * np.sqrt(2.0 * noise) + 2.0 * _BURST * step**2)
        self._place[agreed], self._velocity[agreed] = positions[agreed], moved[agreed] / step
        self._variance[agreed] = noise[agreed, None] * [1.0, 1.0 / step, 2.0 / step**2]
        self._seen[agreed] = time
        self._doubted = np.where((doubted & ~agreed)[:, None], positions, np.nan)

    def _output(self, confidence: Array) -> Array:
        since = self._time - self._seen
        self._trusted = np.where(since == 0.0, confidence, self._trusted)
        held = since <= self._hold
        self.confidence = np.where(held, np.where(since == 0.0, 1.0, FILLED) * self._trusted, 0.0)
        return np.where(held[:, None], self._place, np.nan)
