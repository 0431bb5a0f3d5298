"""The arms of a single frame, fast enough for a stream.

What `directions.readings_of_skeleton` does for whole recordings, for one frame
at a time: by plain numbers instead of arrays, as an array of three numbers
costs more to handle than to compute with.  A test holds both to the same
results.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from nao_sim import body
from nao_sim.gestures.directions import FOLDED, bone_length
from nao_sim.imitation.filters.rejection import MIN_CONFIDENCE
from nao_sim.robot import Array

Point = Sequence[float]
_SHORTEST = 1e-6  # m; points nearer than this have no direction
_UNKNOWN = (math.nan, math.nan, math.nan)
_UP = (0.0, 0.0, 1.0)
_ARM = ("shoulder", "elbow", "wrist", "hand")
_TRUNK = ("left_shoulder", "right_shoulder", "left_hip", "right_hip", "chest", "neck", "pelvis", "spine")


class FrameReader:
    """Reads frames of skeletons with the same joints.  It has no state.

    Args:
        joints: (J,) names, in the order of the frames' rows.
        planar: whether one camera sees the person and x is 0 throughout.
    """

    def __init__(self, joints: Sequence[str], planar: bool = False) -> None:
        self.joints, self.planar = tuple(joints), planar
        place = {name: number for number, name in enumerate(joints)}
        missing = len(place)  # the row after the last stands for joints that there are none of
        self._arms = [[place.get(f"{side}_{part}", missing) for part in _ARM] for side in body.SIDES]
        self._trunk = [place.get(name, missing) for name in _TRUNK]
        self._usual_trunk = bone_length("pelvis", "chest")
        self._lengths = [bone_length("left_shoulder", "left_elbow"), bone_length("left_elbow", "left_wrist")]

    def read(self, positions: Array, confidence: Array | None = None) -> tuple[Array, Array, Array]:
        """One frame.

        Args:
            positions: (J, 3) m, nan where missing.
            confidence: (J,) from 0 to 1; 1 throughout where None.

        Returns:
            Directions (2, 2, 3), trust (2, 2) and lengths seen (2, 2), as `ArmReadings` has them.

        Raises:
            ValueError: other shapes.
        """
        count = len(self.joints)
        if np.shape(positions) != (count, 3) or (confidence is not None and np.shape(confidence) != (count,)):
            raise ValueError(f"positions {np.shape(positions)}; expected ({count}, 3), and a confidence of each joint")
        points = [*np.asarray(positions).tolist(), _UNKNOWN]
        sure = [1.0] * count if confidence is None else np.asarray(confidence).tolist()
        sure.append(0.0)
        frame, trunk = self._torso(points)
        arms = [self._arm(places, points, sure, frame, trunk) for places in self._arms]
        directions, trust, seen = zip(*arms, strict=True)
        return np.array(directions), np.array(trust), np.array(seen)

    def _torso(self, points: Sequence[Point]) -> tuple[tuple[Point, Point, Point], float]:
        """Forward, left and up of the torso, as `person.torso_frames`, and how long the trunk is, in usual ones."""
        left, right, left_hip, right_hip, chest, neck, pelvis, spine = (points[place] for place in self._trunk)
        hips = _middle(left_hip, right_hip)
        top = _first(_middle(left, right), chest, neck)
        up = _unit(_first(_minus(top, _first(hips, pelvis, spine)), _UP))
        forward = _unit(_cross(_first(_minus(left, right), _minus(left_hip, right_hip)), up))
        return (forward, _cross(up, forward), up), math.dist(top, hips) / self._usual_trunk

    def _arm(
        self, places: list[int], points: Sequence[Point], sure: Sequence[float], frame: Sequence[Point], trunk: float
    ) -> tuple[list[list[float]], list[float], list[float]]:
        shoulder, elbow, wrist, hand = (points[place] for place in places)
        wrist = _first(wrist, hand)
        vectors = [_minus(elbow, shoulder), _minus(wrist, elbow)]
        units = [_unit(vector) for vector in vectors]
        known = math.isfinite(frame[0][0])  # else only up is known, and no direction from the person's front
        directions = [[_dot(axis, vector) for axis in frame] if known else list(_UNKNOWN) for vector in units]
        at_shoulder, at_elbow, at_wrist, at_hand = (sure[place] for place in places)
        ends = (at_shoulder, at_elbow), (at_elbow, max(at_wrist, at_hand))
        trust = [_trusted(*pair, direction[0]) for pair, direction in zip(ends, directions, strict=True)]
        seen = [1.0, 1.0]
        if self.planar:
            lengths = zip(vectors, self._lengths, strict=True)
            seen = [_finite_or_one(math.hypot(*vector) / bone / trunk) if trunk else 1.0 for vector, bone in lengths]
            trust = [value * min(length, 1.0) for value, length in zip(trust, seen, strict=True)]
        elif _dot(*units) < -math.cos(FOLDED):
            trust = [0.0, 0.0]
        return directions, trust, seen


def _trusted(start: float, end: float, coordinate: float) -> float:
    value = min(start, end)
    return value if value >= MIN_CONFIDENCE and math.isfinite(coordinate) else 0.0


def _finite_or_one(value: float) -> float:
    return value if math.isfinite(value) else 1.0


def _first(*points: Point) -> Point:
    """The first that is known; the last where none is."""
    for point in points:
        if math.isfinite(point[0] + point[1] + point[2]):
            return point
    return points[-1]


def _middle(a: Point, b: Point) -> Point:
    return ((a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, (a[2] + b[2]) / 2.0)


def _minus(a: Point, b: Point) -> Point:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Point, b: Point) -> Point:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(a: Point) -> Point:
    length = math.sqrt(_dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length) if length > _SHORTEST else _UNKNOWN
