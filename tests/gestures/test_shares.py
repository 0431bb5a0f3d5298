"""Shares and their intervals; who learns from whom."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom

from nao_sim.gestures.held_out import each_user, folds
from nao_sim.gestures.shares import Share, between_groups


@given(st.integers(20, 300), st.floats(0.05, 0.95))
def test_intervals_contain_the_truth_of_binomial_draws_about_as_often_as_they_say(count, truth):
    drawn = np.arange(count + 1)
    chance = binom.pmf(drawn, count, truth)
    bounds = np.array([Share(int(right), count).interval for right in drawn])
    inside = (bounds[:, 0] <= truth) & (truth <= bounds[:, 1])
    assert chance[inside].sum() > 0.9


def test_over_all_truths_intervals_contain_it_in_95_percent():
    truths = np.linspace(0.0025, 0.9975, 200)
    for count in (10, 30, 100):
        bounds = np.array([Share(right, count).interval for right in range(count + 1)])
        inside = (bounds[:, :1] <= truths) & (truths <= bounds[:, 1:])
        covered = (binom.pmf(np.arange(count + 1)[:, None], count, truths) * inside).sum(axis=0)
        assert covered.mean() == pytest.approx(0.95, abs=0.01)


@given(st.integers(1, 500).flatmap(lambda count: st.tuples(st.integers(0, count), st.just(count))))
def test_an_interval_holds_its_share_and_mirrors_with_it(pair):
    right, count = pair
    low, high = Share(right, count).interval
    assert 0.0 <= low <= right / count <= high <= 1.0
    other = Share(count - right, count).interval
    assert (1.0 - high, 1.0 - low) == pytest.approx(other, abs=1e-12)


def test_nothing_is_known_of_no_trials():
    assert Share(0, 0).interval == (0.0, 1.0) and str(Share(0, 0)) == "-" and np.isnan(Share(0, 0).value)


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 5)), min_size=1, max_size=60), st.permutations(range(6)))
def test_intervals_between_groups_do_not_know_names_or_order(trials, names):
    right, groups = (np.array(column) for column in zip(*trials, strict=True))
    order = np.random.default_rng(0).permutation(len(right))
    renamed = np.array(names)[groups]
    assert between_groups(right, groups) == between_groups(right[order], renamed[order])


@given(st.lists(st.sampled_from("abcd"), min_size=2, max_size=60), st.integers(2, 8))
def test_folds_share_out_all_rows_and_each_label_evenly(labels, count):
    found = np.array(labels)
    tests = folds(found, count)
    assert np.array_equal(np.sum(tests, axis=0), np.ones(len(found)))
    for label in set(labels):
        sizes = [int((test & (found == label)).sum()) for test in tests]
        assert max(sizes) - min(sizes) <= 1
    assert max(map(np.sum, tests)) - min(map(np.sum, tests)) <= 1


def test_a_single_user_cannot_be_left_out():
    with pytest.raises(ValueError, match="one user"):
        each_user(np.array(["ann", "ann"]))
