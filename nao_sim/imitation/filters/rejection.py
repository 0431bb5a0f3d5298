"""Points that cannot be right: seen without confidence, on a bone of another length, or there and back too fast.

What is rejected becomes missing; nothing is moved.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nao_sim import body
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, Mask

CONFIDENCE, BONE, JUMP = "confidence", "bone length", "jump"  # why a point is rejected, in the order of the checks
MIN_CONFIDENCE = 0.2  # a joint that a Kinect infers has more
MAX_ACCELERATION = 200.0  # m/s^2; a 3 Hz wave of 0.3 m takes 107, and shared recordings of fast gestures 100 to 200
MAX_SPEED = 12.0  # m/s; a boxer's fist reaches 9 (Walilko, Viano and Bir, Br. J. Sports Med. 39, 2005)
_SLACK = 0.03  # m, a jump that small is noise and left to the smoothing
_LONG = 0.9  # of the lengths that a bone has in a picture are shorter than the bone itself
_BONE_SLACK = 0.05  # m, a change of length that small is left, too
_FEW = 5  # frames, the fewest that tell what is usual, and the most that a jump there and back takes
_NORMAL = 1.4826  # standard deviations in a median absolute deviation of normal noise
_SPREAD = 5.0  # standard deviations that are usual for a bone, or medians for noise


@dataclass(frozen=True)
class Reject:
    """Makes points missing that cannot be right.

    Attributes:
        min_confidence: points below are rejected.
        bone_range: a bone is wrong where its length is outside these shares of its median, and by more than 5 cm and
            five standard deviations off it; the joint that most wrong bones meet in is to blame, of two the outer.
            Depth cameras see a limb that points at them half as long, so there is more room below.
        max_acceleration: m/s^2, a stretch of up to five frames is rejected where it lies farther from the way between
            the frames around it than this allows, |d| > a (t - t0)(t1 - t) / 2, and that way is shorter than d.
        max_speed: m/s, up to five frames at either end are rejected where it takes more to come from there.
    """

    min_confidence: float = MIN_CONFIDENCE
    bone_range: tuple[float, float] = (0.35, 1.4)
    max_acceleration: float = MAX_ACCELERATION
    max_speed: float = MAX_SPEED

    def filter(self, skeleton: Skeleton) -> Skeleton:
        """The skeleton without those points; their confidence is 0."""
        return without(skeleton, self.find(skeleton))

    def find(self, skeleton: Skeleton) -> Mapping[str, Mask]:
        """Which points are wrong, (T, J) by reason; each point has one reason at most."""
        confidence = _there(skeleton) & (skeleton.confidence < self.min_confidence)
        found = {CONFIDENCE: confidence}
        left = without(skeleton, found)
        found[BONE] = _wrong_bones(left, self.bone_range)
        left = without(left, found)
        columns = [self._jumps(left.times, left.positions[:, joint]) for joint in range(len(left.joints))]
        found[JUMP] = np.stack(columns, axis=1) if columns else np.zeros((len(left), 0), bool)
        return found

    def _jumps(self, times: Array, track: Array) -> Mask:
        """Which frames (T,) of a track (T, 3) are jumps there and back."""
        there = np.flatnonzero(np.isfinite(track).all(axis=1))
        wrong = np.zeros(len(times), bool)
        if len(there) >= _FEW:
            wrong[there] = _spikes(times[there], track[there], self.max_acceleration)
            there = there[~wrong[there]]
            wrong[there] |= _false_ends(times[there], track[there], self.max_speed)
        return wrong


def without(skeleton: Skeleton, found: Mapping[str, Mask]) -> Skeleton:
    """The skeleton with the points of all masks (T, J) missing."""
    wrong = np.zeros(skeleton.confidence.shape, bool)
    for mask in found.values():
        wrong |= mask
    return replace(skeleton, positions=np.where(wrong[:, :, None], np.nan, skeleton.positions))


def _there(skeleton: Skeleton) -> Mask:
    return np.asarray(np.isfinite(skeleton.positions).all(axis=2))


def _wrong_bones(skeleton: Skeleton, share: tuple[float, float]) -> Mask:
    """Which points (T, J) are to blame for bones of a wrong length."""
    index = {name: joint for joint, name in enumerate(skeleton.joints)}
    bones = [(index[bone.start], index[bone.end]) for bone in body.bones() if _is_stiff(bone) and
             bone.start in index and bone.end in index]  # fmt: skip
    wrong = np.zeros((len(skeleton), len(index)), bool)
    if not bones:
        return wrong
    starts, ends = np.array(bones).T
    lengths = np.linalg.norm(skeleton.positions[:, starts] - skeleton.positions[:, ends], axis=2)
    broken = np.stack([_unusual(column, share, skeleton.planar) for column in lengths.T], axis=1)
    frames = broken.any(axis=1)
    wrong[frames] = _blame(broken[frames], starts, ends, len(index))
    return wrong


def _is_stiff(bone: body.Bone) -> bool:
    """Shoulders and hips slide towards each other; every other bone keeps its length."""
    return body.twin(bone.start) != bone.end


def _unusual(lengths: Array, share: tuple[float, float], planar: bool) -> Mask:
    """Where (T,) a bone's length is far off; in a picture a bone may look shorter than it is, but not longer."""
    known = lengths[np.isfinite(lengths)]
    if len(known) < _FEW:
        return np.zeros(len(lengths), bool)
    if planar:
        return lengths > share[1] * np.quantile(known, _LONG) + _BONE_SLACK
    typical = np.median(known)
    usual = max(_SPREAD * _NORMAL * np.median(np.abs(known - typical)), _BONE_SLACK)
    shortest, longest = np.minimum(share[0] * typical, typical - usual), np.maximum(share[1] * typical, typical + usual)
    return (lengths < shortest) | (lengths > longest)


