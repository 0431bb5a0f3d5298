"""The person's own frame, and the directions of their arms in it.

The torso's up runs from the hips (or, where those are hidden, the pelvis or
the spine) to the middle of the shoulders, so that leaning, sitting and turning
change nothing about the arms.  Where nothing below the shoulders is tracked,
up is the world's.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nao_sim.body import SIDES
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

_UP = np.array([0.0, 0.0, 1.0])
_SHORTEST = 1e-6  # m; points nearer than this have no direction


def torso_frames(skeleton: Skeleton) -> Array:
    """How the torso is turned.

    Returns:
        (T, 3, 3) rotation matrices whose columns are the torso's forward, left
        and up in the skeleton's frame; nan where the shoulders, and the hips
        in their place, are not tracked.
    """
    shoulders, hips = _across(skeleton, "shoulder"), _across(skeleton, "hip")
    up = unit(first_known([_spine(skeleton), np.broadcast_to(_UP, shoulders.shape)]), _SHORTEST)
    forward = unit(_cross(first_known([shoulders, hips]), up), _SHORTEST)
    left = _cross(up, forward)
    return np.stack([forward, left, up], axis=-1)


def arm_directions(skeleton: Skeleton, torso: Array | None = None) -> Array:
    """Where the arms point, seen from the torso.

    Args:
        skeleton: the person.
        torso: (T, 3, 3) its `torso_frames`, where they are known already.

    Returns:
        (T, 2, 2, 3) unit vectors, x forward, y left, z up: side (left, right),
        segment (upper arm, forearm); nan where a joint is not tracked.
    """
    frames = torso_frames(skeleton) if torso is None else torso
    segments = np.stack([np.stack(_arm(skeleton, side), axis=1) for side in SIDES], axis=1)
    return unit(np.einsum("tji,tabj->tabi", frames, segments), _SHORTEST)


def shoulder_centre(skeleton: Skeleton) -> Array:
    """The point (T, 3) between the shoulders, m."""
    return first_known([middle(skeleton, "shoulder"), skeleton.track("chest"), skeleton.track("neck")])


def middle(skeleton: Skeleton, part: str) -> Array:
    """The point (T, 3) half-way between a left and a right joint, m."""
    return (skeleton.track(f"left_{part}") + skeleton.track(f"right_{part}")) / 2.0


def wrist(skeleton: Skeleton, side: str) -> Array:
    """Where the forearm ends (T, 3), m: the wrist, or the hand where no wrist is tracked."""
    return first_known([skeleton.track(f"{side}_wrist"), skeleton.track(f"{side}_hand")])


def first_known(tracks: Sequence[Array]) -> Array:
    """In each frame the first of several tracks (T, 3) that is known there."""
    chosen = tracks[0]
    for track in tracks[1:]:
        known = np.isfinite(chosen).all(axis=1, keepdims=True)
        if known.all():
            break
        chosen = np.where(known, chosen, track)
    return chosen


def _spine(skeleton: Skeleton) -> Array:
    """From the lowest known point of the trunk to the middle of the shoulders."""
    lowest = first_known([middle(skeleton, "hip"), skeleton.track("pelvis"), skeleton.track("spine")])
    return shoulder_centre(skeleton) - lowest


def _across(skeleton: Skeleton, part: str) -> Array:
    return skeleton.track(f"left_{part}") - skeleton.track(f"right_{part}")


def _arm(skeleton: Skeleton, side: str) -> tuple[Array, Array]:
    shoulder, elbow = skeleton.track(f"{side}_shoulder"), skeleton.track(f"{side}_elbow")
    return elbow - shoulder, wrist(skeleton, side) - elbow


def _cross(a: Array, b: Array) -> Array:
    """The cross products (T, 3) of vectors; numpy's own takes several times as long for a single frame."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)


def unit(vectors: Array, shortest: float = 0.0) -> Array:
    """Vectors (..., 3) of length 1 in the same directions; nan where they are no longer than `shortest`."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.full(vectors.shape, np.nan), where=length > shortest)
