"""Which gaps are filled, and with what."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.imitation.filters import Fill
from nao_sim.imitation.filters.gaps import FILLED
from nao_sim.motion import Skeleton
from tests.tracking import one_track, tracked

TIMES = np.arange(60) / 30.0


def holed(track: np.ndarray, *gaps: slice) -> Skeleton:
    track = np.array(track)
    for gap in gaps:
        track[gap] = np.nan
    return one_track(TIMES, track)


def filled(skeleton: Skeleton, longest: float = 0.5) -> np.ndarray:
    return Fill(longest).filter(skeleton).positions[:, 0, 1]


def test_straight_motion_is_restored() -> None:
    line = 2.0 - 0.7 * TIMES
    np.testing.assert_allclose(filled(holed(line, slice(10, 20), slice(40, 41))), line, atol=1e-12)


def test_a_turn_is_followed_better_than_by_a_straight_line() -> None:
    turn = 0.3 * np.sin(2.0 * np.pi * 0.5 * TIMES)
    gap = slice(14, 24)
    straight = np.interp(TIMES, np.delete(TIMES, gap), np.delete(turn, gap))
    off = np.abs(filled(holed(turn, gap)) - turn)
    assert off.max() < 0.5 * np.abs(straight - turn).max()
    assert off[14] < 0.5 * np.abs(straight - turn)[14]  # it leaves at the speed it had


@pytest.mark.parametrize(("frames", "expected"), [(14, True), (15, False)])
def test_the_longest_gap_is_counted_between_the_frames_around_it(frames: int, expected: bool) -> None:
    result = filled(holed(TIMES, slice(10, 10 + frames)), longest=15.5 / 30.0)
    assert np.isfinite(result[10 : 10 + frames]).all() == expected


def test_before_the_first_and_after_the_last_frame_nothing_is_filled() -> None:
    result = filled(holed(TIMES, slice(0, 3), slice(57, 60)))
    assert np.isnan(result[[0, 1, 2, 57, 58, 59]]).all() and np.isfinite(result[3:57]).all()


def test_filled_points_are_known_by_their_confidence() -> None:
    confidence = np.ones((60, 1))
    confidence[9], confidence[20] = 0.8, 0.6
    track = holed(TIMES, slice(10, 20))
    result = Fill().filter(Skeleton(TIMES, track.positions, track.joints, confidence)).confidence[:, 0]
    assert result[10:20] == pytest.approx(FILLED * 0.6) and np.array_equal(result[20:], confidence[20:, 0])


def test_a_point_between_two_gaps_is_enough() -> None:
    result = filled(holed(np.ones(60), slice(0, 9), slice(10, 20), slice(21, 60)))
    assert np.array_equal(np.flatnonzero(np.isfinite(result)), np.arange(9, 21))
    assert result[9:21] == pytest.approx(1.0)


def test_frames_long_before_the_gap_do_not_matter() -> None:
    track = np.where(TIMES < 0.15, 5.0, 1.0)
    assert filled(holed(track, slice(15, 20)))[15:20] == pytest.approx(1.0)


@settings(max_examples=25)
@given(tracked(), st.floats(0.0, 0.7))
def test_recorded_points_are_not_touched(skeleton: Skeleton, longest: float) -> None:
    result = Fill(longest).filter(skeleton)
    there = np.isfinite(skeleton.positions).all(axis=2)
    assert np.array_equal(result.positions[there], skeleton.positions[there])
    assert np.array_equal(result.confidence[there], skeleton.confidence[there])


@settings(max_examples=25)
@given(tracked())
def test_filled_points_lie_near_the_way_across_the_gap(skeleton: Skeleton) -> None:
    result = Fill().filter(skeleton).positions
    for joint in range(len(skeleton.joints)):
        there = np.flatnonzero(np.isfinite(skeleton.positions[:, joint]).all(axis=1))
        for before, behind in pairwise(there):
            ends = skeleton.positions[[before, behind], joint]
            inside = result[before + 1 : behind, joint]
            way = np.linalg.norm(ends[1] - ends[0])
            away = np.linalg.norm(inside - ends.mean(axis=0), axis=1)
            assert (away[np.isfinite(away)] <= 1.1 * way + 1e-9).all()


@pytest.mark.parametrize("longest", [-0.1, np.nan, np.inf])
def test_a_length_that_is_none_is_refused(longest: float) -> None:
    with pytest.raises(ValueError, match="longest"):
        Fill(longest)
