"""Slow enough, and without lag."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.imitation.calm import calm, filled, slow_above

FASTEST = np.array([0.5, 2.0])


SEEDS = st.integers(0, 2**32 - 1)


def track(seed):
    """Frame times, far from even, with values that jump, and time constants."""
    random = np.random.default_rng(seed)
    steps = random.exponential(random.choice([0.01, 0.1, 1.0]), random.integers(1, 80))
    times = np.cumsum(steps + 1e-3)
    return times, random.normal(size=(len(times), 2)), np.full(len(times), random.choice([0.03, 0.3]))


@settings(max_examples=50)
@given(SEEDS)
def test_nothing_is_faster_than_allowed_nor_out_of_range(seed):
    times, values, softness = track(seed)
    found = calm(times, values, FASTEST, softness)
    assert (np.abs(np.diff(found, axis=0)) <= FASTEST * np.diff(times)[:, None] + 1e-9).all()
    assert (found <= values.max(axis=0) + 1e-12).all() and (found >= values.min(axis=0) - 1e-12).all()


@settings(max_examples=25)
@given(SEEDS)
def test_the_speed_bound_itself_is_exact(seed):
    times, values, _ = track(seed)
    farthest = np.diff(times)[:, None] * FASTEST
    above = slow_above(values, farthest)
    assert (np.abs(np.diff(above, axis=0)) <= farthest + 1e-12).all()
    assert (above >= values).all()


@settings(max_examples=25)
@given(SEEDS)
def test_upside_down_is_upside_down(seed):
    times, values, softness = track(seed)
    np.testing.assert_array_equal(calm(times, -values, FASTEST, softness), -calm(times, values, FASTEST, softness))


def test_a_slow_motion_stays_and_does_not_lag():
    times = np.arange(0.0, 10.0, 0.02)
    values = np.stack([0.1 * np.sin(2.0 * times), 0.3 * np.sin(2.0 * times)], axis=1)
    found = calm(times, values, FASTEST, np.full(len(times), 0.05))
    assert np.abs(found - values)[50:-50].max() < 0.01
    lag = [np.abs(np.roll(values, shift, axis=0) - found)[50:-50].max() for shift in range(-5, 6)]
    assert np.argmin(lag) == 5  # no shift at all


def test_gaps_are_crossed_straight_and_what_is_never_known_is_told():
    times = np.array([0.0, 1.0, 3.0, 4.0])
    values = np.array([[0.0, np.nan], [np.nan, np.nan], [3.0, np.nan], [np.nan, np.nan]])
    np.testing.assert_allclose(filled(times, values, np.array([9.0, 7.0])), [[0, 7], [1, 7], [3, 7], [3, 7]])
