"""How much points are a body: bones of likely and constant lengths, two like sides, joints in their places."""

from __future__ import annotations

import numpy as np

from nao_sim.body import Bone, twin
from nao_sim.recordings.skeletons.anatomy import Body, ahead, median, unit
from nao_sim.robot import Array

STEADY = 0.1  # heights of the body; shorter bones are as unsteady as sensors are
LONG, SLACK, SHORT_SLACK = 0.14, 0.8, 1.3  # heights of the body; log ratios beyond which a long, a short bone is none
MOST = 1.5  # of a log ratio that still counts: 4.5 times too long is as wrong as any more
SQUARE, PARALLEL, BENT = 0.35, 0.6, 0.55  # cosines, and from hip to ankle in lengths of the leg with the knee at 67 deg
CENTRED, ASIDE = 0.5, 0.2  # widths of the shoulders: of a chest from between them, of a spine sideways
FLAT = 0.001  # heights of the body
HEADROOM = 0.04  # heights of the body, of the head above the shoulders


def disproportion(body: Body) -> float:
    """Mean |log| of bone lengths against those of a body of this height; nan for points that are all in one place."""
    if not body.height > 0.0:
        return np.nan
    with np.errstate(divide="ignore"):
        ratios = [np.log(length / bone.length / body.height) for bone, length in body.medians.items()]
    return float(np.mean(np.minimum(np.abs(ratios), MOST))) if ratios else np.nan


def misfits(body: Body) -> dict[Bone, float]:
    """How far each bone's |log| of length is beyond all that bodies and sensors have; only those that are."""
    found = {}
    for bone, length in body.medians.items():
        ratio = abs(float(np.log(max(length, 1e-9 * body.height) / bone.length / body.height)))
        beyond = ratio - (SLACK if bone.length >= LONG else SHORT_SLACK)
        if beyond > 0.0:
            found[bone] = beyond
    return found


def wobble(body: Body) -> float:
    """How much the three least steady of the longer bones change: mean of their MAD / median."""
    spreads = [
        median(np.abs(known - body.medians[bone])) / max(body.medians[bone], 0.01 * body.height)
        for bone, known in body.lengths.items()
        if bone.length >= STEADY
    ]
    return float(np.mean(sorted(np.minimum(spreads, 1.0))[-3:])) if spreads else 0.0


def lopsidedness(body: Body) -> float:
    """Mean |log| of left against right bone lengths."""
    named = {(bone.start, bone.end): length for bone, length in body.medians.items()}
    pairs = [
        (length, named[other])
        for (start, end), length in named.items()
        if start.startswith("left_") and (other := (twin(start), twin(end))) in named and other != (end, start)
    ]
    least = 0.001 * body.height
    ratios = [abs(np.log(max(left, least) / max(right, least))) for left, right in pairs]
    return float(np.mean(np.minimum(ratios, MOST))) if ratios else 0.0


def upside_down(body: Body, up: Array) -> float:
    """Share of frames in which joints are in the wrong order along `up` (3,): head, shoulders, hips, ankles."""
    feet = body.first(("left_ankle", "right_ankle"), ("left_foot", "right_foot"))
    knees = body.track("left_knee", "right_knee")
    pairs = [
        (body.head - HEADROOM * body.height * up, body.shoulders),
        (body.shoulders, body.hips),
        (body.hips, feet),
        (knees, feet),
    ]
    pairs += [(body.hips + 0.1 * body.height * up, knees)]  # who sits may have the knees a little higher
    shares = [np.mean(gap[np.isfinite(gap)] < 0.0) for gap in ((a - b) @ up for a, b in pairs) if len(gap)
              and np.isfinite(gap).any()]  # fmt: skip
    return float(np.mean(shares)) if shares else 0.0


def is_flat(body: Body) -> bool:
    """Whether the body has no depth in one of the axes."""
    away = np.abs(body.values - body.shoulders[:, None, :])
    return bool(min(median(away[:, :, axis]) for axis in range(3)) < FLAT * body.height)


def crookedness(body: Body) -> float:
    """How far the trunk and the legs are from how people hold them, 0 to about 1 for each way.

    Shoulders and hips are square to the trunk and parallel, the head goes
    on where the trunk ends, legs are rarely bent to less than a chair asks
    for, elbows, knees and ankles stay on their sides; chest and pelvis are between shoulders and hips.
    """
    across, hips = body.leftward, unit(body.track("left_hip") - body.track("right_hip"))
    trunk = unit(body.shoulders - body.hips)
    off = [
        np.abs(ahead(across, trunk)) - SQUARE,
        np.abs(ahead(hips, trunk)) - SQUARE,
        PARALLEL - ahead(across, hips),
        PARALLEL - ahead(trunk, unit(body.head - body.shoulders)),
        BENT - (_straightness(body, "left") + _straightness(body, "right")) / 2,
        *(_crossing(body, part) for part in ("elbow", "knee", "ankle", "foot")),
        _away(body, "chest", "shoulder") - CENTRED,
        _away(body, "pelvis", "hip") - CENTRED,
        _aside(body, "spine", body.hips),
        _aside(body, "neck", body.shoulders),
    ]
    return float(np.nansum([max(median(amount), 0.0) for amount in off]))


def _away(body: Body, centre: str, part: str) -> Array:
    """How far a joint of the midline is from between two others, in widths of the shoulders, (S,)."""
    left, right = body.track(f"left_{part}"), body.track(f"right_{part}")
    away: Array = np.linalg.norm(body.track(centre) - (left + right) / 2, axis=1) / body.width
    return away


def _aside(body: Body, joint: str, of: Array) -> Array:
    """How much too far to a side a joint of the midline is, in widths of the shoulders, (S,)."""
    return np.abs(ahead(body.track(joint) - of, body.leftward)) / body.width - ASIDE


def _crossing(body: Body, part: str) -> Array:
    """How far a left joint is on the right of the right one, in widths of the shoulders, (S,)."""
    return ahead(body.track(f"right_{part}") - body.track(f"left_{part}"), body.leftward) / body.width


def _straightness(body: Body, side: str) -> Array:
    """From hip to ankle in lengths of the leg, (S,)."""
    hip, knee = body.track(f"{side}_hip"), body.track(f"{side}_knee")
    ankle = body.limb(f"{side}_ankle")
    leg = np.linalg.norm(knee - hip, axis=1) + np.linalg.norm(ankle - knee, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        straight: Array = np.linalg.norm(ankle - hip, axis=1) / leg
    return straight
