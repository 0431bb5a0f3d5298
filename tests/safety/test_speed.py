"""Speed, acceleration and braking."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from nao_sim.robot import VERSIONS, load_robot
from nao_sim.safety.speed import Pace, speed_limits, stopping_speed, tracking_speed

DT = 0.02
JOINTS = 6
TOGETHER = np.arange(JOINTS) < 3  # of the joints, where some brake in step
BOUNDS = np.full(JOINTS, -1.0), np.full(JOINTS, 1.0)
steps = st.sampled_from([0.001, 0.01, 0.02, 0.033, 0.04])
accelerations = st.floats(0.5, 200.0)
seeds = st.integers(0, 2**32 - 1)


def _pace(random, together):
    return Pace(random.uniform(1.0, 8.0, JOINTS), random.uniform(5.0, 150.0, JOINTS), TOGETHER if together else None)


@st.composite
def movements(draw: st.DrawFn) -> tuple[Pace, np.ndarray, np.ndarray]:
    """A pace, positions and speeds (JOINTS,); some joints stand, and some may brake in step."""
    random = np.random.default_rng(draw(seeds))
    pace = _pace(random, draw(st.booleans()))
    speed = pace.top * random.uniform(-1.0, 1.0, JOINTS) * (random.random(JOINTS) < 0.8)
    return pace, random.uniform(-2.0, 2.0, JOINTS), speed


def _held(path, count):
    """A path (N, joints) that stands at its end until it has `count` poses."""
    return np.concatenate([path, np.repeat(path[-1:], count - len(path), axis=0)])


@given(movements(), steps)
def test_a_stop_is_what_braking_step_after_step_gives_and_its_rest_the_stop_from_there(movement, dt):
    pace, position, speed = movement
    stop = pace.stop(position, speed, dt)
    for count in range(len(stop) + 1, 0, -1):
        np.testing.assert_allclose(
            _held(pace.stop(position, speed, dt), count), _held(stop, len(stop) + 1)[-count:], rtol=0.0, atol=1e-6
        )
        position, speed = position + speed * dt, pace.braking(speed, dt)
    assert (np.abs(speed) < 1e-5).all()


@given(movements(), steps)
def test_a_stop_brakes_as_hard_as_the_joints_can_and_no_harder(movement, dt):
    pace, position, speed = movement
    stop = np.concatenate([position[None], pace.stop(position, speed, dt)])
    speeds = np.concatenate([np.diff(stop, axis=0) / dt, np.zeros((1, JOINTS))])
    braked = np.abs(speeds[:-1]) - np.abs(speeds[1:])
    hardest = np.minimum(pace.acceleration * dt, np.abs(speeds[:-1]))
    alone = np.ones(JOINTS, bool) if pace.together is None else ~pace.together
    assert (speeds * np.sign(speed) >= -1e-9).all()
    np.testing.assert_allclose(speeds[0], speed, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(braked[:, alone], hardest[:, alone], rtol=1e-5, atol=1e-6)
    assert (braked <= hardest * (1 + 1e-5) + 1e-6).all()
    np.testing.assert_allclose((braked / hardest.clip(1e-9)).max(axis=1)[speeds[:-1].any(axis=1)], 1.0, rtol=1e-3)


@given(movements(), steps)
def test_joints_that_brake_in_step_stay_on_a_straight_line(movement, dt):
    pace, position, speed = movement
    assume(pace.together is not None)
    gone = (pace.stop(position, speed, dt) - position)[:, TOGETHER]
    along = speed[TOGETHER] / max(np.linalg.norm(speed[TOGETHER]), 1e-9)
    np.testing.assert_allclose(gone, np.outer(gone @ along, along), rtol=0.0, atol=1e-9)


@given(movements(), steps)
def test_reach_is_the_derivative_of_a_stop(movement, dt):
    """By each joint's own speed; of joints that brake in step, along the way that they go."""
    pace, position, speed = movement
    taken = np.abs(speed) / (pace.acceleration * dt)
    assume((np.abs(taken - np.round(taken))[speed != 0.0] > 1e-3).all())  # no joint at the edge of a step
    way = np.ones(JOINTS) if pace.together is None else np.where(TOGETHER, speed, 1.0)
    less, more = (pace.stop(position, speed + h * way, dt) for h in (-1e-7, 1e-7))
    rows = len(pace.stop(position, speed, dt))
    difference = (_held(more, rows) - _held(less, rows)) / 2e-7
    np.testing.assert_allclose(pace.reach(speed, dt) * way, difference, rtol=0.0, atol=1e-5)


def test_motors_without_limits_stop_within_the_step():
    free = Pace(np.full(JOINTS, np.inf), np.full(JOINTS, np.inf), TOGETHER)
    position, speed = np.zeros(JOINTS), np.linspace(-50.0, 80.0, JOINTS)
    np.testing.assert_allclose(free.stop(position, speed, DT), (speed * DT)[None])
    assert not free.braking(speed, DT).any()
    assert np.array_equal(free.reach(speed, DT), np.full((1, JOINTS), DT))
    np.testing.assert_allclose(free.range(position, speed, BOUNDS, DT), np.array(BOUNDS) / DT)


