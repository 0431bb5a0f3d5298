"""Who is led round what bars his way."""

from __future__ import annotations

from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.guard import Guard
from nao_sim.safety.position import command_bounds
from nao_sim.safety.self_collision import CLEARANCE
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.safety.speed import Pace, speed_limits
from nao_sim.safety.wayfinder import CONSTANT, PATIENCE, Wayfinder

DT = 0.02
ENOUGH = 500  # steps
ROBOT = load_robot()
START = ROBOT.postures["StandInit"]
ARMS = np.concatenate([ROBOT.limbs["LArm"], ROBOT.limbs["RArm"]])[[0, 1, 2, 3, 4, 6, 7, 8, 9, 10]]  # without hands
DISTANCE = SelfDistance()
# ShoulderPitch, ShoulderRoll, ElbowYaw, ElbowRoll, WristYaw of the left and the right arm, from where and to where
PAIRS_DEG = {
    "crossed forearms change places": (
        (14.06, -7.68, -30.25, -71.38, 0.0, 48.55, 3.86, 22.98, 72.16, 0.0),
        (49.75, -8.95, -12.58, -66.02, 0.0, 17.48, 10.13, 16.23, 70.14, 0.0),
    ),
    "a forearm lies under the other": (
        (46.0, -3.0, -71.0, -76.0, 53.0, 87.29, 7.2, -97.45, 51.87, -12.0),
        (44.0, 10.0, -109.0, -41.0, 53.0, 26.22, 10.0, 17.9, 82.0, -47.8),
    ),
    "one arm comes from overhead": (
        (-50.0, 11.0, 63.0, -13.0, 88.0, 107.0, -20.0, -64.0, 30.0, 63.0),
        (57.0, -6.0, -92.0, -38.0, 31.0, 23.0, -1.0, -24.0, 61.0, 87.0),
    ),
}


def _pose(arms_deg):
    pose = START.copy()
    pose[ARMS] = np.radians(arms_deg)
    return pose


@cache
def _run(pair, mirrored=False):
    """Commands until the target is reached, and their reasons."""
    start, target = map(_pose, PAIRS_DEG[pair])
    if mirrored:
        start, target = ROBOT.mirror(start), ROBOT.mirror(target)
    guard, commands, reasons = Guard(ROBOT, start, standing=False), [], set()
    while len(commands) < ENOUGH and (not commands or np.abs(commands[-1] - target).max() > 1e-6):
        command, changes = guard.step(target, DT)
        commands.append(command)
        reasons |= {change.reason for change in changes}
    return np.array(commands), reasons, target


@pytest.mark.parametrize("pair", PAIRS_DEG)
def test_what_sliding_does_not_reach_is_reached_by_a_way_round(pair):
    commands, reasons, target = _run(pair)
    assert np.abs(commands[-1] - target).max() <= 1e-6
    assert "detour" in reasons
    assert DISTANCE.smallest(commands).min() >= CLEARANCE - 1e-6


def test_the_mirrored_request_is_led_the_mirrored_way():
    plain, mirrored = (_run("one arm comes from overhead", turned)[0] for turned in (False, True))
    np.testing.assert_allclose(ROBOT.mirror(mirrored), plain, rtol=0.0, atol=1e-6)


class Toy:
    """A wayfinder whose robot is where it is told to be; `looked` counts the poses that were looked at."""

    def __init__(self):
        self.looked = 0
        pace = Pace(speed_limits(ROBOT, 0.8), ROBOT.max_acceleration)
        promise = SimpleNamespace(allowed=self._allowed)
        self.wayfinder = Wayfinder(ROBOT, promise, command_bounds(ROBOT), pace)

    def _allowed(self, poses):
        self.looked += len(poses)
        return True

    def step(self, target, position=START):
        """Where it is led from there."""
        return self.wayfinder.step(target, position, DT)


def _elsewhere(way):
    target = START.copy()
    target[ARMS] += way
    return target


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.floats(1.2, 20.0))
def test_for_a_request_that_keeps_moving_no_way_is_sought(seed, pace):
    """Faster than what counts as standing still within the patience."""
    random, toy = np.random.default_rng(seed), Toy()
    way = random.uniform(-1.0, 1.0, 10)
    way *= pace * CONSTANT / PATIENCE * DT / np.abs(way).max()
    assert all(toy.step(_elsewhere(0.5 + step * way)) is None for step in range(100))
    assert not toy.looked


def test_for_a_request_that_is_reached_or_nearly_so_no_way_is_sought():
    toy = Toy()
    assert all(toy.step(_elsewhere(0.01)) is None for _ in range(100))
    assert not toy.looked


def test_while_the_robot_comes_nearer_no_way_is_sought():
    toy = Toy()
    assert all(toy.step(_elsewhere(0.5), _elsewhere(0.2 * DT * step)) is None for step in range(100))
    assert not toy.looked


def test_who_trembles_on_the_spot_does_not_come_nearer():
    toy = Toy()
    led = [toy.step(_elsewhere(0.5), _elsewhere(0.008 * (step % 2))) for step in range(100)]
    assert any(place is not None for place in led)


def test_who_stands_before_a_request_is_led_after_a_while_and_no_longer_when_another_is_made():
    toy = Toy()
    led = [toy.step(_elsewhere(0.5)) for _ in range(60)]
    patient = int(PATIENCE / DT)
    assert not any(place is not None for place in led[:patient])
    assert any(place is not None for place in led[patient:])
    assert toy.looked
    assert toy.step(_elsewhere(-0.5)) is None


def test_a_leg_is_led_nowhere_but_where_it_is_asked_to_be():
    toy, target = Toy(), _elsewhere(0.5)
    legs = np.concatenate([ROBOT.limbs["LLeg"], ROBOT.limbs["RLeg"]])
    target[legs] += 0.04
    for _ in range(60):
        led = toy.step(target)
        assert led is None or np.array_equal(led[legs], target[legs]) or np.array_equal(led[legs], START[legs])
