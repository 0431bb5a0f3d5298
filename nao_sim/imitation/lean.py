"""How a person stands: legs bent, trunk leaning, weight to one side."""

from __future__ import annotations

import numpy as np

from nao_sim.body import SIDES
from nao_sim.imitation.person import first_known, middle, shoulder_centre
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

REACH, PITCH, ROLL, SWAY = range(4)
LIFTED = 0.15  # of a leg's length; an ankle that much higher than the other is off the floor
_LONGEST = 95  # percentile of a leg's length over a planar recording, in which depth shortens it


def lean_of(skeleton: Skeleton) -> Array:
    """How the person stands, seen from the feet and along the person's own front.

    A lifted foot says nothing of how deep the person is: the straighter leg counts.

    Returns:
        (T, 4), nan where not tracked: `REACH` from hip to ankle over the way
        along the bones, 1 for a straight leg; `PITCH` and `ROLL` rad of the
        trunk against the vertical, positive forward and to the right; `SWAY`
        of the hips from the middle between the ankles, in leg lengths, positive
        to the left.  Without depth (a planar skeleton) PITCH is 0.
    """
    left = _left(skeleton)
    hips = first_known([middle(skeleton, "hip"), skeleton.track("pelvis")])
    trunk = shoulder_centre(skeleton) - hips
    forward, side, up = _along(trunk, np.cross(left, [0.0, 0.0, 1.0])), _along(trunk, left), trunk[:, 2]
    pitch = np.where(np.isfinite(forward), np.arctan2(forward, up), np.nan)
    direct, whole = leg_lengths(skeleton)
    sway = _along(hips - middle(skeleton, "ankle"), left) / whole.mean(axis=1)
    reach = np.fmax.reduce(np.clip(direct / whole, 0.0, 1.0), axis=1)
    return np.stack([reach, pitch, -np.arctan2(side, np.hypot(forward, up)), sway], axis=1)


def leg_lengths(skeleton: Skeleton) -> tuple[Array, Array]:
    """From hip to ankle, straight and along the bones, each (T, 2) m, left and right."""
    tracks = [np.stack([skeleton.track(f"{side}_{part}") for part in ("hip", "knee", "ankle")]) for side in SIDES]
    direct = np.stack([np.linalg.norm(leg[2] - leg[0], axis=1) for leg in tracks], axis=1)
    whole = np.stack([np.linalg.norm(np.diff(leg, axis=0), axis=2).sum(axis=0) for leg in tracks], axis=1)
    if skeleton.planar and np.isfinite(whole).any():
        whole = np.where(np.isfinite(whole), np.nanpercentile(whole, _LONGEST), np.nan)
    return direct, np.where(whole > 0.0, whole, np.nan)


def lifted_share(skeleton: Skeleton) -> float:
    """Share of the frames in which a foot is off the floor, from 0 to 1; 0 where no leg is tracked."""
    apart = np.abs((skeleton.track("left_ankle") - skeleton.track("right_ankle"))[:, 2])
    whole = leg_lengths(skeleton)[1].mean(axis=1)
    known = np.isfinite(apart) & np.isfinite(whole)
    return float((apart[known] > LIFTED * whole[known]).mean()) if known.any() else 0.0


def _left(skeleton: Skeleton) -> Array:
    """The level direction (T, 3) to the person's left; nan where hips and shoulders are not tracked."""
    across = [skeleton.track(f"left_{part}") - skeleton.track(f"right_{part}") for part in ("hip", "shoulder")]
    level = first_known(across) * [1.0, 1.0, 0.0]
    length = np.linalg.norm(level, axis=1, keepdims=True)
    return np.divide(level, length, out=np.full(level.shape, np.nan), where=length > 0.0)


def _along(vectors: Array, direction: Array) -> Array:
    return np.asarray(np.einsum("ti,ti->t", vectors, direction))
