"""Clocks, gaps, rates and who may connect: the small rules that a server stands on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.errors import UsageError
from nao_sim.live.clock import Beat
from nao_sim.live.playout import HELD, Playout
from nao_sim.live.problem import LiveError
from nao_sim.live.security import Allowance, Gate, gate_for
from nao_sim.live.timing import Arrivals


def test_a_beat_never_drifts_and_leaves_out_what_it_missed():
    beat = Beat(10.0)
    now, steps = 10.0, 0
    while now < 70.0:
        while beat.take(now):
            steps += 1
        now += 0.003
    assert steps == 3000
    assert beat.skipped == 0
    assert sum(beat.take(80.0) for _ in range(100)) <= 6, "what was missed is not made up for"
    assert beat.skipped > 400


@settings(max_examples=30)
@given(st.floats(-1e6, 1e6), st.floats(-2e-4, 2e-4), st.integers(0, 100))
def test_delays_are_told_whatever_the_senders_clock_and_its_drift(offset, drift, seed):
    random = np.random.default_rng(seed)
    arrivals = Arrivals()
    for i in range(300):
        made = i / 30
        late = 0.4 if i == 299 else random.uniform(0.0, 0.02)
        arrivals.take(made * (1.0 + drift) + offset, made + late)
        assert arrivals.delay < 0.03 or i == 299
    assert arrivals.delay == pytest.approx(0.4, abs=0.03)
    assert arrivals.interval == pytest.approx(1 / 30, rel=1e-3)


@settings(max_examples=30)
@given(st.lists(st.floats(0.0, 0.05), min_size=5, max_size=20), st.integers(0, 100))
def test_requests_are_between_those_of_the_frames_beside_them(late, seed):
    random = np.random.default_rng(seed)
    playout, asked = Playout(), random.normal(size=(len(late), 26))
    came = np.maximum.accumulate(np.arange(len(late)) / 30 + late)
    for i, now in enumerate(came):
        playout.add(i / 30, asked[i], now)
        found = playout.at(now, 1 / 30)
        recent = asked[max(i - 8, 0) : i + 1]
        assert (found >= recent.min(axis=0) - 1e-9).all()
        assert (found <= recent.max(axis=0) + 1e-9).all()
    assert playout.at(came[-1] + HELD + 0.01, 1 / 30) is None


def test_messages_beyond_the_allowance_are_refused_until_it_fills_again():
    now = [0.0]
    allowance = Allowance(100.0, 10.0, lambda: now[0])
    for _ in range(10):
        allowance.spend()
    with pytest.raises(LiveError, match="more than 100 messages a second"):
        allowance.spend()
    now[0] += 0.5
    allowance.spend()


@pytest.mark.parametrize(
    ("headers", "code"),
    [
        ({"host": "localhost:8765"}, None),
        ({"host": "127.0.0.1:8765", "origin": "http://127.0.0.1:8765"}, None),
        ({"host": "[::1]:8765"}, None),
        ({"host": "localhost:8765", "origin": "https://lab.org"}, None),
        ({"host": "localhost:8765", "origin": "http://evil.org"}, "bad_origin"),
        ({"host": "localhost:8765", "origin": "null"}, "bad_origin"),
        ({"host": "localhost:8765", "origin": "http://localhost:9999"}, "bad_origin"),
        ({"host": "evil.org:8765", "origin": "http://evil.org:8765"}, "bad_host"),
        ({"host": "localhost.evil.org"}, "bad_host"),
        ({"host": "[::1"}, "bad_host"),
        ({}, "bad_host"),
    ],
)
def test_on_loopback_only_our_own_pages_and_names_come_in(headers, code):
    gate = gate_for("127.0.0.1", None, ("https://lab.org",))
    if code is None:
        gate.check_request(headers)
        gate.check_token(None)
    else:
        with pytest.raises(LiveError) as refusal:
            gate.check_request(headers)
        assert refusal.value.code == code


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.2", "example.org"])
def test_elsewhere_a_token_is_made_and_asked_for(host):
    gate = gate_for(host, None)
    assert gate.token is not None
    assert len(gate.token) > 20
    assert gate.token != gate_for(host, None).token
    for wrong in (None, "", "wrong", gate.token[:-1], gate.token + "x", "ü" * 24):
        with pytest.raises(LiveError, match="no token, or a wrong one"):
            gate.check_token(wrong)
    gate.check_token(gate.token)
    Gate(loopback=False).check_request({"host": "robot.lab:8765"})


def test_a_token_that_can_be_guessed_is_refused():
    with pytest.raises(UsageError, match="12 or more"):
        gate_for("0.0.0.0", "secret")
