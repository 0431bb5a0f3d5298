"""What trackers make of people: noise, dropouts, outliers, uneven frame times."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from nao_sim.motion import Skeleton
from tests.people import person

JOINTS = ("pelvis", "chest", "neck", "head", "left_shoulder", "left_elbow", "left_wrist",
          "right_shoulder", "right_elbow", "right_wrist")  # fmt: skip


@st.composite
def tracked(draw: st.DrawFn, frames: int = 40) -> Skeleton:
    """A moving person as a bad tracker sees one."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    skeleton = person(draw(st.integers(1, frames)), draw(st.integers(0, 2**16)), joints=JOINTS)
    skeleton = spoiled(
        skeleton,
        random,
        noise=draw(st.sampled_from([0.0, 0.003, 0.02])),
        dropouts=draw(st.sampled_from([0.0, 0.1, 0.6])),
        outliers=draw(st.sampled_from([0.0, 0.05])),
    )
    confidence = random.uniform(0.1, 1.0, skeleton.confidence.shape) if draw(st.booleans()) else 1.0
    uneven = random.uniform(0.2, 3.0, len(skeleton)) if draw(st.booleans()) else np.ones(len(skeleton))
    return replace(skeleton, times=np.cumsum(uneven) / 30.0, confidence=confidence * (skeleton.confidence > 0.0))


def spoiled(
    skeleton: Skeleton, random: np.random.Generator, noise: float = 0.01, dropouts: float = 0.03, outliers: float = 0.01
) -> Skeleton:
    """The skeleton with white noise (m), and with shares of points that are missing and that are somewhere else."""
    shape = skeleton.confidence.shape
    astray = random.normal(size=(*shape, 3)) * (random.random(shape) < outliers)[:, :, None] * 0.3
    positions = skeleton.positions + random.normal(size=(*shape, 3)) * noise + astray
    positions[random.random(shape) < dropouts] = np.nan
    return replace(skeleton, positions=positions)


def moved(skeleton: Skeleton, turn: Rotation, shift: np.ndarray) -> Skeleton:
    """The same person seen from elsewhere."""
    places = skeleton.positions.reshape(-1, 3) @ turn.as_matrix().T + shift
    return replace(skeleton, positions=places.reshape(skeleton.positions.shape))


def backwards(skeleton: Skeleton) -> Skeleton:
    """The recording played from its end."""
    return Skeleton(
        -skeleton.times[::-1],
        skeleton.positions[::-1],
        skeleton.joints,
        skeleton.confidence[::-1],
        skeleton.planar,
    )


def one_track(times: np.ndarray, track: np.ndarray, joint: str = "left_wrist") -> Skeleton:
    """A skeleton of a single joint; a track (T,) moves along y."""
    track = np.asarray(track, float)
    places = track if track.ndim == 2 else np.column_stack([np.zeros(len(track)), track, np.zeros(len(track))])
    return Skeleton(times, places[:, None], (joint,))


def same(a: Skeleton, b: Skeleton, within: float = 1e-9) -> bool:
    """Whether two skeletons agree, missing points included."""
    return (
        a.joints == b.joints
        and np.allclose(a.times, b.times, atol=1e-12)
        and np.allclose(a.positions, b.positions, atol=within, equal_nan=True)
        and np.allclose(a.confidence, b.confidence, atol=1e-12)
    )
