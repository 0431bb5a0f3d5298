"""The filter for streams: lag, jitter, gaps and jumps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from nao_sim.imitation.filters import Kalman
from nao_sim.imitation.filters.gaps import FILLED
from nao_sim.motion import Skeleton
from tests.people import person
from tests.tracking import JOINTS, one_track, spoiled, tracked

TIMES = np.arange(90) / 30.0


def along_y(track: np.ndarray, times: np.ndarray = TIMES, **options: float) -> np.ndarray:
    return Kalman(**options).filter(one_track(times, track)).positions[:, 0, 1]


@settings(max_examples=25)
@given(tracked())
def test_a_recording_is_filtered_as_the_stream_of_its_frames(skeleton: Skeleton) -> None:
    stream, whole = Kalman(), Kalman().filter(skeleton)
    for frame, time in enumerate(skeleton.times.tolist()):
        result = stream.step(time, skeleton.positions[frame], skeleton.confidence[frame])
        assert np.array_equal(result, whole.positions[frame], equal_nan=True)
        assert np.array_equal(stream.confidence, whole.confidence[frame])


@settings(max_examples=25)
@given(tracked())
def test_the_future_has_no_effect(skeleton: Skeleton) -> None:
    half = len(skeleton) // 2 + 1
    begun = Skeleton(skeleton.times[:half], skeleton.positions[:half], skeleton.joints, skeleton.confidence[:half])
    part, whole = Kalman().filter(begun), Kalman().filter(skeleton)
    assert np.array_equal(part.positions, whole.positions[:half], equal_nan=True)


@settings(max_examples=25)
@given(tracked())
def test_what_is_seen_with_confidence_is_never_missing(skeleton: Skeleton) -> None:
    seen = np.isfinite(skeleton.positions).all(axis=2) & (skeleton.confidence >= 0.2)
    assert np.isfinite(Kalman().filter(skeleton).positions[seen]).all()


@settings(max_examples=10)
@given(tracked())
def test_filtering_a_recording_leaves_the_stream_alone(skeleton: Skeleton) -> None:
    stream = Kalman()
    before = stream.step(0.0, np.zeros((2, 3)))
    stream.filter(skeleton)
    assert np.array_equal(stream.step(1 / 30, np.zeros((2, 3))), before)


def test_jitter_is_halved_at_less_than_60_ms_of_lag() -> None:
    clean = person(900, seed=2, joints=JOINTS)
    noisy = spoiled(clean, np.random.default_rng(2), dropouts=0.0, outliers=0.0)
    result = Kalman().filter(noisy)
    jitter = [np.std(np.diff(each.positions - clean.positions, 2, axis=0)[30:]) for each in (noisy, result)]
    assert jitter[1] < 0.5 * jitter[0]
    late = [np.mean((result.positions[30:] - moved) ** 2) for moved in _delayed(clean, np.arange(0, 5) / 120.0)]
    assert np.argmin(late) <= 2  # 17 ms
    assert np.std(result.positions - clean.positions) < np.std(noisy.positions - clean.positions)


def _delayed(skeleton: Skeleton, lags: np.ndarray) -> list[np.ndarray]:
    flat = skeleton.positions.reshape(len(skeleton), -1)
    columns = [[np.interp(skeleton.times[30:] - lag, skeleton.times, column) for column in flat.T] for lag in lags]
    return [np.transpose(each).reshape(-1, len(skeleton.joints), 3) for each in columns]


def test_a_hand_at_rest_is_quieter_than_one_that_moves() -> None:
    noise = np.random.default_rng(0).normal(size=600) * 0.01
    times = np.arange(600) / 30.0
    sweep = 0.5 * np.sin(2.0 * np.pi * times)
    at_rest, moving = along_y(noise, times), along_y(sweep + noise, times) - along_y(sweep, times)
    assert np.std(at_rest[30:]) < 0.9 * np.std(moving[30:])


def test_a_wave_of_3_hz_is_followed() -> None:
    wave = 0.3 * np.sin(2.0 * np.pi * 3.0 * TIMES)
    assert np.abs(along_y(wave)[30:]).max() > 0.8 * np.abs(wave[30:]).max()


def test_steady_motion_is_followed_without_lag_to_speak_of() -> None:
    result = along_y(1.5 * TIMES)
    assert np.abs(result - 1.5 * TIMES)[30:].max() < 1.5 * 0.02  # 20 ms


def test_one_frame_elsewhere_is_ignored_and_two_that_agree_are_believed() -> None:
    once, twice = np.zeros(90), np.zeros(90)
    once[40] = 0.5
    twice[40:] = 0.5
    assert np.abs(along_y(once)).max() == 0.0
    result = along_y(twice)
    assert result[40] == 0.0 and np.abs(result[41:] - 0.5).max() < 1e-12


def test_a_false_first_frame_is_forgotten() -> None:
    track = np.zeros(90)
    track[0] = 0.5
    assert np.abs(along_y(track)[2:]).max() < 1e-12


def test_two_frames_elsewhere_that_disagree_are_ignored() -> None:
    track = np.zeros(90)
    track[40], track[41] = 0.5, -0.5
    assert np.abs(along_y(track)).max() == 0.0


def test_a_gap_is_bridged_for_as_long_as_stated() -> None:
    track = 0.5 * TIMES
    track[40:60] = np.nan
    result = along_y(track, hold=0.25)
    held = TIMES - TIMES[39] <= 0.25
    assert np.isfinite(result[held | (np.arange(90) >= 60)]).all()
    assert np.isnan(result[~held & (np.arange(90) < 60)]).all()
    assert (np.diff(result[39:47]) > 0.0).all() and (np.diff(result[39:47], 2) < 0.0).all()  # it slows down
    assert result[60] == track[60]  # and begins anew


def test_confidence_tells_what_was_seen() -> None:
    track = np.zeros(90)
    track[:5] = track[40:60] = np.nan
    confidence = np.full((90, 1), 0.8)
    skeleton = replace(one_track(TIMES, track), confidence=confidence)
    result = Kalman(hold=0.25).filter(skeleton).confidence[:, 0]
    assert (result[:5] == 0.0).all() and (result[5:40] == 0.8).all()
    assert result[40:46] == pytest.approx(FILLED * 0.8) and (result[48:60] == 0.0).all()


def test_a_joint_of_little_confidence_counts_as_missing_and_one_of_some_counts_less() -> None:
    track = np.where(TIMES < 2.0, 0.0, 0.05)

    def with_confidence(value: float) -> np.ndarray:
        confidence = np.where(TIMES < 2.0, 1.0, value)[:, None]
        return Kalman().filter(replace(one_track(TIMES, track), confidence=confidence)).positions[:, 0, 1]

    assert with_confidence(0.1)[65] == 0.0
    assert with_confidence(0.3)[60] < 0.6 * with_confidence(1.0)[60]


def test_after_a_reset_it_is_as_new() -> None:
    filter_ = Kalman()
    for time in range(5):
        filter_.step(time / 30, np.ones((4, 3)))
    filter_.reset()
    assert np.array_equal(filter_.step(0.0, np.zeros((2, 3))), np.zeros((2, 3)))


@pytest.mark.parametrize("time", [1.0, 0.5, np.nan, np.inf])
def test_time_must_go_on(time: float) -> None:
    filter_ = Kalman()
    filter_.step(1.0, np.zeros((2, 3)))
    with pytest.raises(ValueError, match="time"):
        filter_.step(time, np.zeros((2, 3)))


@pytest.mark.parametrize("shape", [(3, 3), (2, 2), (3,)])
def test_joints_must_stay_the_same(shape: tuple[int, ...]) -> None:
    filter_ = Kalman()
    filter_.step(1.0, np.zeros((2, 3)))
    with pytest.raises(ValueError, match="expected"):
        filter_.step(2.0, np.zeros(shape))


@pytest.mark.parametrize(
    "options", [{"noise": 0.0}, {"noise": np.nan}, {"hold": -1.0}, {"hold": np.nan}, {"min_confidence": 0.0}]
)
def test_settings_that_are_none_are_refused(options: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="expected"):
        Kalman(**options)