def _blame(broken: Mask, starts: NDArray[np.int_], ends: NDArray[np.int_], joints: int) -> Mask:
    """Joints (T, J) that account for all broken bones (T, B), the joint with most of them first."""
    at_start, at_end = (np.eye(joints, dtype=int)[side] for side in (starts, ends))  # (B, J)
    blamed, left = np.zeros((len(broken), joints), bool), broken.copy()
    while left.any():
        # many bones count most; of the two ends of a bone, the outer moves more
        score = left @ (len(starts) * (at_start + at_end) + at_end)
        worst = (score == score.max(axis=1, keepdims=True)) & (score > 0)
        blamed |= worst
        left &= ~(worst @ (at_start + at_end).T > 0)
    return blamed


def _spikes(times: Array, track: Array, acceleration: float) -> Mask:
    """Frames (N,) that belong to a stretch which leaves the way between its neighbours and comes back."""
    wrong = np.zeros(len(times), bool)
    usual = np.median(_aside(times, track, 1)[1][:, 0]) if len(times) > 2 else 0.0  # noqa: PLR2004
    slack = max(_SLACK, _SPREAD * float(usual))
    for width in range(1, min(_FEW, len(times) - 2) + 1):
        room, away = _aside(times, track, width)
        way = np.linalg.norm(track[width + 1 :] - track[: -width - 1], axis=1)
        outside = (away > acceleration * room / 2.0 + slack).all(axis=1) & (way < away.min(axis=1))
        for offset in range(width):
            wrong[1 + offset : len(times) - width + offset] |= outside
    return wrong


def _aside(times: Array, track: Array, width: int) -> tuple[Array, Array]:
    """How far `width` frames lie from the straight way between the frames around them.

    Returns:
        (t - t0)(t1 - t) in s^2 and the distances in m, both (N - width - 1, width).
    """
    windows = np.lib.stride_tricks.sliding_window_view
    t, x = windows(times, width + 2), windows(track, width + 2, axis=0)  # (M, W + 2), (M, 3, W + 2)
    before, after = t[:, 1:-1] - t[:, :1], t[:, -1:] - t[:, 1:-1]
    share = (before / (before + after))[:, None]
    way = x[..., :1] * (1.0 - share) + x[..., -1:] * share
    return before * after, np.linalg.norm(x[..., 1:-1] - way, axis=1)


def _false_ends(times: Array, track: Array, speed: float) -> Mask:
    """Frames (N,) before a jump near the start, and after one near the end."""
    wrong = np.zeros(len(times), bool)
    far = np.linalg.norm(np.diff(track, axis=0), axis=1) > speed * np.diff(times) + _SLACK
    first, last = np.flatnonzero(far[:_FEW]), np.flatnonzero(far[-_FEW:])
    if len(times) > 2 * _FEW:
        wrong[: first[-1] + 1 if len(first) else 0] = True
        wrong[len(times) - (min(_FEW, len(far)) - last[0]) if len(last) else len(times) :] = True
    return wrong
