"""Times that stand still for several frames."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import RecordingError
from nao_sim.recordings.skeletons.coarse_clock import finer
from nao_sim.recordings.source import Source
from tests.people import person

SOURCE = Source(Path("made.csv"))


@settings(max_examples=30, deadline=None)
@given(start=st.floats(0.0, 1.0), seed=st.integers(0, 99))
def test_a_clock_of_whole_seconds_is_as_good_as_a_fine_one(start, seed):
    skeleton = person(150, seed)
    times, notes = finer(SOURCE, np.floor(skeleton.times + start), skeleton.positions)
    assert np.abs(np.diff(times) - np.diff(skeleton.times)).max() < 0.003 and "150 frames" in notes[0]
    assert np.abs(times - skeleton.times - start).max() < 0.1


def test_frames_that_are_there_several_times_are_left_alone():
    skeleton = person(30)
    for repeated in (3, 4):
        positions, times = (np.repeat(told, repeated, axis=0) for told in (skeleton.positions, skeleton.times))
        assert finer(SOURCE, times, positions) == (times, ())


def test_several_people_at_a_time_are_left_alone():
    skeleton = person(30)
    positions = np.concatenate([skeleton.positions + np.array([0.0, side, 0.0]) for side in (-1.0, 0.0, 1.0)], axis=1)
    times = np.repeat(skeleton.times, 3)
    assert finer(SOURCE, times, positions.reshape(90, -1, 3)) == (times, ())


@pytest.mark.parametrize("times", [np.zeros(30), np.arange(30) // 15.0])
def test_a_clock_that_hardly_moves_is_refused(times):
    with pytest.raises(RecordingError, match=r"30 frames at [12] times; expected a time for each frame"):
        finer(SOURCE, times, person(30).positions)


def test_few_slips_of_a_clock_are_left_alone():
    times = np.sort(np.r_[np.arange(20.0), np.arange(10.0)])
    assert finer(SOURCE, times, person(30).positions) == (times, ())
