"""Where elbows and hands are beside their shoulders: what decision rules compare with thresholds."""

from __future__ import annotations

import numpy as np

from nao_sim.body import SIDES
from nao_sim.imitation.person import torso_frames, wrist
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

PARTS, AXES = ("elbow", "hand"), ("forward", "outward", "up")
PLACES = tuple(f"{side} {part} {axis}" for side in SIDES for part in PARTS for axis in AXES)
ELBOWS = tuple(f"{side} elbow {axis}" for side in SIDES for axis in AXES)
GROUPS = tuple(tuple(range(start, start + 3)) for start in range(0, len(PLACES), 3))  # each point's columns
_OUTWARD = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]])  # sign of forward, left, up by side


def places_of_directions(directions: Array, lengths: Array | None = None) -> Array:
    """Elbows and hands in arm lengths, from the shoulder, in the person's frame.

    Args:
        directions: (..., 2, 2, 3) unit vectors as `nao_sim.imitation.features.directions_of` returns them.
        lengths: (..., 2, 2) of upper arm and forearm of each side in any unit; alike where None.

    Returns:
        (..., 12) in the order of `PLACES`: a hand of a stretched arm is 1 away from its shoulder.
    """
    segments = np.asarray(directions, float)
    bones = np.ones(segments.shape[:-1]) if lengths is None else np.asarray(lengths, float)
    shares = bones / bones.sum(axis=-1, keepdims=True)
    points = np.cumsum(segments * shares[..., None], axis=-2) * _OUTWARD[:, None]
    return points.reshape(*points.shape[:-3], len(PLACES))


def places(skeleton: Skeleton) -> Array:
    """Elbows and hands of a person (T, 12) in their own arm lengths and frame, each frame by itself.

    Nan where a joint is not tracked.  No size, place or turn of the person changes them.
    """
    shoulder, elbow, hand = _joints(skeleton)
    bones = np.stack([elbow - shoulder, hand - elbow], axis=2)
    turned = np.einsum("tji,tabj->tabi", torso_frames(skeleton), bones)
    lengths = np.linalg.norm(bones, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return places_of_directions(turned / lengths[..., None], lengths)


def elbow_offsets(skeleton: Skeleton) -> Array:
    """Elbows less shoulders (T, 6) in metres along the sensor's own axes: what the thesis's rule compares."""
    shoulder, elbow, _ = _joints(skeleton)
    return ((elbow - shoulder) * _OUTWARD).reshape(len(skeleton), len(ELBOWS))


def mirrored(values: Array) -> Array:
    """Places or offsets (N, 12 or 6) of the same people in a mirror: the arms change places."""
    half = values.shape[-1] // 2
    return np.concatenate([values[..., half:], values[..., :half]], axis=-1)


def _joints(skeleton: Skeleton) -> tuple[Array, Array, Array]:
    """Shoulders, elbows and hands, (T, 2, 3) each."""
    shoulder, elbow = (
        np.stack([skeleton.track(f"{side}_{part}") for side in SIDES], axis=1) for part in ("shoulder", "elbow")
    )
    return shoulder, elbow, np.stack([wrist(skeleton, side) for side in SIDES], axis=1)
