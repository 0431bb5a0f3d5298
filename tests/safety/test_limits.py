"""Limits and couplings."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.limits import (
    COUPLING_MARGIN_RAD,
    always_allowed,
    command_bounds,
    coupled_bounds,
    coupling_excess,
    limit_excess,
)
from tests.motions import poses

angles = st.floats(-2.1, 2.1)
couplings = st.sampled_from(load_robot().couplings)


@given(couplings, angles, angles, st.floats(0.0, 1.0))
def test_bounds_of_a_way_hold_at_every_angle_on_it(coupling, start, end, share):
    lower, upper = coupled_bounds(coupling, start, end)
    low, high = coupling.bounds(start + share * (end - start))
    assert lower >= low + COUPLING_MARGIN_RAD - 1e-12
    assert upper <= high - COUPLING_MARGIN_RAD + 1e-12


@pytest.mark.parametrize("coupling", load_robot().couplings)
def test_even_the_longest_way_leaves_room(coupling):
    lower, upper = coupled_bounds(coupling, -3.0, 3.0)
    assert lower < upper


@given(couplings, angles, angles)
def test_many_ways_at_once_are_each_way_alone(coupling, start, end):
    together = coupled_bounds(coupling, np.array([start, end]), np.array([end, end]))
    alone = [coupled_bounds(coupling, start, end), coupled_bounds(coupling, end, end)]
    np.testing.assert_allclose(np.array(together).T, np.array(alone))


@given(couplings, angles, angles, angles)
def test_what_is_always_allowed_is_allowed_on_every_way(coupling, angle, start, end):
    lower, upper = coupled_bounds(coupling, start, end)
    assert not always_allowed(coupling, angle) or lower <= angle <= upper


@given(couplings, angles)
def test_bounds_of_no_way_are_the_tables_less_the_margin(coupling, angle):
    lower, upper = coupling.bounds(angle)
    expected = lower + COUPLING_MARGIN_RAD, upper - COUPLING_MARGIN_RAD
    assert coupled_bounds(coupling, angle, angle) == pytest.approx(expected)


@given(poses(), couplings)
def test_excess_is_the_way_back_inside(pose, coupling):
    excess = float(coupling_excess(coupling, pose))
    lower, upper = coupling.bounds(pose[coupling.by])
    nearest = np.clip(pose[coupling.joint], lower, upper)
    assert excess == pytest.approx(abs(pose[coupling.joint] - nearest))


def test_head_table_is_the_vendors():
    head = load_robot().couplings[0]
    assert np.degrees(head.bounds(np.radians(87.49))) == pytest.approx([-18.91, 11.46], abs=0.01)
    assert np.degrees(head.bounds(0.0)) == pytest.approx([-38.5, 29.51], abs=0.01)


def test_ankle_tables_mirror():
    robot = load_robot()
    left, right = robot.couplings[1:]
    for angle in np.linspace(-1.18, 0.92, 50):
        lower, upper = left.bounds(angle)
        assert right.bounds(angle) == pytest.approx((-upper, -lower), abs=1e-6)


def test_commands_stay_inside_the_limits(robot):
    lower, upper = command_bounds(robot)
    assert (lower >= robot.lower).all()
    assert (upper <= robot.upper).all()
    assert (lower < upper).all()


def test_limit_excess_counts_both_sides(robot):
    beyond = np.stack([robot.lower - 0.1, robot.upper + 0.2, (robot.lower + robot.upper) / 2])
    assert limit_excess(robot, beyond) == pytest.approx(np.array([[0.1] * 26, [0.2] * 26, [0.0] * 26]))
