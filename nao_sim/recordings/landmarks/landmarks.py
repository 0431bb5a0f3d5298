"""What the readers of landmarks share: points of the body and of the hands, put together as one person.

A landmark detector sees the body and each hand on its own.  In a picture, x and
y are fractions of its width and height (or pixels), y points down, and z is a
depth on the scale of x whose zero is the hips or the hand's own wrist (MediaPipe
documentation, "Pose landmark detection" and "Hand landmark detection").  World
landmarks are metres from the middle of the hips or of the hand.  A person who
faces the camera has the left hand at the right of the picture.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from nao_sim.recordings.landmarks.marks import Marks, attached, height_of, together
from nao_sim.recordings.landmarks.pictures import is_world, picture_of
from nao_sim.recordings.skeletons.fitting import ADULT

PALM = 0.055  # heights of the body from wrist to knuckles: half of the hand's 0.108 (Winter, fig. 4.1)


def person(
    body: Marks | None,
    world: Marks | None,
    hands: Mapping[str, Marks],
    size: tuple[float, float] | None = None,
    hands_world: Mapping[str, Marks] | None = None,
    planar: bool = False,
) -> tuple[Marks, float | None, tuple[str, ...]]:
    """One person from what a detector saw of the body and the hands.

    Args:
        body: points of the body in the picture.
        world: the same in metres, preferred.
        hands: points of the hands in the picture by side, each hand's depth from its own wrist.
        size: the picture's width and height in pixels, where known.
        hands_world: points of the hands in metres by side.
        planar: whether depth is not known; hands are then where the picture has them.

    Returns:
        The points, metres in one of their units where that is known, and what a user should know.
    """
    notes: list[str | None] = []
    if body is not None and world is None and not planar and is_world(body):
        body, world = None, body
        notes.append("the middle of the hips is at zero throughout: world landmarks, in metres")
    if body is not None:
        picture = picture_of(body, size, planar)
        body = body.scaled(picture.body)
        hands = {side: points.scaled(picture.hands) for side, points in hands.items()}
        notes += picture.notes if world is None else ()
    if world is None:
        assert body is not None, "a file without a body is refused before"
        if planar:
            return together(*hands.values(), body), None, _said(notes)
        fitted = [attached(points, body, side) for side, points in hands.items()]
        notes.append(f"a picture tells no size: scaled to an adult of {ADULT:.2f} m")
        return together(*fitted, body), ADULT / height_of(body), _said(notes)
    height = height_of(world)
    scale = height / height_of(body) if body is not None else np.nan
    in_metres, note = _in_metres(hands, dict(hands_world or {}), height, scale)
    fitted = [attached(points, world, side) for side, points in in_metres.items()]
    return together(*fitted, world), 1.0, _said([*notes, note])


def _in_metres(
    hands: Mapping[str, Marks], in_metres: dict[str, Marks], height: float, scale: float
) -> tuple[dict[str, Marks], str | None]:
    """The hands in metres: as seen so, or from the picture by its scale, where that is known."""
    seen = {side: points for side, points in hands.items() if side not in in_metres}
    if not seen:
        return in_metres, None
    if np.isfinite(scale):
        scaled = {side: points.scaled(scale) for side, points in seen.items()}
        return in_metres | scaled, "hands are from the picture, brought to the size of the body in metres"
    palms = {side: _palm(side, points) for side, points in seen.items()}
    scaled = {side: points.scaled(PALM * height / palms[side]) for side, points in seen.items() if palms[side] > 0.0}
    return in_metres | scaled, "hands are from the picture, brought to the size that such a body's palms have"


def _palm(side: str, points: Marks) -> float:
    """The length of a palm in the marks' unit, 0 where it is never seen."""
    lengths = np.linalg.norm(points.track(f"{side}_middle_mcp") - points.track(f"{side}_wrist"), axis=1)
    known = lengths[np.isfinite(lengths)]
    return float(np.median(known)) if len(known) else 0.0


def _said(notes: Sequence[str | None]) -> tuple[str, ...]:
    return tuple(note for note in notes if note)
