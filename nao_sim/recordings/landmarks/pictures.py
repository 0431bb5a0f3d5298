"""Landmarks in a picture: what x, y and depth are measured in, and how they become one unit.

x and y are pixels, or fractions of the picture's width and height; depth is a fraction of the width, but larger than
that by a factor of its own.  Where a file does not say the picture's shape, the one of cameras' usual shapes counts
with which the person is most of a body: bones keep their lengths, and have a body's proportions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nao_sim.recordings.landmarks.marks import Marks, height_of, sample_of
from nao_sim.recordings.skeletons.plausibility import disproportion, wobble
from nao_sim.robot import Array

FRACTION = 3.0  # coordinates beyond are pixels; a body that reaches further out of its picture is none
CENTRED = 0.25  # of the coordinates negative: zero is in the middle of the person and not in a corner of a picture
SHAPES = {"1:1": 1.0, "4:3": 4 / 3, "16:9": 16 / 9, "3:4": 3 / 4, "9:16": 9 / 16}  # width to height, of cameras
# Depth in a picture is larger than the documentation says: in 20 recordings of signers (Turkish signs, a .pose file)
# bones keep their lengths and proportions best at 0.15 to 0.30 of it, in the median at 0.25.
DEPTH = 0.25
AT_HIPS = 0.03  # of the body's height: how near to zero the middle of the hips is in world landmarks


@dataclass(frozen=True, eq=False)
class Picture:
    """How to bring the points of a picture to one unit.

    Attributes:
        body: factors (3,) for the body's x, y and z.
        hands: factors (3,) for the hands', whose depth is not too large.
        notes: what a user should know.
    """

    body: Array
    hands: Array
    notes: tuple[str, ...] = ()


def is_world(marks: Marks) -> bool:
    """Whether the middle of the hips is at zero throughout: world landmarks, in metres."""
    middle = (marks.track("left_hip") + marks.track("right_hip")) / 2
    off = np.linalg.norm(middle[np.isfinite(middle).all(axis=1)], axis=1)
    return bool(len(off) and np.quantile(off, 0.9) < AT_HIPS * height_of(marks))


def is_fraction(marks: Marks) -> bool:
    """Whether x and y are fractions of the picture, and not pixels or sizes of a person in the middle."""
    across = marks.values[:, :, :2]
    known = across[np.isfinite(across)]
    return len(known) > 0 and bool(
        np.quantile(np.abs(known), 0.99) <= FRACTION and np.median(known) > 0.0 and np.mean(known < 0.0) < CENTRED
    )


def picture_of(body: Marks, size: tuple[float, float] | None, planar: bool) -> Picture:
    """How to bring the points of a picture to one unit.

    Args:
        body: the body's points, x and y as fractions or pixels.
        size: the picture's width and height in pixels, where known.
        planar: whether depth is not known.
    """
    if not is_fraction(body):
        shapes, notes = {"": np.array([1.0, 1.0, _pixels_of_depth(body, size)])}, dict[str, str]()
    elif size is not None:
        ratio = size[0] / size[1]
        shapes = {"": np.array([ratio, 1.0, ratio])}
        notes = {"": f"fractions of a picture of {size[0]:g} x {size[1]:g}"}
    else:
        known = {"1:1": 1.0} if planar else SHAPES
        shapes = {name: np.array([ratio, 1.0, ratio]) for name, ratio in known.items()}
        why = "" if planar else ", so the body has its proportions best"
        notes = {name: f"fractions of a picture of unknown size: taken as {name}{why}" for name in shapes}
    ways = [(_unlike(body, factors * [1.0, 1.0, depth]), name, depth)
            for depth in ((1.0,) if planar else (1.0, DEPTH)) for name, factors in shapes.items()]  # fmt: skip
    _, name, depth = min(ways, key=lambda way: way[0])
    told: tuple[str, ...] = (notes[name],) if name in notes else ()
    told += (f"depth taken times {depth:g}: so bones keep their lengths and proportions better",) * (depth != 1.0)
    return Picture(shapes[name] * [1.0, 1.0, depth], shapes[name], told)


def _unlike(body: Marks, factors: Array) -> float:
    """How much bones change their lengths and are out of proportion."""
    found = sample_of(body.scaled(factors))
    cost = wobble(found) + disproportion(found)
    return cost if np.isfinite(cost) else np.inf


def _pixels_of_depth(body: Marks, size: tuple[float, float] | None) -> float:
    """Pixels in one unit of the depth beside pixels: it may be a fraction of the width still."""
    depth = body.values[:, :, 2][np.isfinite(body.values[:, :, 2])]
    return size[0] if size is not None and len(depth) and np.ptp(depth) <= 2.0 * FRACTION else 1.0
