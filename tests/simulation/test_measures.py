"""What is measured on a run."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull, QhullError

from nao_sim.simulation.measures import (
    balance,
    limit_violations,
    max_speed_ratio,
    stance,
    support_margin,
    tracking,
)
from nao_sim.simulation.rollout import Rollout
from nao_sim.simulation.simulator import State

SQUARE = np.array([(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)])
inside = st.floats(0.001, 0.099)


@given(inside, inside)
def test_inside_the_margin_is_the_way_to_the_nearest_edge(x, y):
    assert support_margin(np.array([x, y]), SQUARE) == pytest.approx(min(x, y, 0.1 - x, 0.1 - y), abs=1e-9)


@given(st.floats(0.0, 1.0), inside)
def test_outside_the_margin_is_negative(far, along):
    assert support_margin(np.array([0.1001 + far, along]), SQUARE) == pytest.approx(-(0.0001 + far), abs=1e-9)


@pytest.mark.parametrize("contacts", [np.zeros((0, 2)), SQUARE[:1], SQUARE[:2], np.array([(0, 0), (0.1, 0), (0.2, 0)])])
def test_on_less_than_an_area_nothing_stands(contacts):
    assert support_margin(np.array([0.05, 0.01]), contacts) < 0


@given(st.lists(st.tuples(inside, inside), min_size=3, max_size=8, unique=True), inside, inside)
def test_margins_agree_with_qhull(contacts, x, y):
    try:
        hull = ConvexHull(np.array(contacts))
    except QhullError:
        return  # all in a line
    expected = -(hull.equations[:, :2] @ [x, y] + hull.equations[:, 2]).max()
    assert support_margin(np.array([x, y]), np.array(contacts)) == pytest.approx(expected, abs=1e-6)


def test_a_lifted_corner_carries_nothing():
    lifted = SQUARE.copy()
    lifted[2] = np.nan
    centre = np.array([0.04, 0.04])
    both = support_margin(np.stack([centre, centre]), np.stack([SQUARE, lifted]))
    assert both == pytest.approx([0.04, 0.01 * np.sqrt(2)])


def _state(robot, **changes):
    rest = robot.postures["StandInit"]
    values = {"lowest": rest, "highest": rest, "fastest": np.zeros(26)} | changes
    return State(rest, np.zeros(26), np.zeros(7), touching=frozenset(), **values)


def test_a_limit_passed_between_control_steps_counts(robot):
    beyond = robot.postures["StandInit"].copy()
    beyond[robot.index["HeadYaw"]] = robot.upper[robot.index["HeadYaw"]] + np.radians(0.5)
    violations, excess = limit_violations(robot, [_state(robot), _state(robot, highest=beyond)])
    assert violations == 1
    assert np.degrees(excess) == pytest.approx(0.5)


def test_speed_is_counted_against_each_joints_own_motor(robot):
    fast = np.zeros(26)
    fast[robot.index["LHipRoll"]] = 2.0 * robot.no_load_speed[robot.index["LHipRoll"]]
    assert max_speed_ratio(robot, [_state(robot, fastest=fast)]) == pytest.approx(2.0)


@given(st.integers(1, 10))
def test_the_lag_is_the_delay_that_was_put_in(steps):
    time = 0.02 * np.arange(1, 301)
    command = np.zeros((300, 26))
    command[:, 3] = np.sin(3.0 * time)
    done = np.roll(command, steps, axis=0)
    done[:steps] = 0.0
    rollout = Rollout(time, command, command, done, command, np.tile([0, 0, 0.32, 1, 0, 0, 0], (300, 1)))
    rmse, lag = tracking(rollout)
    assert lag == pytest.approx(0.02 * steps, abs=2e-3)
    assert rmse[3] > 0
    assert rmse[4] == 0


def test_what_never_moves_has_no_lag():
    still = np.zeros((50, 26))
    rollout = Rollout(0.02 * np.arange(50), still, still, still, still, np.zeros((50, 7)))
    assert tracking(rollout)[1] is None


def test_a_standing_robot_stands_and_a_tilted_one_has_fallen(simulator, robot):
    sim = simulator("free")
    rest = np.tile(robot.postures["StandInit"], (5, 1))
    base = np.tile(sim.base_pose(), (5, 1))
    upright = balance(sim.model, Rollout(np.arange(5.0), rest, rest, rest, rest, base))
    assert not upright.fell
    assert 0.03 < upright.min_support_margin < 0.09
    base[3] = 0.0, 0.0, 0.1, np.cos(0.7), 0.0, np.sin(0.7), 0.0
    tilted = balance(sim.model, Rollout(np.arange(5.0), rest, rest, rest, rest, base))
    assert tilted.fell
    assert tilted.min_support_margin < upright.min_support_margin
    margins = stance(sim.model, Rollout(np.arange(5.0), rest, rest, rest, rest, base)).margin
    assert margins[3] == tilted.min_support_margin
    assert margins[[0, 1, 2, 4]] == pytest.approx(upright.min_support_margin)
