"""The search for the shoulder: its derivatives against finite differences, its minima against their surroundings."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.imitation import arm_search
from nao_sim.imitation.arm_search import local_minima
from nao_sim.imitation.features import LEFT
from nao_sim.imitation.reach import Asked, arm_limits, nearest_elbow, upper_arm_error
from tests.imitation.arm_kinematics import ROBOT, limits, random_poses, unit

LIMITS = arm_limits(ROBOT)
LOWER, UPPER = limits(LEFT)


def random_arms(count, seed):
    upper_arm, forearm = unit(np.random.default_rng(seed).normal(size=(2, count, 3)))
    return Asked(upper_arm.T, forearm.T, np.ones(count, bool))


def model(shoulder, asked, end=None):
    return arm_search._model(*shoulder, np.stack([asked.upper_arm, asked.forearm], axis=1), LIMITS, end)


def smooth_error(error):
    edge, bowl = np.radians(0.75), 0.01
    return np.sqrt(error**2 + edge**2) + bowl * error**2


def both_errors(shoulder, asked):
    return upper_arm_error(asked.upper_arm, shoulder), nearest_elbow(asked.forearm, shoulder, LIMITS)[2]


def test_the_error_is_the_one_of_the_elbows_nearest_place():
    asked, shoulder = random_arms(2000, 1), random_poses(LEFT, 2000, 2)[:, :2].T
    expected = sum(smooth_error(error) for error in both_errors(shoulder, asked))
    np.testing.assert_allclose(model(shoulder, asked)[0], expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("joint", [0, 1])
def test_derivatives_are_those_of_finite_differences(joint):
    asked, shoulder, step = random_arms(4000, 3), random_poses(LEFT, 4000, 4)[:, :2].T, 1e-6
    here, way = model(shoulder, asked), np.eye(2)[joint][:, None] * step
    slopes = (model(shoulder + way, asked) - model(shoulder - way, asked))[:3] / (2.0 * step)
    np.testing.assert_allclose(slopes[0], here[1 + joint], rtol=0, atol=1e-6)
    for found, expected in zip(slopes[1:], here[[3, 4]] if joint == 0 else here[[4, 5]], strict=True):
        off = np.abs(found - expected) / (1.0 + np.abs(expected))
        assert np.quantile(off, 0.99) < 1e-5  # the rest straddles an end of a joint, where the curvature jumps


@settings(max_examples=20)
@given(seed=st.integers(0, 10_000))
def test_nothing_around_a_minimum_is_lower(seed):
    asked = random_arms(30, seed)
    arm, shoulder, end = local_minima(asked, LIMITS)
    assert set(arm) == set(range(30))
    assert (shoulder >= LOWER[:2, None]).all() and (shoulder <= UPPER[:2, None]).all()
    least = model(shoulder, asked[arm], end)[0]
    best = least <= np.array([least[arm == one].min() for one in range(30)])[arm]  # others may be passes at a limit
    for way in np.stack([np.cos(np.arange(8.0)), np.sin(np.arange(8.0))], axis=-1):
        around = np.clip(shoulder + 1e-3 * way[:, None], LOWER[:2, None], UPPER[:2, None])
        assert (model(around, asked[arm], end)[0] >= least - 1e-8)[best].all()


def test_an_arm_does_not_depend_on_its_neighbours():
    asked = random_arms(1500, 8)
    arm, shoulder, end = local_minima(asked, LIMITS)
    for which in (0, 700, 1499):
        alone = local_minima(asked[[which]], LIMITS)
        np.testing.assert_allclose(np.sort(shoulder[:, arm == which]), np.sort(alone[1]), rtol=0, atol=1e-9)
        assert sorted(end[arm == which]) == sorted(alone[2])


def test_a_forearm_between_both_ends_of_elbow_yaw_has_a_minimum_at_either():
    bent_out = Asked(np.array([[1.0], [0.0], [0.0]]), unit(np.array([1.0, 1.0, 0.0]))[:, None], np.ones(1, bool))
    _, shoulder, end = local_minima(bent_out, LIMITS)
    assert {-1.0, 1.0} <= set(end)
    error = sum(both_errors(shoulder, bent_out[np.zeros(len(end), int)]))
    best = [error[end == side].min() for side in (-1.0, 1.0)]
    assert best[0] == pytest.approx(best[1], abs=1e-6)
