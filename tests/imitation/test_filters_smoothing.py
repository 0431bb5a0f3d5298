"""Smoothing without lag: what it passes, what it takes away, and at which frame times."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.imitation.filters import Smooth
from nao_sim.imitation.filters.smoothing import smooth
from nao_sim.motion import Skeleton
from tests.people import person
from tests.tracking import JOINTS, one_track, spoiled


def passed(frequency: float, rate: float, cutoff: float = 6.0, uneven: float = 0.0) -> float:
    """Share of a wave that is left in the middle of ten seconds of it."""
    times = np.arange(0.0, 10.0, 1.0 / rate)
    times = times + uneven / rate * np.random.default_rng(0).uniform(-0.5, 0.5, len(times))
    wave = np.sin(2.0 * np.pi * frequency * times)
    middle = slice(len(times) // 4, -len(times) // 4)
    result = smooth(times, wave[:, None], np.ones(len(times)), cutoff)[:, 0]
    return float(result[middle] @ wave[middle] / (wave[middle] @ wave[middle]))


@pytest.mark.parametrize("rate", [25.0, 30.0, 60.0, 120.0, 480.0])
@pytest.mark.parametrize("cutoff", [3.0, 6.0, 8.0])
def test_half_of_the_cutoff_frequency_is_passed(rate: float, cutoff: float) -> None:
    assert passed(cutoff, rate, cutoff) == pytest.approx(0.5, abs=0.005)


def test_it_is_a_third_order_butterworth_filter_run_both_ways() -> None:
    from scipy.signal import butter, sosfreqz

    rate = 240.0

    for frequency in (1.0, 3.0, 5.0, 7.0, 10.0):
        _, response = sosfreqz(butter(3, 6.0, output="sos", fs=rate), worN=[frequency], fs=rate)
        assert passed(frequency, rate) == pytest.approx(abs(response[0]) ** 2, abs=0.005)


@pytest.mark.parametrize("rate", [30.0, 60.0, 120.0])
def test_a_wave_of_an_arm_keeps_95_percent(rate: float) -> None:
    assert passed(3.0, rate) > 0.95
    assert passed(12.0, rate) < 0.06


def test_uneven_frame_times_make_no_difference() -> None:
    for frequency in (1.0, 3.0, 6.0, 10.0):
        assert passed(frequency, 60.0, uneven=0.8) == pytest.approx(passed(frequency, 60.0), abs=0.02)


def test_twice_as_many_frames_a_second_from_some_time_on_make_no_difference() -> None:
    times = np.concatenate([np.arange(0.0, 5.0, 1 / 120), np.arange(5.0, 10.0, 1 / 240)])
    wave = np.sin(2.0 * np.pi * 6.0 * times)
    result = smooth(times, wave[:, None], np.ones(len(times)), 6.0)[:, 0]
    for part in ((times > 1.0) & (times < 4.0), (times > 6.0) & (times < 9.0)):
        assert result[part] @ wave[part] / (wave[part] @ wave[part]) == pytest.approx(0.5, abs=0.03)


@settings(max_examples=25)
@given(st.integers(0, 2**16), st.integers(1, 60), st.sampled_from([0.0, 0.5]))
def test_a_parabola_is_smooth_already(seed: int, frames: int, uneven: float) -> None:
    random = np.random.default_rng(seed)
    times = (np.arange(frames) + uneven * random.uniform(-0.5, 0.5, frames)) / 30.0
    track = np.vander(times, 3) @ random.normal(size=(3, 3))
    np.testing.assert_allclose(smooth(times, track, random.uniform(0.1, 1.0, frames), 6.0), track, atol=1e-6)


@settings(max_examples=25)
@given(st.integers(0, 2**16), st.floats(-3.0, 3.0))
def test_the_sum_of_two_tracks_is_smoothed_as_each_of_them(seed: int, factor: float) -> None:
    random = np.random.default_rng(seed)
    times, weights = np.cumsum(random.uniform(0.01, 0.05, 40)), random.uniform(0.1, 1.0, 40)
    a, b = random.normal(size=(2, 40, 3))
    together = smooth(times, a + factor * b, weights, 6.0)
    apart = smooth(times, a, weights, 6.0) + factor * smooth(times, b, weights, 6.0)
    np.testing.assert_allclose(together, apart, atol=1e-9)


def test_noise_is_taken_away_and_the_motion_kept() -> None:
    clean, random = person(300, joints=JOINTS), np.random.default_rng(0)
    noisy = spoiled(clean, random, dropouts=0.0, outliers=0.0)
    before, after = (np.std(skeleton.positions - clean.positions) for skeleton in (noisy, Smooth().filter(noisy)))
    assert after < 0.68 * before
    assert np.abs(Smooth().filter(clean).positions - clean.positions).max() < 0.002


def test_a_frame_of_little_confidence_counts_little() -> None:
    times, confidence = np.arange(30) / 30.0, np.ones((30, 1))
    track = np.where(np.arange(30) == 15, 0.1, 0.0)
    trusted = Smooth().filter(one_track(times, track)).positions[15, 0, 1]
    confidence[15] = 0.1
    doubted = Skeleton(times, one_track(times, track).positions, ("left_wrist",), confidence)
    assert Smooth().filter(doubted).positions[15, 0, 1] < 0.3 * trusted


def test_each_side_of_a_gap_is_smoothed_by_itself() -> None:
    times, random = np.arange(60) / 30.0, np.random.default_rng(0)
    track = random.normal(size=60) * 0.01
    track[30] = np.nan
    whole = Smooth().filter(one_track(times, track)).positions[:, 0, 1]
    part = Smooth().filter(one_track(times[:30], track[:30])).positions[:, 0, 1]
    assert np.isnan(whole[30])
    np.testing.assert_allclose(whole[:30], part, atol=1e-12)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_up_to_three_frames_stay_as_they_are(frames: int) -> None:
    skeleton = one_track(np.arange(frames) / 30.0, np.arange(frames) ** 2.0)
    assert np.array_equal(Smooth().filter(skeleton).positions, skeleton.positions)


def test_so_do_up_to_three_frames_between_two_gaps() -> None:
    track = np.random.default_rng(0).normal(size=60)
    track[[20, 24, 26]] = np.nan
    result = Smooth().filter(one_track(np.arange(60) / 30.0, track)).positions[:, 0, 1]
    np.testing.assert_allclose(result[20:27], track[20:27], atol=1e-12)
    assert np.abs(result[:20] - track[:20]).max() > 0.01


def test_frames_too_seldom_to_tell_noise_from_motion_stay_as_they_are() -> None:
    skeleton = one_track(np.arange(20) / 10.0, np.random.default_rng(0).normal(size=20))
    assert np.array_equal(Smooth(6.0).filter(skeleton).positions, skeleton.positions)


def test_frames_almost_at_the_same_time_and_long_pauses_are_taken() -> None:
    random = np.random.default_rng(0)
    times = np.cumsum(random.choice([1e-9, 1e-4, 1 / 30, 1 / 15, 60.0], size=300, p=[0.05, 0.1, 0.6, 0.2, 0.05]))
    track = np.sin(times) + 100.0
    result = smooth(times, track[:, None], np.ones(300), 6.0)
    assert np.isfinite(result).all() and np.abs(result[:, 0] - track).max() < 0.5


def test_long_fast_recordings_far_from_the_origin_are_exact() -> None:
    times = np.arange(20_000) / 1000.0
    track = np.column_stack([times**2 * 0.01, 50.0 - times, np.full(len(times), -20.0)])
    np.testing.assert_allclose(smooth(times, track, np.ones(len(times)), 6.0), track, atol=1e-5)


@pytest.mark.parametrize("cutoff", [0.0, -1.0, np.nan, np.inf])
def test_a_cutoff_that_is_none_is_refused(cutoff: float) -> None:
    with pytest.raises(ValueError, match="cutoff"):
        Smooth(cutoff)
