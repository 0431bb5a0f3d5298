"""A stretch of a person's movement, and the numbers that tell one movement from another.

Recordings of a movement begin and end anywhere in it, and it may be repeated
any number of times; so the numbers say where the arms are, how fast and along
which lines they move, and how they move together, not when.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from nao_sim import body
from nao_sim.gestures.directions import bone_length, readings_of_arms
from nao_sim.imitation.person import arm_directions, first_known, torso_frames, wrist
from nao_sim.motion import Skeleton
from nao_sim.robot import Array, read_only

RATE = 30.0  # Hz, at which movements are compared
FEWEST = 8  # frames of a window, a quarter of a second
ONE_HANDED = 0.3  # arm lengths between the mean heights of the wrists, from which on one arm does the movement
_NEAR = 0.3  # forearms between wrist and hand, at which the direction of a hand is half sure
_ADULT = 1.7  # m, of whom noise in metres is told
_HANGING = np.array([0.0, 0.0, -1.0])
_MIRROR = np.array([1.0, -1.0, 1.0])
_PLACES = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)  # quantiles of where the arms are
_SPEEDS = (0.5, 0.75, 0.9, 1.0)  # and of how fast
_SMOOTH = 2.0  # frames, the standard deviation of the Gaussian that tracks are smoothed with
_LASTING = 1.5  # frames, the same of sensors' noise: it lasts about 0.1 s
_SLOW = 0.1  # arm lengths/s, below which a direction of motion says little
_LITTLE = 0.02  # arm lengths, below which a correlation says little
_TRIANGLE = np.triu_indices(6)
_OFF_DIAGONAL = np.triu_indices(6, 1)
_NEIGHBOURS = 3  # frames, of which a point that is thrown off is one
_TENSOR = np.triu_indices(3)


@dataclass(frozen=True, eq=False)
class Window:
    """How the arms moved in a stretch of time.

    Attributes:
        segments: (T, 2, 3, 3) at `RATE`, x forward, y left, z up: side (left,
            right), segment (upper arm, forearm, hand), coordinate; unit vectors
            but for the hands', which are `hand_vectors`.
        hands: whether hands are tracked.
    """

    segments: Array
    hands: bool

    def __post_init__(self) -> None:
        object.__setattr__(self, "segments", read_only(self.segments))
        if self.segments.ndim != 4 or self.segments.shape[1:] != (2, 3, 3) or len(self) < FEWEST:  # noqa: PLR2004
            raise ValueError(f"segments has shape {self.segments.shape}; expected (T, 2, 3, 3) with T >= {FEWEST}")

    def __len__(self) -> int:
        return len(self.segments)

    def mirrored(self) -> Window:
        """The movement in a mirror."""
        return Window(self.segments[:, ::-1] * _MIRROR, self.hands)

    def turned(self, rotation: Array) -> Window:
        """The movement of a person whose torso is taken for turned by a rotation (3, 3)."""
        return Window(self.segments @ rotation.T, self.hands)

    def shaken(self, metres: float) -> Window:
        """The movement as a sensor tells it whose joints wander with a standard deviation; always the same."""
        noise = gaussian_filter1d(np.random.default_rng(0).normal(size=self.segments.shape), _LASTING, axis=0)
        spread = (
            np.sqrt(2.0) * metres / (_ADULT * bone_length("left_shoulder", "left_elbow"))
        )  # of two ends of a segment
        noise *= spread / noise.std()
        segments = self.segments + noise * [[1.0], [1.0], [1.0 if self.hands else 0.0]]
        arms = segments[:, :, :2] / np.linalg.norm(segments[:, :, :2], axis=-1, keepdims=True)
        return Window(np.concatenate([arms, segments[:, :, 2:]], axis=2), self.hands)

    @property
    def left_handed(self) -> bool:
        """Whether the left arm alone does the movement, the right one being lower by `ONE_HANDED`."""
        return self._lift > ONE_HANDED

    @property
    def two_handed(self) -> bool:
        """Whether neither arm does the movement alone."""
        return abs(self._lift) <= ONE_HANDED

    @property
    def _lift(self) -> float:
        heights = _wrists(self.segments)[..., 2].mean(axis=0)
        return float(heights[0] - heights[1])


def window_of(skeleton: Skeleton, start: float | None = None, end: float | None = None) -> Window:
    """The movement of a recording, or of a stretch of it.

    Args:
        skeleton: the person.
        start: s, the first instant; the first frame's where None.
        end: s, the last instant; the last frame's where None.

    Raises:
        ValueError: the stretch is shorter than `FEWEST` frames at `RATE`.
    """
    torso = torso_frames(skeleton)
    readings = readings_of_arms(skeleton, arm_directions(skeleton, torso))
    arms = _without_spikes(np.where(readings.trust[..., None] > 0.0, readings.directions, np.nan))
    palms = _without_spikes(hand_vectors(skeleton, torso))
    first, last = (skeleton.times[end] if at is None else at for end, at in ((0, start), (-1, end)))
    grid = np.arange(first, last + 1e-9, 1.0 / RATE)
    segments = np.empty((len(grid), 2, 3, 3))
    for side in range(2):
        for segment in range(2):
            segments[:, side, segment] = _unit(_resampled(grid, skeleton.times, arms[:, side, segment], _HANGING))
        segments[:, side, 2] = _resampled(grid, skeleton.times, palms[:, side], np.zeros(3))
    tracked = np.isfinite(palms[..., 0]).sum(axis=1) > 0
    return Window(segments, bool(2 * tracked.sum() > len(palms)))


def hand_vectors(skeleton: Skeleton, torso: Array) -> Array:
    """Where hands point, seen from the torso (T, 3, 3), and how surely.

    Points of hands are near wrists, so their direction is the surer the farther
    they are from them: v / (|v| + `_NEAR` forearms), 1 long at most.

    Returns:
        (T, 2, 3), nan where a hand is not tracked.
    """
    palms = [np.einsum("tji,tj->ti", torso, _palm(skeleton, side)) for side in body.SIDES]
    forearms = [np.linalg.norm(wrist(skeleton, side) - skeleton.track(f"{side}_elbow"), axis=1) for side in body.SIDES]
    known = np.concatenate(forearms)[np.isfinite(np.concatenate(forearms))]
    vectors = np.stack(palms, axis=1)
    near = _NEAR * (float(np.median(known)) if known.size else np.nan)
    return vectors / (np.linalg.norm(vectors, axis=-1, keepdims=True) + near)


def measures(window: Window) -> Array:
    """The numbers that describe a movement, those of hands last (`HAND_MEASURES` of them).

    Per coordinate of arm segments and of wrists (seen from the shoulder, in arm
    lengths): quantiles, mean and spread of where it is, and of how fast it
    changes; of both wrists together: covariances of places and of velocities
    and their correlations, speeds, and along which lines they move (mean
    products of the directions of motion).
    """
    arms = window.segments[:, :, :2].reshape(len(window), -1)
    wrists = _wrists(window.segments).reshape(len(window), -1)
    hands = window.segments[:, :, 2].reshape(len(window), -1)
    smooth = _smoothed(np.concatenate([arms, wrists, hands], axis=1))
    speeds = np.abs(np.diff(smooth, axis=0)) * RATE
    alone = np.concatenate([_summary(smooth, _PLACES), _summary(speeds, _SPEEDS)])
    joint = _together(smooth[:, 12:18])
    return np.concatenate([alone[:, :18].ravel(), joint, alone[:, 18:].ravel()])


HAND_MEASURES = 6 * (len(_PLACES) + len(_SPEEDS) + 4)


def _together(wrists: Array) -> Array:
    """How both wrists (T, 6) move."""
    velocities = np.diff(wrists, axis=0) * RATE
    speeds = np.linalg.norm(velocities.reshape(-1, 2, 3), axis=2)
    lines = velocities.reshape(-1, 2, 3) / (speeds + _SLOW)[..., None]
    products = np.einsum("tai,tbj->abij", lines, lines) / len(lines)
    found = [
        _summary(speeds, _PLACES).ravel(),
        products[0, 0][_TENSOR],
        products[1, 1][_TENSOR],
        products[0, 1].ravel(),
    ]
    for tracks in (wrists, velocities):
        covariance = np.cov(tracks.T)
        spread = np.sqrt(np.diag(covariance)) + _LITTLE
        found += [covariance[_TRIANGLE], (covariance / np.outer(spread, spread))[_OFF_DIAGONAL]]
    return np.concatenate(found)


def _summary(tracks: Array, quantiles: tuple[float, ...]) -> Array:
    """(Q + 2, C): quantiles, mean and standard deviation of tracks (T, C)."""
    ordered = np.sort(tracks, axis=0)
    places = np.array(quantiles) * (len(tracks) - 1)
    low = places.astype(int)
    high = np.minimum(low + 1, len(tracks) - 1)
    between = ordered[low] + (places - low)[:, None] * (ordered[high] - ordered[low])
    return np.concatenate([between, tracks.mean(axis=0)[None], tracks.std(axis=0)[None]])


def _wrists(segments: Array) -> Array:
    """(T, 2, 3) where the wrists are from their shoulders, in arm lengths of a usual arm."""
    upper, fore = bone_length("left_shoulder", "left_elbow"), bone_length("left_elbow", "left_wrist")
    wrists: Array = (upper * segments[:, :, 0] + fore * segments[:, :, 1]) / (upper + fore)
    return wrists


def _smoothed(tracks: Array) -> Array:
    """Tracks (T, C) without what sensors add from frame to frame, the ends held."""
    smooth: Array = gaussian_filter1d(tracks, _SMOOTH, axis=0, mode="nearest")
    return smooth


def _without_spikes(tracks: Array) -> Array:
    """Tracks (T, ...), each number the median of itself and its neighbours: points that are thrown off are alone."""
    if len(tracks) < _NEIGHBOURS:
        return tracks
    ends = np.concatenate([tracks[:1], tracks, tracks[-1:]])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # all three unknown
        medians = np.nanmedian(np.stack([ends[:-2], ends[1:-1], ends[2:]]), axis=0)
    return np.where(np.isnan(tracks), np.nan, medians)


def _resampled(grid: Array, times: Array, vectors: Array, otherwise: Array) -> Array:
    """Vectors (T, 3) at other times, gaps bridged; `otherwise` where there is none at all."""
    known = np.isfinite(vectors[:, 0])
    if not known.any():
        return np.broadcast_to(otherwise, (len(grid), 3))
    return np.stack([np.interp(grid, times[known], track[known]) for track in vectors.T], axis=1)


def _unit(vectors: Array) -> Array:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.maximum(length, 1e-6)


def _palm(skeleton: Skeleton, side: str) -> Array:
    """(T, 3) m from the wrist to the hand."""
    end = first_known([skeleton.track(f"{side}_{part}") for part in ("hand", "middle_mcp", "index_mcp", "hand_tip")])
    return end - wrist(skeleton, side)
