"""Recognition while a person moves: a frame in, a decision out, never looking ahead.

Files are recognised by the same objects, frame after frame (`stream_poses`).
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from nao_sim.gestures.poses import NONE, PoseRecogniser
from nao_sim.gestures.reader import FrameReader
from nao_sim.motion import Skeleton
from nao_sim.robot import Array

HOLD = 0.13  # s, over which evidence is gathered; four frames of a Kinect
STILL = math.radians(2.0)  # arms that hold a pose turn no farther between thirds of `HOLD`, but for
MOVED = math.radians(12.0)  # a segment that turns farther from where it was has moved; noise of 1 cm turns it by 5
DOUBT = 4.0  # times what the sensor's noise turns a segment by in a frame
NOISE_OVER = 0.4  # s, over which that noise is measured
NOISIEST = math.radians(4.0)  # what of it is taken for noise; 1 cm turns a forearm by 3
SURE = 0.5  # an announced pose is likelier than all else together
LOYAL = 0.5  # an announced pose stays until another is likelier by its inverse
PAUSE = 0.5  # s without frames, after which what was before counts no more

_FEWEST = 4  # frames from which on noise and movement can be told apart: it takes their third differences
_THIRD_DIFFERENCE = math.sqrt(20.0)  # how much larger the noise is in them: 1, 3, 3 and 1 squared


@dataclass(frozen=True)
class Decision:
    """What is recognised at an instant.

    Attributes:
        time: s, of the frame.
        label: the announced pose, or `none`.
        confidence: probability of that label, the mean over `HOLD`.
        since: s, when the label was announced.
    """

    time: float
    label: str
    confidence: float
    since: float


class PoseStream:
    """Follows one person; it has a state.

    A pose is announced when it is likelier than all else over the last `HOLD`
    seconds and the arms were still in them, so that arms passing through a pose
    do not announce it.  It ends when another pose or `none` is clearly likelier.

    Args:
        recogniser: the poses to tell.
        joints: (J,) names of the rows of the frames.
        planar: whether one camera sees the person and x is 0 throughout.
    """

    def __init__(self, recogniser: PoseRecogniser, joints: tuple[str, ...], planar: bool = False) -> None:
        self._recogniser, self._reader = recogniser, FrameReader(joints, planar)
        self._labels = (*recogniser.names, NONE)
        self.reset()

    def reset(self) -> None:
        """Forget the person."""
        self._recent: deque[tuple[float, Array]] = deque()  # time, probabilities
        self._arms: deque[tuple[float, Array]] = deque()  # time, directions, 0 where unknown
        self._sum = np.zeros(len(self._labels))  # of the probabilities
        self._label, self._since = len(self._labels) - 1, -math.inf
        self._anchor: tuple[float, Array] | None = None  # when arms came to be about where they are, and where

    @property
    def still_since(self) -> float:
        """When (s) the arms were last moved: since then no segment has turned by more than `MOVED`."""
        return self._anchor[0] if self._anchor else math.inf

    def update(self, positions: Array, time: float, confidence: Array | None = None) -> Decision:
        """Take one frame.

        Args:
            positions: (J, 3) m, x forward, y left, z up in a frame that stays
                where it is; nan where missing.
            time: s, after the last frame's.
            confidence: (J,) from 0 to 1; 1 throughout where None.

        Raises:
            ValueError: time does not go on, or the frame has other joints.
        """
        last = self._recent[-1][0] if self._recent else -math.inf
        if not (math.isfinite(time) and time > last):
            raise ValueError(f"time {time} s after {last} s; expected times that increase")
        directions, trust, seen = self._reader.read(positions, confidence)
        shares = self._recogniser.weigh(directions[None], trust[None], seen[None], self._reader.planar)[0]
        self._remember(time, shares, np.where(trust[..., None] > 0.0, directions, 0.0))
        self._follow(time, np.nan_to_num(directions))
        mean = self._sum / len(self._recent)
        self._choose(time, mean)
        return Decision(time, self._labels[self._label], float(mean[self._label]), self._since)

    def _remember(self, time: float, shares: Array, directions: Array) -> None:
        if self._recent and time - self._recent[-1][0] > PAUSE:
            self.reset()
        self._recent.append((time, shares))
        self._arms.append((time, directions))
        self._sum += shares
        while time - self._recent[0][0] > HOLD * 1.001:  # times of files are rounded
            self._sum -= self._recent.popleft()[1]
        while time - self._arms[0][0] > NOISE_OVER:
            self._arms.popleft()

    def _follow(self, time: float, directions: Array) -> None:
        """Note when the arms move, those not trusted included."""
        if self._anchor is None or not _alike(self._anchor[1], directions):
            self._anchor = time, directions

    def _choose(self, time: float, mean: Array) -> None:
        none = len(self._labels) - 1
        best = int(mean.argmax())
        if best == self._label or mean[self._label] > LOYAL * mean[best]:
            self._since = time if math.isinf(self._since) else self._since
            return
        sure = best == none or (mean[best] > SURE and self._still())
        self._label, self._since = (best if sure else none), time

    def _still(self) -> bool:
        """Whether the arms were still for long enough, as far as the sensor's noise lets one see."""
        first, last = self._recent[0][0], self._recent[-1][0]
        steps = len(self._recent) - 1
        if steps < 1 or last - first < HOLD - (last - first) / steps:
            return False
        arms = np.stack([directions for _, directions in self._arms])
        held = arms[-len(self._recent) :]
        known = (held != 0.0).any(axis=-1).all(axis=0)
        thirds = np.stack([part.mean(axis=0) for part in np.array_split(held[:, known], min(3, len(held)))])
        turned = np.linalg.norm(thirds[:, None] - thirds, axis=-1).max(initial=0.0)
        return bool(turned < STILL + DOUBT * _noise(arms[:, known]))


