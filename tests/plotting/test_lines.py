"""Values over time: what is drawn of gaps, of lone values, of hours."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from nao_sim.plotting.lines import COLUMNS, draw_over_time, is_long, lone, stretches, visible, with_breaks
from nao_sim.plotting.style import page, styled

HOUR = 180_000
VALUES = arrays(float, st.integers(1, 60), elements=st.floats(-9.0, 9.0) | st.just(np.nan))


def drawn(times: np.ndarray, values: np.ndarray):
    with styled():
        axes = page(2.0).add_subplot()
        draw_over_time(axes, times, values, color="black")
        return axes


@given(VALUES, st.integers(1, 20))
def test_stretches_hold_every_value_between_their_smallest_and_their_largest(values, most):
    parts = stretches(np.arange(len(values), dtype=float), values, most)
    assert len(parts.times) == min(most, len(values)) and (np.diff(parts.times) > 0.0).all()
    edges = np.linspace(0, len(values), len(parts.times) + 1).astype(int)
    for place, (start, end) in enumerate(pairwise(edges.tolist())):
        piece = values[start:end][np.isfinite(values[start:end])]
        found = parts.lowest[place], parts.middle[place], parts.highest[place]
        if len(piece):
            assert found == (piece.min(), np.median(piece), piece.max())
        else:
            assert np.isnan(found).all()


def test_a_gap_stays_a_gap_and_a_lone_value_is_a_dot():
    values = np.array([0.0, 1.0, np.nan, 2.0, np.nan, 3.0, 4.0])
    line, dots = drawn(np.arange(7.0), values).lines
    assert np.array_equal(line.get_ydata(), values, equal_nan=True)
    assert dots.get_xdata().tolist() == [3.0] and dots.get_marker() == "o"
    assert lone(np.array([5.0])).tolist() == [True]


def test_an_hour_takes_few_points_and_its_single_outlier_and_its_gap_are_seen():
    times, values = np.arange(HOUR) / 50.0, np.sin(np.arange(HOUR) / 400.0)
    values[100_000] = 7.0
    values[20_000:30_000] = np.nan
    assert is_long(values)
    axes = drawn(times, values)
    (line,) = axes.lines
    assert len(line.get_xdata()) < COLUMNS
    gap = np.isnan(line.get_ydata())
    assert 0.8 * 200.0 < np.ptp(line.get_xdata()[gap]) <= 200.0
    assert max(path.vertices[:, 1].max() for path in axes.collections[0].get_paths()) == 7.0


@given(st.lists(st.integers(1, 50), min_size=1, max_size=60), st.integers(1, 10**6))
def test_spells_that_are_shown_cover_those_that_were_and_can_be_seen(lengths, run):
    bounds = np.cumsum([0, *lengths]).astype(float)
    spells = np.stack([bounds[:-1:2], bounds[1::2]], axis=1)
    shown = np.array(visible(spells, float(run)))
    ends = shown.sum(axis=1)
    assert (shown[:, 1] >= run / COLUMNS - 1e-9).all() and (shown[1:, 0] >= ends[:-1]).all()
    assert all(((shown[:, 0] <= a) & (b <= ends + 1e-9)).any() for a, b in spells)
    if run < COLUMNS:
        assert len(shown) == len(spells)


def test_nothing_is_shown_of_no_spells():
    assert visible(np.empty((0, 2)), 1.0) == []


@pytest.mark.parametrize("frames", [0, 1, 2])
def test_few_frames_have_no_pauses(frames):
    times, values = with_breaks(np.arange(frames, dtype=float), np.ones(frames))
    assert len(times) == len(values) == frames


def test_a_line_breaks_in_a_pause_between_frames():
    times = np.array([0.0, 0.1, 0.2, 5.0, 5.1])
    moments, values = with_breaks(times, np.ones(5))
    assert np.isnan(values).sum() == 1 and 0.2 < moments[np.isnan(values)][0] <= 5.0
