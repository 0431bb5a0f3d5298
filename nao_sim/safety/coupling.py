"""Limits that depend on another joint: HeadPitch's on HeadYaw, AnkleRoll's on AnklePitch."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np

from nao_sim.robot import LEGS, Array, Coupling, Robot
from nao_sim.safety.margins import Margin

NAME = "coupling"
MARGIN_RAD = np.radians(1.0)  # the two joints do not lag quite alike
SAG_RAD = np.radians(3.0)  # of ankles that carry the robot
KNOT = 1e-9  # rad; nearer is on it


def coupling_excess(coupling: Coupling, positions: Array) -> Array:
    """How far (rad) the coupled joint of positions (..., 26) is outside its limits there, 0 inside."""
    lower, upper = coupling.bounds(positions[..., coupling.by])
    angle = positions[..., coupling.joint]
    return np.maximum(np.maximum(lower - angle, angle - upper), 0.0)


def narrowed(coupling: Coupling, sag: float) -> Coupling:
    """The coupling whose limits hold wherever the other joint is, within `sag` (rad) of where it should be."""
    ends = coupling.knots[0], coupling.knots[-1]
    knots = np.unique(np.clip(np.concatenate([coupling.knots + shift for shift in (-sag, 0.0, sag)]), *ends))
    # limits are linear between knots, so the tightest are at the ends of what the sag reaches, or at a knot inside it
    reached = np.clip(coupling.knots, knots[:, None] - sag, knots[:, None] + sag)
    lower, upper = coupling.bounds(np.clip(reached, *ends))
    return replace(coupling, knots=knots, lower=lower.max(axis=1), upper=upper.min(axis=1))


class CouplingRule:
    """Keeps each coupled joint inside the limits that the other joint sets, less a margin.

    Args:
        robot: whose tables count.
        standing: whether it stands on its ankles, which sag.
    """

    def __init__(self, robot: Robot, standing: bool = False) -> None:
        legs = robot.joints_of(*LEGS) & standing
        self._couplings = tuple(narrowed(c, SAG_RAD) if legs[c.joint] else c for c in robot.couplings)
        self._joints = np.array([coupling.joint for coupling in self._couplings])
        self._involved = np.array([joint for coupling in self._couplings for joint in (coupling.joint, coupling.by)])
        self._joint_count = len(robot.joint_names)
        # legs mostly stand, and then the same is asked again and again
        self._nearest, self._standing = lru_cache(16)(self._nearest_to), lru_cache(16)(self._worst_at)
        # between these the joint may be whatever the other one does
        self._least = np.array([coupling.lower.max() for coupling in self._couplings]) + MARGIN_RAD
        self._most = np.array([coupling.upper.min() for coupling in self._couplings]) - MARGIN_RAD

    def nearest(self, pose: Array) -> Array:
        """The pose (26,) with each coupled joint moved out of the way of the one that limits it."""
        angles = self._nearest(pose[self._involved].tobytes())
        if angles is None:
            return pose
        pose = pose.copy()
        pose[self._joints] = angles
        return pose

    def broken(self, line: Array, rounding: float) -> bool:
        """Whether the straight lines between poses (N, 26) break the rule by more than `rounding` (rad)."""
        angles = line[:, self._involved]
        if (angles == angles[0]).all():
            return self._standing(angles[0].tobytes()) < -rounding
        return self._worst(line) < -rounding

    def _nearest_to(self, involved: bytes) -> Array | None:
        """Where the coupled joints go, by the involved joints' angles; None where they may stay."""
        pose = self._pose(involved)
        bound = self._bound(pose[None])
        for coupling in bound:
            lower, upper = coupling.bounds(pose[coupling.by])
            pose[coupling.joint] = np.clip(pose[coupling.joint], lower + MARGIN_RAD, upper - MARGIN_RAD)
        return pose[self._joints] if bound else None

    def _worst_at(self, involved: bytes) -> float:
        return self._worst(self._pose(involved)[None])

    def _pose(self, involved: bytes) -> Array:
        """A pose (26,) with the involved joints' angles, 0 elsewhere."""
        pose = np.zeros(self._joint_count)
        pose[self._involved] = np.frombuffer(involved)
        return pose

    def _worst(self, line: Array) -> float:
        """The smallest margin (rad) of any limit that the lines between poses (N, 26) may have to do with."""
        return min(
            (
                float(values.min())
                for coupling in self._bound(line)
                for values in _values(coupling, _with_knots(coupling, line))
            ),
            default=np.inf,
        )

    def margins(self, line: Array, reach: Array, within: float) -> Iterator[tuple[Margin, Array]]:
        """The smallest margin of each limit on straight lines between poses (N, 26), if it is less than `within` (rad).

        Yields:
            The margin, and the reach (26,), one row for each pose, where it is smallest.
        """
        for coupling in self._bound(line, within):
            places = _with_knots(coupling, line)
            limits = (coupling.lower, 1.0), (coupling.upper, -1.0)
            for values, (bound, sign) in zip(_values(coupling, places), limits, strict=True):
                at = int(values.argmin())
                if values[at] < within:
                    segment, share, other, _ = places[:, at]
                    gradient = np.zeros(line.shape[1])
                    gradient[coupling.joint] = sign
                    gradient[coupling.by] = -sign * _slope(coupling.knots, bound, other)
                    following = min(int(segment) + 1, len(reach) - 1)
                    yield (
                        Margin(NAME, float(values[at]), gradient),
                        (1.0 - share) * reach[int(segment)] + share * reach[following],
                    )

    def _bound(self, line: Array, within: float = 0.0) -> list[Coupling]:
        """The couplings that lines between poses (N, 26) may have to do with."""
        angles = line[:, self._joints]
        free = (angles.min(axis=0) >= self._least + within) & (angles.max(axis=0) <= self._most - within)
        return [] if free.all() else [c for c, is_free in zip(self._couplings, free, strict=True) if not is_free]


def _values(coupling: Coupling, places: Array) -> tuple[Array, Array]:
    """How far places are from the lower and the upper limit there, margins less, rad."""
    _, _, other, angle = places
    lower, upper = coupling.bounds(other)
    return angle - lower - MARGIN_RAD, upper - MARGIN_RAD - angle


def _with_knots(coupling: Coupling, line: Array) -> Array:
    """Where the limits can be nearest on straight lines: they are linear between knots, so at the ends or at a knot.

    Returns:
        (4, M): the pose before, the share of the way to the next one, angles of the limiting and the coupled joint.
    """
    other, angle = line[:, coupling.by], line[:, coupling.joint]
    ends = np.stack([np.arange(len(line)), np.zeros(len(line)), other, angle])
    low, high = other.min(), other.max()
    knots = coupling.knots[(coupling.knots > low) & (coupling.knots < high)]
    if not len(knots):
        return ends
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = (knots[:, None] - other[:-1]) / np.diff(other)
    knot, segment = np.nonzero((shares > 0.0) & (shares < 1.0))
    share = shares[knot, segment]
    passed = (1.0 - share) * angle[segment] + share * angle[segment + 1]
    return np.concatenate([ends, np.stack([segment, share, knots[knot], passed])], axis=1)


def _slope(knots: Array, values: Array, at: float) -> float:
    """Slope of the piece that `at` lies on, at a knot the mean of both sides; 0 beyond the table."""
    slopes = np.concatenate([[0.0], np.diff(values) / np.diff(knots), [0.0]])
    below, above = np.searchsorted(knots, (at - KNOT, at + KNOT))
    return float((slopes[below] + slopes[above]) / 2.0)
