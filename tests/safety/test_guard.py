"""The guard's promises on commands; the simulated joints are in tests/properties."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from nao_sim.robot import load_robot
from nao_sim.safety.coupling import coupling_excess
from nao_sim.safety.guard import Guard
from nao_sim.safety.position import command_bounds
from nao_sim.safety.rules import Rules
from nao_sim.safety.self_collision import CLEARANCE
from nao_sim.safety.self_distance import SelfDistance
from nao_sim.safety.speed import speed_limits
from tests.motions import poses, wild_motions

DT = 0.02
RULES = Rules()
LEAST = 0.005  # m between two commands; at commands it is the clearance


def _start():
    return load_robot().postures["StandInit"]


def _arms():
    robot = load_robot()
    return np.concatenate([robot.limbs[limb] for limb in ("Head", "LArm", "RArm")])


def _run(requests, standing=False, start=None, rules=RULES):
    guard = Guard(load_robot(), _start() if start is None else start, standing=standing, rules=rules)
    steps = [guard.step(request, DT) for request in requests]
    return np.array([command for command, _ in steps]), [changes for _, changes in steps]


def _reasons(changes):
    return {change.reason for step in changes for change in step}


def _check(commands, before, robot):
    """What holds for every command, whatever was asked."""
    distance = SelfDistance()
    assert np.isfinite(commands).all()
    lower, upper = command_bounds(robot)
    assert (commands >= lower - 1e-12).all()
    assert (commands <= upper + 1e-12).all()
    speeds = np.diff(np.concatenate([before[None], commands]), axis=0) / DT
    assert (np.abs(speeds) <= speed_limits(robot, 0.8) * (1 + 1e-6)).all()
    accelerations = np.diff(np.concatenate([np.zeros((1, 26)), speeds]), axis=0) / DT
    assert (np.abs(accelerations) <= robot.max_acceleration * (1 + 1e-5)).all()
    assert max(coupling_excess(coupling, commands).max() for coupling in robot.couplings) == 0.0
    assert (commands[:, robot.index["LHipYawPitch"]] == commands[:, robot.index["RHipYawPitch"]]).all()  # one motor
    assert distance.smallest(commands).min() >= CLEARANCE - 2e-6
    pieces = np.linspace(0.0, 1.0, 7)[1:-1, None, None]
    between = (commands[:-1] * (1 - pieces) + commands[1:] * pieces).reshape(-1, 26)
    assert distance.smallest(between).min() >= LEAST


@settings(max_examples=18)
@given(wild_motions(seconds=2.0), st.booleans())
def test_whatever_is_asked_every_command_keeps_every_rule(motion, standing):
    commands, _ = _run(motion.sample(np.arange(0, 2, DT)), standing)
    _check(commands, _start(), load_robot())


@settings(max_examples=8)
@given(wild_motions(seconds=2.0), st.booleans())
def test_guarding_twice_changes_nothing_more(motion, standing):
    once, _ = _run(motion.sample(np.arange(0, 2, DT)), standing)
    twice, changes = _run(once, standing)
    assert np.abs(twice - once).max() < 1e-6
    assert not any(changes)


@settings(max_examples=10)
@given(wild_motions(seconds=2.0), st.booleans())
def test_the_mirrored_request_gives_the_mirrored_command(motion, standing):
    """Of arms and head: the documented limits of hips and knees are not the same on both sides."""
    robot = load_robot()
    requests = motion.sample(np.arange(0, 2, DT))
    requests[:, np.setdiff1d(np.arange(26), _arms())] = np.nan
    plain, _ = _run(requests, standing)
    mirrored, _ = _run(robot.mirror(requests), standing)
    apart = np.abs(robot.mirror(mirrored) - plain).max(axis=1)
    assert np.degrees(apart.max()) < 0.01


@settings(max_examples=12)
@given(poses())
def test_a_constant_safe_request_is_reached(pose):
    """From where its straight way is barred, too: the start posture has the hands before the legs."""
    robot = load_robot()
    target = _start().copy()
    target[_arms()] = pose[_arms()]
    target = np.clip(target, *command_bounds(robot))
    settled, _ = _run([target] * 300)  # as safe as it can be made
    commands, _ = _run([settled[-1]] * 400)
    assert np.abs(commands[-1] - settled[-1]).max() < 1e-4


def test_a_safe_motion_passes_unchanged():
    from nao_sim.paths import TRAJECTORIES
    from nao_sim.recordings import load
    from nao_sim.simulation.performance import timeline

    for name in ("wave", "greeting", "arm_circles", "gestures/side", "gestures/up"):
        _, requests = timeline(load(TRAJECTORIES / f"{name}.csv").motion, _start())
        for standing in (True, False):
            commands, changes = _run(requests, standing)
            asked = np.isfinite(requests)
            assert np.abs((commands - requests)[asked]).max() < 1e-6, name
            assert not any(changes), name


def test_a_hand_pressed_to_the_chest_slides_and_may_leave_again(robot):
    inside = _start().copy()
    for side, sign in (("L", 1), ("R", -1)):
        inside[robot.index[f"{side}ShoulderPitch"]] = 0.6
        inside[robot.index[f"{side}ShoulderRoll"]] = -sign * 0.3
        inside[robot.index[f"{side}ElbowYaw"]] = -sign * 0.5
        inside[robot.index[f"{side}ElbowRoll"]] = -sign * 1.5
    lifted = inside.copy()
    lifted[[robot.index["LShoulderPitch"], robot.index["RShoulderPitch"]]] = 0.1
    commands, changes = _run([inside] * 150 + [lifted] * 100 + [_start()] * 200)
    assert "self_collision" in _reasons(changes)
    assert np.abs(commands[149] - inside).max() > 0.05
    pitch = robot.index["LShoulderPitch"]
    assert commands[149, pitch] - commands[249, pitch] > 0.4  # still pressed, and yet it went along
    assert np.abs(commands[-1] - _start()).max() < 1e-6


@pytest.mark.parametrize(
    "left_arm_deg",
    [(94, 20, -55, -55, 33), (67, 17, -2, -49, -61), (-81, -8, 53, -83, 21), (118, 14, -18, -47, 29)],
    ids=["hand by the thigh", "hand in the thigh", "forearm by the head", "hand in the hip"],
)
def test_who_starts_inside_a_forbidden_place_leaves_it_and_stays_out(robot, left_arm_deg):
    start, distance = _start().copy(), SelfDistance()
    start[robot.limbs["LArm"][:5]] = np.radians(left_arm_deg)
    assert distance.nearest(start).distance < CLEARANCE
    commands, _ = _run([start] * 100, start=start)
    gaps = distance.smallest(np.concatenate([start[None], commands]))
    out = int(np.argmax(gaps >= CLEARANCE - 1e-6))
    assert 0 < out < 50
    assert (np.diff(gaps[: out + 1]) > 0.0).all()
    assert gaps[out:].min() >= CLEARANCE - 1e-6


def test_the_head_waits_for_its_pitch_and_then_gets_where_it_is_asked(robot):
    yaw, pitch = robot.index["HeadYaw"], robot.index["HeadPitch"]
    down, side = _start().copy(), _start().copy()
    down[pitch] = robot.upper[pitch]
    side[pitch], side[yaw] = robot.upper[pitch], 1.9
    commands, changes = _run([down] * 60 + [side] * 150)
    assert commands[-1, yaw] == pytest.approx(1.9, abs=1e-6)
    assert commands[-1, pitch] < robot.upper[pitch] - 0.1
    assert "coupling" in _reasons(changes)


def test_what_is_not_a_number_asks_nothing_new(robot):
    arm = robot.index["LShoulderPitch"]
    up = _start().copy()
    up[arm] = 0.5
    broken = np.full(26, np.nan)
    broken[robot.index["RShoulderPitch"]] = np.inf
    commands, changes = _run([up] * 50 + [broken] * 50)
    assert commands[-1, arm] == pytest.approx(0.5)
    assert np.isfinite(commands).all()
    assert not any(changes[50:])


def test_a_source_that_falls_silent_is_not_followed_to_where_it_pointed(robot):
    arm = robot.index["LShoulderPitch"]
    away = _start().copy()
    away[arm] = -1.5
    commands, changes = _run([away] * 20 + [np.full(26, np.nan)] * 100)
    assert np.abs(np.diff(commands[-50:], axis=0)).max() == 0.0
    assert commands[-1, arm] > -1.0
    assert "stale" in _reasons(changes[30:])


def test_one_motor_turns_both_hips(robot):
    left, right = robot.index["LHipYawPitch"], robot.index["RHipYawPitch"]
    apart = _start().copy()
    apart[left], apart[right] = -0.3, 0.2
    commands, changes = _run([apart] * 100)
    assert np.array_equal(commands[:, left], commands[:, right])
    assert commands[-1, left] == pytest.approx(-0.05)
    assert any(change.reason == "one_motor" for change in changes[-1])


def test_a_rule_that_is_off_does_not_act(robot):
    inside = _start().copy()
    inside[robot.limbs["LArm"][:5]] = np.radians((67, 10, -2, -49, -61))
    guarded, _ = _run([inside] * 100)
    off = Rules(off=frozenset({"self_collision"}), accept_risk=True)
    free, changes = _run([inside] * 100, rules=off)
    distance = SelfDistance()
    assert distance.nearest(guarded[-1]).distance >= CLEARANCE - 1e-6
    assert distance.nearest(free[-1]).distance < CLEARANCE
    assert "self_collision" not in _reasons(changes)


@pytest.mark.parametrize("request_", [np.zeros(25), np.zeros((2, 26))])
def test_a_request_of_another_shape_is_refused(robot, request_):
    with pytest.raises(ValueError, match="26"):
        Guard(robot, _start(), standing=False).step(request_, DT)


@pytest.mark.parametrize("dt", [0.0, -0.02, np.nan, np.inf])
def test_a_step_without_time_is_refused(robot, dt):
    with pytest.raises(ValueError, match="dt"):
        Guard(robot, _start(), standing=False).step(_start(), dt)


class Sources(RuleBasedStateMachine):
    """Sources that come and go, at other rates, with gaps, jumps and silence."""

    def __init__(self):
        super().__init__()
        self.robot = load_robot()
        self.random = np.random.default_rng(0)
        self.distance = SelfDistance()
        self.guard = Guard(self.robot, _start(), standing=True)
        self.position, self.request = _start(), _start()

    def _step(self, request, dt=DT):
        before = self.position
        self.position, _ = self.guard.step(request, dt)
        self.moved = np.abs(self.position - before) / min(dt, 0.04)

    @rule(seed=st.integers(0, 10**6), steps=st.integers(1, 25))
    def switch(self, seed, steps):
        self.request = np.random.default_rng(seed).uniform(1.3 * self.robot.lower, 1.3 * self.robot.upper)
        for _ in range(steps):
            self._step(self.request)

    @rule(seed=st.integers(0, 10**6), speed=st.sampled_from([0.01, 0.1, 1.0]), steps=st.integers(5, 30))
    def drift(self, seed, speed, steps):
        way = np.random.default_rng(seed).normal(size=26) * speed
        for _ in range(steps):
            self.request = self.request + way * DT * 5
            self._step(self.request)

    @rule(steps=st.integers(1, 30))
    def silence(self, steps):
        for _ in range(steps):
            self._step(np.full(26, np.nan))

    @rule(dt=st.sampled_from([0.001, 0.01, 0.033, 0.1, 0.5, 10.0]))
    def late(self, dt):
        self._step(self.request, dt)

    @rule(seed=st.integers(0, 10**6))
    def gaps(self, seed):
        random = np.random.default_rng(seed)
        for _ in range(10):
            self._step(np.where(random.random(26) < 0.5, self.request, np.nan))

    @invariant()
    def is_safe(self):
        lower, upper = command_bounds(self.robot)
        assert (self.position >= lower).all()
        assert (self.position <= upper).all()
        if hasattr(self, "moved"):
            assert (self.moved <= speed_limits(self.robot, 0.8) * (1 + 1e-6)).all()
        assert self.distance.nearest(self.position).distance >= LEAST
        assert max(coupling_excess(c, self.position) for c in self.robot.couplings) <= np.radians(0.5)


TestSources = Sources.TestCase
TestSources.settings = settings(max_examples=10, stateful_step_count=12)
