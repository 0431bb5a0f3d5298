"""The trajectory value."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.motion import JointTrajectory
from tests.motions import wild_motions


def _same(a: JointTrajectory, b: JointTrajectory) -> bool:
    return (
        np.array_equal(a.times, b.times)
        and np.array_equal(a.positions, b.positions, equal_nan=True)
        and np.array_equal(a.given, b.given)
    )


@given(wild_motions())
def test_sampling_at_its_own_times_gives_the_frames(motion):
    assert np.array_equal(motion.sample(motion.times), motion.positions, equal_nan=True)


@given(wild_motions(), st.floats(0.01, 0.99))
def test_samples_lie_between_their_neighbours_or_are_gaps(motion, share):
    times = motion.times[:-1] + share * np.diff(motion.times)
    samples = motion.sample(times)
    low = np.minimum(motion.positions[:-1], motion.positions[1:]) - 1e-9
    high = np.maximum(motion.positions[:-1], motion.positions[1:]) + 1e-9
    inside = np.isfinite(samples)
    assert (samples >= np.nan_to_num(low, nan=-np.inf))[inside].all()
    assert (samples <= np.nan_to_num(high, nan=np.inf))[inside].all()
    assert np.array_equal(inside, np.isfinite(low) & np.isfinite(high))


@given(wild_motions())
def test_outside_the_recording_its_ends_hold(motion):
    ends = motion.sample(np.array([motion.times[0] - 5.0, motion.times[-1] + 5.0]))
    assert np.array_equal(ends, motion.positions[[0, -1]], equal_nan=True)


@given(wild_motions())
def test_mirrored_twice_is_the_motion(motion):
    assert _same(motion.mirrored().mirrored(), motion)


@given(wild_motions(), st.floats(0.1, 10.0))
def test_twice_the_speed_is_half_the_time(motion, speed):
    faster = motion.at_speed(speed)
    assert faster.duration == pytest.approx(motion.duration / speed)
    assert np.array_equal(faster.positions, motion.positions, equal_nan=True)


def test_one_frame_can_be_sampled():
    motion = JointTrajectory(np.array([1.0]), np.full((1, 26), 0.25))
    assert np.array_equal(motion.sample(np.array([0.0, 1.0, 2.0])), np.full((3, 26), 0.25))


@pytest.mark.parametrize("times", [[0.0, 0.0], [1.0, 0.5], [0.0, np.nan], [0.0, np.inf]])
def test_times_must_increase(times):
    with pytest.raises(ValueError, match="strictly increasing"):
        JointTrajectory(np.array(times), np.zeros((2, 26)))


@pytest.mark.parametrize("shape", [(2, 25), (3, 26), (26,)])
def test_shape_must_fit(shape):
    with pytest.raises(ValueError, match="expected"):
        JointTrajectory(np.array([0.0, 1.0]), np.zeros(shape))


def test_values_cannot_be_written_to():
    motion = JointTrajectory(np.array([0.0]), np.zeros((1, 26)))
    with pytest.raises(ValueError, match="read-only"):
        motion.positions[0, 0] = 1.0