@settings(max_examples=30)
@given(seeds, st.lists(steps, min_size=2, max_size=12))
def test_whatever_speeds_in_range_are_taken_every_next_step_may_be_a_stop_inside_the_bounds(seed, times):
    """However long the next steps are; where joints brake in step, the guard looks at the stop itself."""
    random = np.random.default_rng(seed)
    pace = _pace(random, False)
    position, speed = random.uniform(-0.999, 0.999, JOINTS), np.zeros(JOINTS)
    for dt, following in pairwise(times):
        low, high = pace.range(position, speed, BOUNDS, dt)
        braking = pace.braking(speed, dt)
        assert (low <= braking).all()
        assert (braking <= high).all()
        assert (np.abs([low, high]) <= pace.top * (1 + 1e-9)).all()
        assert (np.abs([low - speed, high - speed]) <= pace.acceleration * dt * (1 + 1e-9)).all()
        share = np.where(random.random(JOINTS) < 0.7, random.integers(0, 2, JOINTS), random.random(JOINTS))
        speed = low + share * (high - low)
        position = position + speed * dt
        for later in (following, 0.001, 0.04):
            stop = pace.stop(position, pace.braking(speed, later), later)
            assert (stop >= BOUNDS[0] - 1e-9).all()
            assert (stop <= BOUNDS[1] + 1e-9).all()


@given(seeds, steps, steps)
def test_what_is_in_reach_is_what_is_in_range(seed, before, dt):
    random = np.random.default_rng(seed)
    pace = _pace(random, together=False)
    position = random.choice([-0.95, -0.5, 0.0, 0.5, 0.95], JOINTS)
    first = pace.range(position, np.zeros(JOINTS), BOUNDS, before)
    speed = first[0] + random.random(JOINTS) * (first[1] - first[0])
    position = position + speed * before
    low, high = pace.range(position, speed, BOUNDS, dt)
    inside = low + random.random(JOINTS) * (high - low)
    assert pace.in_reach(inside, position, speed, BOUNDS, dt)
    assert pace.in_reach(low, position, speed, BOUNDS, dt)
    assert pace.in_reach(high, position, speed, BOUNDS, dt)
    for joint in range(JOINTS):
        for beyond in (low[joint] - 1e-4, high[joint] + 1e-4):
            asked = np.where(np.arange(JOINTS) == joint, beyond, inside)
            assert not pace.in_reach(asked, position, speed, BOUNDS, dt)


@given(st.floats(-1.0, 3.0), accelerations, steps)
def test_a_step_at_the_stopping_speed_and_the_stop_after_it_take_exactly_the_distance(distance, acceleration, dt):
    speed = float(stopping_speed(np.array([distance]), np.array([acceleration]), dt)[0])
    assert speed >= 0.0
    assert speed * dt + speed**2 / (2.0 * acceleration) == pytest.approx(max(distance, 0.0), rel=1e-9)


@settings(max_examples=20)
@given(seeds, st.sampled_from([0.01, 0.02, 0.04]))
def test_a_request_that_stands_still_is_reached_without_passing_it(seed, dt):
    random = np.random.default_rng(seed)
    pace, asked = _pace(random, together=False), random.uniform(*BOUNDS)
    position, speed = random.uniform(*BOUNDS), np.zeros(JOINTS)
    side = np.sign(asked - position)
    for _ in range(int(20 + (2.0 / pace.top + 2.0 * pace.top / pace.acceleration).max() / dt)):
        speed = np.clip(tracking_speed(asked, asked, position, pace, dt), *pace.range(position, speed, BOUNDS, dt))
        position = position + speed * dt
        assert (side * (position - asked) <= 1e-9).all()
    assert position == pytest.approx(asked, abs=1e-6)


@settings(max_examples=20)
@given(seeds, st.sampled_from([0.01, 0.02, 0.04]))
def test_a_request_within_the_motors_limits_passes_unchanged(seed, dt):
    random = np.random.default_rng(seed)
    pace = _pace(random, together=False)
    amplitude = random.uniform(0.05, 0.95, JOINTS)
    rate = 0.9 * np.minimum(pace.top / amplitude, np.sqrt(pace.acceleration / amplitude))
    requests = amplitude * np.sin(np.outer(dt * np.arange(50), rate) + random.uniform(0.0, 6.0, JOINTS))
    position, speed = requests[1], (requests[1] - requests[0]) / dt
    for before, request in pairwise(requests[1:]):
        wanted = tracking_speed(request, before, position, pace, dt)
        speed = np.clip(wanted, *pace.range(position, speed, BOUNDS, dt))
        position = position + speed * dt
        assert position == pytest.approx(request, abs=1e-9)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("fraction", [0.05, 0.8, 1.0])
def test_no_command_is_faster_than_the_fraction_of_the_motors_speed_or_than_what_it_follows(version, fraction):
    robot = load_robot(version)
    limits = speed_limits(robot, fraction)
    assert (limits > 0.0).all()
    assert (limits <= fraction * robot.no_load_speed + 1e-12).all()
    assert (limits <= robot.max_speed).all()
