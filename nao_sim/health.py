"""How good a recording is: frame times; dropouts, jitter and bones of people; ranges and speeds of joint angles."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from nao_sim import body
from nao_sim.imitation.filters import Smooth
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import Array, Mask, Robot

GAP = 1.75  # median intervals; a longer one means that frames are missing
_NORMAL = 1.4826  # standard deviations in a median absolute deviation of normal noise
_FINGER = re.compile(r"(left|right)_(?:thumb|index|middle|ring|pinky)_")
_FEW = 4  # frames, the fewest that tell jitter from motion
_EDGE = 1e-4  # rad: at a limit, as files round it


@dataclass(frozen=True)
class Clock:
    """When the frames are.

    Attributes:
        frames: how many.
        duration: s, from the first to the last.
        rate: Hz, of the median interval; None of a single frame.
        unevenness: standard deviation of the intervals, robust, as a share of the median; None of a single frame.
        gaps: intervals longer than `GAP` medians.
        longest: s, the longest interval; None of a single frame.
        repeated: frames with exactly the values of the one before, as slow trackers and copied frames give.
    """

    frames: int
    duration: float
    rate: float | None
    unevenness: float | None
    gaps: int
    longest: float | None
    repeated: int


@dataclass(frozen=True)
class JointHealth:
    """How well a joint of a person was tracked.

    Attributes:
        joint: its name.
        seen: share of the frames that have it.
        gaps: stretches without it.
        longest_gap: s, the longest of them, between the frames around it (or the recording's end).
        confidence: mean, where it is seen; None where it never is.
        jitter: m, rms distance from its own track smoothed at 6 Hz without lag, without jumps; None where the frames do
            not tell.
    """

    joint: str
    seen: float
    gaps: int
    longest_gap: float
    confidence: float | None
    jitter: float | None


@dataclass(frozen=True)
class BoneHealth:
    """How well a bone keeps its length.

    Attributes:
        start: the joint it begins at.
        end: the joint it ends at.
        length: m, median.
        spread: standard deviation, robust, as a share of the median.
        longer: than the same bone of the other side, by this share of their mean; None where there is no other.
    """

    start: str
    end: str
    length: float
    spread: float
    longer: float | None


@dataclass(frozen=True)
class AngleHealth:
    """What is asked of a joint of the robot, in rad (hands 0 to 1).

    Attributes:
        joint: its NAOqi name.
        seen: share of the frames that ask something of it.
        lowest: the least asked.
        highest: the most asked.
        lower: the robot's limit.
        upper: the robot's limit.
        beyond: share of the frames that ask for more than the limits.
        speed: per second, the fastest change between two frames; None of a single frame.
        speed_ratio: of the fastest that the motor follows; None of a single frame.
    """

    joint: str
    seen: float
    lowest: float
    highest: float
    lower: float
    upper: float
    beyond: float
    speed: float | None
    speed_ratio: float | None


def clock(motion: Skeleton | JointTrajectory) -> Clock:
    """When the frames of a recording are."""
    same = _unchanged(motion.positions.reshape(len(motion), -1))
    if len(motion) == 1:
        return Clock(1, 0.0, None, None, 0, None, 0)
    intervals = np.diff(motion.times)
    typical = float(np.median(intervals))
    spread = _NORMAL * float(np.median(np.abs(intervals - typical)))
    gaps = int((intervals > GAP * typical).sum())
    longest = float(intervals.max())
    return Clock(len(motion), motion.duration, 1.0 / typical, spread / typical, gaps, longest, same)


def _unchanged(values: Array) -> int:
    """How many frames (T, N) are exactly as the one before, and hold something."""
    equal = (values[1:] == values[:-1]) | (np.isnan(values[1:]) & np.isnan(values[:-1]))
    return int((equal.all(axis=1) & np.isfinite(values[1:]).any(axis=1)).sum())


def joint_health(skeleton: Skeleton, cleaned: Skeleton) -> tuple[JointHealth, ...]:
    """How well each joint was tracked.

    Args:
        skeleton: the person as recorded.
        cleaned: the person after `imitation.filters.clean` without smoothing.
    """
    there, shaking = _there(skeleton), jitter(skeleton, cleaned)
    found = []
    for i, joint in enumerate(skeleton.joints):
        gaps = _gaps(skeleton.times, there[:, i])
        sure = float(skeleton.confidence[there[:, i], i].mean()) if there[:, i].any() else None
        moving = None if np.isnan(shaking[i]) else float(shaking[i])
        found.append(JointHealth(joint, float(there[:, i].mean()), len(gaps), max(gaps, default=0.0), sure, moving))
    return tuple(found)


def jitter(skeleton: Skeleton, cleaned: Skeleton) -> Array:
    """Rms distance (J,) m of each joint from its own track smoothed at 6 Hz; nan where nothing tells.

    What the filters reject is left out, else a single jump hides what all other
    frames are like; what they fill in does not count.
    """
    smooth = Smooth()
    interval = float(np.median(np.diff(skeleton.times))) if len(skeleton) >= _FEW else np.inf
    if smooth.cutoff * interval >= 0.5:  # noqa: PLR2004  the frames are too seldom to hold what is above the cutoff
        return np.full(len(skeleton.joints), np.nan)
    full = replace(cleaned, confidence=np.ones(()))
    squares = np.sum((full.positions - smooth.filter(full).positions) ** 2, axis=2)
    known = np.asarray((skeleton.positions == cleaned.positions).all(axis=2))
    total, count = np.where(known, squares, 0.0).sum(axis=0), known.sum(axis=0)
    return np.sqrt(np.where(count >= _FEW, total / np.maximum(count, 1), np.nan))


def bone_health(skeleton: Skeleton) -> tuple[BoneHealth, ...]:
    """How well each bone keeps its length, of those that were ever seen."""
    lengths = {(bone.start, bone.end): bone_lengths(skeleton, bone) for bone in body.bones()}
    medians = {ends: float(np.nanmedian(each)) for ends, each in lengths.items() if np.isfinite(each).any()}
    found = []
    for (start, end), length in medians.items():
        spread = _NORMAL * float(np.nanmedian(np.abs(lengths[start, end] - length)))
        twin = body.twin(start), body.twin(end)
        longer = None if twin == (start, end) else _longer(length, medians.get(twin))
        found.append(BoneHealth(start, end, length, spread / length if length else 0.0, longer))
    return tuple(found)


def _longer(length: float, other: float | None) -> float | None:
    """By which share of their mean one bone is longer than the other."""
    return None if other is None else 2.0 * (length - other) / ((length + other) or 1.0)


def bone_lengths(skeleton: Skeleton, bone: body.Bone) -> Array:
    """Lengths (T,) m; nan where one of its ends is missing."""
    return np.asarray(np.linalg.norm(skeleton.track(bone.start) - skeleton.track(bone.end), axis=1))


def angle_health(motion: JointTrajectory, robot: Robot) -> tuple[AngleHealth, ...]:
    """What is asked of each joint that the recording speaks of and ever moves."""
    found = []
    for i in np.flatnonzero(motion.given):
        known = np.isfinite(motion.positions[:, i])
        if known.any():
            values = motion.positions[known, i]
            limits = float(robot.lower[i]), float(robot.upper[i])
            beyond = beyond_limits(values, *limits)
            speed = _top_speed(motion.times[known], values)
            ratio = None if speed is None else speed / float(robot.max_speed[i])
            share, wrong = float(known.mean()), float(beyond.sum() / len(motion))
            extremes = float(values.min()), float(values.max())
            found.append(AngleHealth(robot.joint_names[i], share, *extremes, *limits, wrong, speed, ratio))
    return tuple(found)


def beyond_limits(values: Array, lower: float, upper: float) -> Mask:
    """Where values are outside of the limits, not counting how files round them."""
    return np.asarray((values < lower - _EDGE) | (values > upper + _EDGE))


def _top_speed(times: Array, values: Array) -> float | None:
    return float(np.max(np.abs(np.diff(values) / np.diff(times)))) if len(times) > 1 else None


def _there(skeleton: Skeleton) -> Mask:
    return np.asarray(np.isfinite(skeleton.positions).all(axis=2))


def _gaps(times: Array, there: Mask) -> list[float]:
    """How long (s) each stretch without the joint is, to the frames around it."""
    edges = np.flatnonzero(np.diff(np.concatenate([[1], there.astype(int), [1]])))
    last = len(times) - 1
    return [
        float(times[min(end, last)] - times[max(start - 1, 0)])
        for start, end in zip(edges[::2], edges[1::2], strict=True)
    ]


def together(joints: Sequence[str]) -> dict[str, list[int]]:
    """Where each of the joints stands, in the body's order; the joints of a hand's fingers stand together."""
    order = {joint: place for place, joint in enumerate(body.joints())}
    rows: dict[str, list[int]] = {}
    for place in sorted(range(len(joints)), key=lambda place: order.get(joints[place], len(order))):
        side = _FINGER.match(joints[place])
        rows.setdefault(f"{side[1]}_fingers" if side else joints[place], []).append(place)
    return {name if len(places) > 1 else joints[places[0]]: places for name, places in rows.items()}


@cache
def expected_joints() -> tuple[str, ...]:
    """The joints that some bone of the body ends at: what a whole-body recording has."""
    ends = [end for bone in body.bones() for end in (bone.start, bone.end)]
    return tuple(joint for joint in body.joints() if joint in ends)
