"""Points of one person over time, before anything is known of their unit and axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from nao_sim.recordings.skeletons.anatomy import Body
from nao_sim.recordings.skeletons.layouts import SKIP, Axes, builtin
from nao_sim.recordings.skeletons.points import Points
from nao_sim.robot import Array, read_only

AXES: Axes = ("-z", "+x", "-y")  # forward, left, up of a person who faces the camera of a picture
RATE = 30.0  # Hz, what webcams give
MEDIAPIPE, BODY_25 = "MediaPipe pose", "OpenPose BODY_25"
# MediaPipe hand landmark model, enumeration HandLandmark; OpenPose, output format, hand: the same order.
HAND = (
    "wrist",
    *(f"thumb_{bone}" for bone in ("cmc", "mcp", "ip", "tip")),
    *(f"{finger}_{bone}" for finger in ("index", "middle", "ring", "pinky") for bone in ("mcp", "pip", "dip", "tip")),
)
SAMPLE = 256  # frames that tell a body's size


@dataclass(frozen=True, eq=False)
class Marks:
    """Points of one person over time, in the file's own unit and axes.

    Attributes:
        names: (J,) as the file has them, or joints of `nao_sim.body`.
        values: (T, J, 3), nan where missing.
        confidence: (T, J) from 0 to 1.
    """

    names: tuple[str, ...]
    values: Array
    confidence: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", read_only(self.values))
        object.__setattr__(self, "confidence", read_only(self.confidence))

    def __len__(self) -> int:
        return len(self.values)

    def track(self, name: str) -> Array:
        """Positions (T, 3) of a point; nan where there is none of that name."""
        if name not in self.names:
            return np.full((len(self), 3), np.nan)
        return self.values[:, self.names.index(name)]

    def moved(self, by: Array) -> Marks:
        """All points moved by (T, 3)."""
        return replace(self, values=self.values + by[:, None, :])

    def scaled(self, by: Array | float) -> Marks:
        """All coordinates times a factor, or a factor (3,) for each axis."""
        return replace(self, values=self.values * by)

    @property
    def known(self) -> bool:
        """Whether any point is ever there."""
        return bool(np.isfinite(self.values).any())


def order_of(layout: str) -> tuple[str, ...]:
    """The joints in the order of a built-in layout; `-` for points of no use."""
    return next(known.joints for known in builtin() if known.name == layout)


def in_order(joints: Sequence[str], values: Array, confidence: Array) -> Marks:
    """Points (T, J, 3) known by their order as joints; those of no use are left out."""
    kept = [place for place, joint in enumerate(joints) if joint != SKIP]
    return Marks(tuple(joints[place] for place in kept), values[:, kept], confidence[:, kept])


def hand(side: str, values: Array, confidence: Array) -> Marks:
    """The 21 points (T, 21, 3) of a hand as joints."""
    return in_order([f"{side}_{joint}" for joint in HAND], values, confidence)


def attached(points: Marks, body: Marks, side: str) -> Marks:
    """A hand moved so that its wrist is the body's; missing where either is."""
    wrist = f"{side}_wrist"
    return points.moved(body.track(wrist) - points.track(wrist))


def together(first: Marks, *others: Marks) -> Marks:
    """All points once each; of those of one name, in every frame the first that is there."""
    names = tuple(dict.fromkeys(name for marks in (first, *others) for name in marks.names))
    values = np.full((len(first), len(names), 3), np.nan)
    confidence = np.zeros(values.shape[:2])
    for marks in (first, *others):
        place = [names.index(name) for name in marks.names]
        empty = ~np.isfinite(values[:, place]).all(axis=2)
        values[:, place] = np.where(empty[:, :, None], marks.values, values[:, place])
        confidence[:, place] = np.where(empty, marks.confidence, confidence[:, place])
    return Marks(names, values, confidence)


def height_of(marks: Marks) -> float:
    """The body's height in the marks' unit, told by its bones; nan where none is known."""
    return sample_of(marks).height


def sample_of(marks: Marks) -> Body:
    """Some frames as a body to measure."""
    some = np.unique(np.linspace(0, len(marks) - 1, SAMPLE).round().astype(int))
    return Body(marks.names, marks.values[some])


def as_points(
    marks: Marks,
    *,
    times: Array | None = None,
    time_unit: float | None = None,
    unit: float | None = None,
    axes: Axes | None = AXES,
    planar: bool = False,
    rate: float | None = RATE,
) -> Points:
    """The points as every reader hands them over, missing ones nan, without those that are never there."""
    there = np.flatnonzero(np.isfinite(marks.values).all(axis=2).any(axis=0))
    return Points(
        marks.values[:, there],
        tuple(marks.names[place] for place in there),
        times,
        marks.confidence[:, there],
        planar=planar,
        unit=unit if unit is not None and np.isfinite(unit) else None,
        axes=axes,
        rate=rate,
        frozen_is_missing=False,
        time_unit=time_unit,
    )