def _noise(arms: Array) -> float:
    """Standard deviation of a coordinate of directions (T, S, 3) that the sensor's noise makes, not the movement."""
    if len(arms) < _FEWEST or not arms.size:
        return NOISIEST / 2.0
    return min(float(np.sqrt(np.mean(np.diff(arms, n=3, axis=0) ** 2))) / _THIRD_DIFFERENCE, NOISIEST)


def _alike(one: Array, other: Array) -> bool:
    """Whether no segment that both directions (2, 2, 3) know, 0 where unknown, has turned by more than `MOVED`."""
    known = (one != 0.0).any(axis=-1) & (other != 0.0).any(axis=-1)
    return bool(((one * other).sum(axis=-1)[known] > math.cos(MOVED)).all())


def stream_poses(recogniser: PoseRecogniser, skeleton: Skeleton) -> tuple[Decision, ...]:
    """The decisions (T,) over a recording, frame after frame as in a stream."""
    stream = PoseStream(recogniser, skeleton.joints, skeleton.planar)
    frames = zip(skeleton.positions, skeleton.times.tolist(), skeleton.confidence, strict=True)
    return tuple(stream.update(*frame) for frame in frames)


@dataclass(frozen=True)
class Segment:
    """A stretch over which the same was announced.

    Attributes:
        label: what.
        start: s, when it was announced.
        end: s, when it ended.
        confidence: the mean over it.
    """

    label: str
    start: float
    end: float
    confidence: float


def segments_of(decisions: tuple[Decision, ...]) -> tuple[Segment, ...]:
    """The stretches of one label each, those of `none` left out."""
    found: list[list[Decision]] = []
    for decision in decisions:
        if found and found[-1][-1].label == decision.label:
            found[-1].append(decision)
        else:
            found.append([decision])
    ends = [stretch[0].time for stretch in found[1:]] + [decisions[-1].time] if decisions else []
    return tuple(
        Segment(stretch[0].label, stretch[0].time, end, float(np.mean([each.confidence for each in stretch])))
        for stretch, end in zip(found, ends, strict=True)
        if stretch[0].label != NONE
    )
