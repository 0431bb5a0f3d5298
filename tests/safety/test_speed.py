"""Speed, acceleration and braking."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from nao_sim.safety.speed import braking_path, next_speed, speed_limits, stopping_speed

DT = 0.02
distances = st.floats(0.0, 3.0)
accelerations = st.floats(0.5, 200.0)


def _stop(speed: float, acceleration: float) -> float:
    """Way of a stop that begins with one step at `speed`."""
    way = 0.0
    while speed > 0:
        way += speed * DT
        speed -= acceleration * DT
    return way


@given(distances, accelerations)
def test_a_stop_from_the_stopping_speed_ends_exactly_at_the_distance(distance, acceleration):
    speed = float(stopping_speed(np.array([distance]), np.array([acceleration]), DT)[0])
    assert _stop(speed, acceleration) == pytest.approx(distance, abs=1e-7)


@given(distances, accelerations)
def test_after_a_step_at_the_stopping_speed_the_next_one_is_reachable(distance, acceleration):
    a = np.array([acceleration])
    speed = stopping_speed(np.array([distance]), a, DT)
    following = stopping_speed(np.array([distance]) - speed * DT, a, DT)
    assert speed[0] - following[0] <= acceleration * DT * (1 + 1e-6) + 1e-9


@given(st.floats(-3.0, 3.0), st.floats(-6.0, 6.0), accelerations)
def test_a_braking_path_slows_down_at_full_deceleration_and_stands_at_its_end(position, speed, acceleration):
    path = braking_path(np.array([position]), np.array([speed]), np.array([acceleration]), DT)[:, 0]
    speeds = np.abs(np.concatenate([[speed], np.diff(path) / DT, [0.0]]))
    assert path[0] == position
    assert np.allclose(-np.diff(speeds)[:-1], np.minimum(acceleration * DT, speeds[:-2]), atol=1e-6)
    assert speeds[-2] <= acceleration * DT + 1e-6


@given(st.lists(st.floats(-2.0, 2.0), min_size=5, max_size=60), st.floats(1.0, 8.0), st.floats(5.0, 100.0))
def test_speed_and_acceleration_keep_their_limits(requests, top, acceleration):
    limits = np.array([top]), np.array([acceleration])
    position, speed = np.zeros(1), np.zeros(1)
    for before, request in pairwise([0.0, *requests]):
        following = next_speed(np.array([request]), np.array([before]), position, speed, limits, DT)
        assert abs(following[0]) <= top + 1e-9
        assert abs(following[0] - speed[0]) <= acceleration * DT + 1e-9
        position, speed = position + following * DT, following


@given(st.floats(-2.0, 2.0), st.floats(1.0, 8.0), st.floats(5.0, 100.0))
def test_a_request_that_stands_still_is_reached_without_passing_it(request_, top, acceleration):
    assume(abs(request_) > 1e-3)
    limits = np.array([top]), np.array([acceleration])
    position, speed = np.zeros(1), np.zeros(1)
    for _ in range(int(4 + (abs(request_) / top + 2 * top / acceleration) / DT) * 2):
        speed = next_speed(np.array([request_]), np.array([request_]), position, speed, limits, DT)
        position = position + speed * DT
        assert abs(position[0]) <= abs(request_) + 1e-9
    assert position[0] == pytest.approx(request_, abs=1e-6)


@given(st.floats(0.1, 3.0), st.floats(0.0, 2 * np.pi))
def test_a_request_within_reach_passes_unchanged(amplitude, phase):
    top, acceleration = np.array([5.0]), np.array([60.0])
    omega = min(0.9 * 5.0 / amplitude, np.sqrt(0.9 * 60.0 / amplitude))
    times = DT * np.arange(200)
    requests = amplitude * np.sin(omega * times + phase)
    position, speed = requests[1:2], (requests[1:2] - requests[0:1]) / DT
    for before, request in pairwise(requests[1:]):
        asked = np.array([request]), np.array([before])
        speed = next_speed(*asked, position, speed, (top, acceleration), DT)
        position = position + speed * DT
        assert position[0] == pytest.approx(request, abs=1e-9)


def test_no_command_is_faster_than_four_fifths_of_the_motor(robot):
    assert (speed_limits(robot) <= 0.8 * robot.no_load_speed + 1e-12).all()
