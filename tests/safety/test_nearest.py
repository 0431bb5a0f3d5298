"""The quadratic program."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import minimize

from nao_sim.safety.nearest import nearest

seeds = st.integers(0, 2**32 - 1)


def _problem(seed, size, count, room):
    """Random weights, limits and rows; `room` > 0 where all rows hold somewhere."""
    random = np.random.default_rng(seed)
    low = random.uniform(-2.0, 0.0, size)
    high = low + random.uniform(0.1, 3.0, size)
    rows = random.normal(size=(count, size)) * 10.0 ** random.uniform(-2.0, 0.5, (count, 1))
    inside = low + random.random(size) * (high - low)
    least = rows @ inside - room * np.linalg.norm(rows, axis=1)
    return random.uniform(-3.0, 3.0, size), random.uniform(0.02, 10.0, size), (low, high), rows, least


def _best(wanted, weight, limits, rows, least):
    """The nearest point by trying every set of rules that may hold tightly."""
    size = len(wanted)
    rules = np.concatenate([np.eye(size), -np.eye(size), rows])
    bounds = np.concatenate([limits[0], -limits[1], least])
    best, cost = None, np.inf
    for tight in (t for count in range(size + 1) for t in combinations(range(len(rules)), count)):
        active, at = rules[list(tight)], bounds[list(tight)]
        system = np.block([[np.diag(weight), active.T], [active, np.zeros((len(tight), len(tight)))]])
        if np.linalg.matrix_rank(system) < len(system):
            continue
        x = np.linalg.solve(system, np.concatenate([weight * wanted, at]))[:size]
        if (rules @ x >= bounds - 1e-9).all() and weight @ (x - wanted) ** 2 < cost:
            best, cost = x, weight @ (x - wanted) ** 2
    return best


@given(seeds, st.integers(1, 3), st.integers(0, 3), st.floats(0.0, 1.0))
def test_the_result_is_the_nearest_of_all_that_keep_limits_and_rows(seed, size, count, room):
    problem = _problem(seed, size, count, room)
    np.testing.assert_allclose(nearest(*problem), _best(*problem), rtol=0.0, atol=1e-5)


@given(seeds, st.integers(8, 26), st.integers(1, 12), st.floats(0.0, 1.0))
def test_nothing_that_keeps_limits_and_rows_is_nearer_in_many_dimensions_either(seed, size, count, room):
    wanted, weight, limits, rows, least = _problem(seed, size, count, room)
    found = nearest(wanted, weight, limits, rows, least)
    assert (rows @ found >= least - 1e-6).all()
    # the projection theorem: whatever else is allowed lies on the far side
    other = nearest(np.random.default_rng(seed + 1).uniform(-3.0, 3.0, size), weight, limits, rows, least)
    assert (rows @ other >= least - 1e-6).all()
    assert weight * (wanted - found) @ (other - found) <= 1e-5


@given(seeds, st.integers(1, 26), st.integers(1, 12), st.floats(-3.0, 1.0))
def test_limits_hold_even_where_the_rows_cannot(seed, size, count, room):
    wanted, weight, (low, high), rows, least = _problem(seed, size, count, room)
    found = nearest(wanted, weight, (low, high), rows, least)
    assert (found >= low).all()
    assert (found <= high).all()


@given(seeds, st.integers(1, 12), st.integers(1, 6), st.floats(-3.0, -0.5))
def test_rows_that_cannot_hold_are_broken_as_little_as_possible(seed, size, count, room):
    wanted, weight, limits, rows, least = _problem(seed, size, count, room)
    length = np.linalg.norm(rows / np.sqrt(weight), axis=1)  # of a row, where the distance to what is wanted is plain

    def broken(x):
        return np.maximum(least - rows @ x, 0.0) / length

    def cost(x):
        return broken(x) @ broken(x), -2.0 * rows.T @ (broken(x) / length)

    least_cost = minimize(cost, np.clip(wanted, *limits), jac=True, bounds=np.stack(limits, axis=1), tol=1e-12).fun
    assume(least_cost > 1e-6)
    assert cost(nearest(wanted, weight, limits, rows, least))[0] <= least_cost * (1 + 1e-3)


def test_limits_that_leave_one_point_are_that_point():
    only = np.array([0.3, -0.7])
    found = nearest(np.zeros(2), np.ones(2), (only, only), np.array([[1.0, 1.0]]), np.array([5.0]))
    np.testing.assert_allclose(found, only, atol=1e-12)
