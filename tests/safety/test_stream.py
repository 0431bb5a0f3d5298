"""Gaps, silence and jumps in what a source asks."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.robot import load_robot
from nao_sim.safety.stream import CAUGHT_UP, JUMP, STALE, Stream

DT = 0.02
ROBOT = load_robot()
START = ROBOT.postures["StandInit"]
ARM, HAND = ROBOT.index["LShoulderPitch"], ROBOT.index["LHand"]
NOTHING = np.full(26, np.nan)
STOP = np.linspace(-0.3, 0.3, 26)  # where a full stop would end
seeds = st.integers(0, 2**32 - 1)


class Follower:
    """A stream, and a robot that is told to be somewhere on the way to what is asked."""

    def __init__(self, watched=True):
        self.stream, self.position = Stream(ROBOT, START, watched), START.copy()

    def step(self, requested, share=1.0, dt=DT):
        """The stream's answer; then the robot goes a share of its way there."""
        request, forgone, slow = self.stream.step(requested, dt, self.position, lambda: STOP)
        self.position = self.position + share * (request - self.position)
        return request.copy(), forgone.copy(), slow.copy()


def _asked(joint, value):
    return np.where(np.arange(26) == joint, value, START)


@settings(max_examples=30)
@given(seeds, st.integers(1, 60))
def test_a_steady_stream_passes_unchanged(seed, count):
    random, follower, request = np.random.default_rng(seed), Follower(), START.copy()
    given_ = random.random(26) < 0.7
    for _ in range(count):
        request = request + random.uniform(-0.9, 0.9, 26) * JUMP
        asked = np.where(given_, request, np.nan)
        answer, forgone, slow = follower.step(asked)
        assert np.array_equal(answer, np.where(given_, request, START))
        assert not forgone.any()
        assert not slow.any()


@settings(max_examples=30)
@given(seeds)
def test_a_gap_holds_the_last_request(seed):
    """For as long as the source may come back."""
    random, follower, last = np.random.default_rng(seed), Follower(), START.copy()
    silent = np.zeros(26)
    for _ in range(60):
        gap = (random.random(26) < 0.5) & (silent + DT <= STALE)
        silent = np.where(gap, silent + DT, 0.0)
        asked = np.where(gap, random.choice([np.nan, np.inf, -np.inf], 26), last + random.uniform(-0.3, 0.3, 26))
        last = np.where(gap, last, asked)
        answer, forgone, _ = follower.step(asked, share=0.1)
        assert np.array_equal(answer, last)
        assert not forgone.any()


@pytest.mark.parametrize("dt", [0.01, 0.02, 0.05, 0.3])
@given(target=st.floats(-1.5, 1.5))
@settings(max_examples=10)
def test_a_joint_on_its_way_stops_once_its_source_has_been_silent_for_long(dt, target):
    follower, asked = Follower(), _asked(ARM, target)
    follower.step(asked, share=0.0, dt=dt)
    on_its_way, silent = abs(target - START[ARM]) > CAUGHT_UP, 0.0
    for _ in range(60):
        answer, forgone, _ = follower.step(NOTHING, share=0.0, dt=dt)
        silent += dt
        held = STOP[ARM] if on_its_way and silent > STALE else target
        assert answer[ARM] == held
        assert forgone[ARM] == pytest.approx(held - target, abs=1e-12)
        assert not np.delete(forgone, ARM).any()
    answer, forgone, _ = follower.step(asked, share=0.0, dt=dt)
    assert answer[ARM] == target
    assert not forgone.any()


def test_a_joint_that_has_arrived_stays_when_its_source_falls_silent():
    follower, asked = Follower(), _asked(ARM, 0.4)
    for _ in range(10):
        follower.step(asked)
    for _ in range(100):
        answer, forgone, slow = follower.step(NOTHING)
        assert np.array_equal(answer, asked)
        assert not forgone.any()
        assert not slow.any()


def test_a_joint_that_is_asked_beyond_its_limit_has_arrived_there():
    follower, asked = Follower(), _asked(ARM, 9.0)
    follower.step(asked)
    follower.position = np.clip(follower.position, ROBOT.lower, ROBOT.upper)
    for _ in range(30):
        answer, _, _ = follower.step(NOTHING, share=0.0)
    assert answer[ARM] == 9.0


@settings(max_examples=30)
@given(seeds)
def test_joints_that_were_never_asked_are_never_stale(seed):
    random, follower = np.random.default_rng(seed), Follower()
    asked_ever = np.arange(26) < 13
    follower.position = START + random.uniform(-1.0, 1.0, 26)
    for _ in range(40):
        gone = random.random() < 0.5
        answer, forgone, slow = follower.step(np.where(asked_ever & ~gone, START, np.nan), share=0.0)
        assert np.array_equal(answer[13:], START[13:])
        assert not forgone[13:].any()
        assert not slow[13:].any()


@given(st.integers(0, 25), st.floats(0.55, 6.0), st.booleans(), st.integers(0, 9))
def test_who_jumps_is_slow_until_he_has_caught_up(joint, way, up, silent):
    """Farther than the motor goes meanwhile; only as far as the joint can go, and never a hand."""
    follower = Follower()
    follower.step(START)
    for _ in range(silent):
        follower.step(NOTHING)
    asked = _asked(joint, START[joint] + (way if up else -way))
    possible = np.clip(asked, ROBOT.lower, ROBOT.upper)
    far = abs(possible[joint] - START[joint]) > JUMP + ROBOT.no_load_speed[joint] * (silent + 1) * DT
    for _ in range(60):
        before = np.abs(possible - follower.position)[joint] > CAUGHT_UP
        _, _, slow = follower.step(asked, share=0.0)
        assert slow[joint] == (far and before and not ROBOT.is_hand[joint])
        assert not np.delete(slow, joint).any()
        follower.position = follower.position + 0.1 * (possible - follower.position)
    assert not slow.any()
    follower.step(asked + 0.3, share=0.0)
    assert not slow.any()


def test_the_first_request_is_seen_from_where_the_robot_is():
    _, _, slow = Follower().step(_asked(ARM, START[ARM] - 2.0))
    assert np.flatnonzero(slow).tolist() == [ARM]


def test_a_hand_may_open_at_once():
    stream = Stream(ROBOT, _asked(HAND, 0.0))
    for _ in range(10):
        _, _, slow = stream.step(_asked(HAND, 1.0), 0.001, _asked(HAND, 0.0), lambda: STOP)
        assert not slow.any()


def test_who_follows_a_fast_source_is_not_slow():
    """What moves as fast as the motor can is no jump, however seldom it is told."""
    follower = Follower()
    for step in range(8):
        asked = _asked(ARM, START[ARM] - ROBOT.no_load_speed[ARM] * 0.1 * step)
        _, _, slow = follower.step(asked, dt=0.1)
        assert not slow.any()


@settings(max_examples=30)
@given(seeds)
def test_unwatched_streams_have_their_gaps_filled_for_ever_and_nobody_is_slow(seed):
    random, follower, last = np.random.default_rng(seed), Follower(watched=False), START.copy()
    for _ in range(40):
        asked = np.where(random.random(26) < 0.1, random.uniform(-9.0, 9.0, 26), np.nan)
        last = np.where(np.isfinite(asked), asked, last)
        answer, forgone, slow = follower.step(asked, share=0.05)
        assert np.array_equal(answer, last)
        assert not forgone.any()
        assert not slow.any()
