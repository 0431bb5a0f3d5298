"""Several robots in one process: nobody's mistakes are anybody else's."""

from __future__ import annotations

import json

import numpy as np
import pytest

from nao_sim.live.host import BACKLOG, Host, Inward
from nao_sim.live.session import Session
from tests.live.senders import STEP, as_text, frames, opened, told


@pytest.fixture
def host(world):
    made = Host(world)
    yield made
    made.close()


def _all_steps(host: Host, until: float, start: float = 0.0) -> list:
    """Step at every due time, as a process does."""
    out, now = [], start
    while host.due is not None and host.due <= until:
        now = max(now, host.due)
        out += host.step(now)
    return out


def test_each_robot_steps_fifty_times_a_second_whatever_another_is_sent(host):
    opened(host, "good")
    opened(host, "bad", now=0.005)
    for i in range(60):
        told(host, b"\x00" * 100 if i % 2 else "{" * 50, "bad")
    out = _all_steps(host, 0.5)
    for name, steps in (("good", 26), ("bad", 25)):
        assert [o.step for o in out if o.session == name and o.kind == "state"] == list(range(1, steps + 1))


def test_mistakes_are_told_to_their_sender_and_frames_after_them_are_taken(host):
    opened(host)
    assert [each["code"] for each in told(host, "garbage")] == ["bad_json"]
    assert [each["code"] for each in told(host, b"garbage")] == ["bad_binary"]
    assert [each["code"] for each in told(host, '{"type": "hello"}')] == ["twice"]
    assert [each["code"] for each in told(host, '{"type": "download"}')] == ["no_recording"]
    assert [each["code"] for each in told(host, '{"type": "replay"}')] == ["nothing_to_replay"]
    answers = [each for frame in frames(12) for each in told(host, as_text(frame), now=frame.time)]
    assert [each["type"] for each in answers] == ["understood"]
    assert "unit m" in answers[0]["reason"]


def test_a_layout_that_nobody_knows_gets_no_robot(host):
    answer = json.loads(opened(host, layout="/etc/passwd")[0].text)
    assert (answer["code"], answer["fatal"]) == ("unknown_layout", True)
    assert len(host) == 0


def test_of_a_burst_the_newest_frames_are_taken(host):
    opened(host)
    told(host, '{"type": "record"}')
    burst = [Inward("a", "message", as_text(frame), 1.0) for frame in frames(30)]
    host.take(burst, 1.0)
    state = json.loads(host.step(1.0)[1].text)
    assert state["frames"]["received"] == BACKLOG
    assert state["frames"]["dropped"] == 30 - BACKLOG
    assert state["frames"]["lost"] == 0
    assert state["frame_time"] == pytest.approx(100.0 + 29 / 30, abs=1e-5)
    recording = told(host, '{"type": "download"}')
    assert recording[0]["frames"] == 30, "what was received is recorded, whatever the robot saw of it"


def test_a_machine_that_is_too_slow_leaves_steps_out_and_says_so(host):
    opened(host)
    host.step(0.0)
    states = [json.loads(host.step(now)[1].text) for now in np.arange(0.5, 1.0, STEP)]
    assert [state["step"] for state in states] == list(range(2, len(states) + 2)), "none is made up for in a hurry"
    assert host.due == pytest.approx(1.0, abs=0.15)
    for frame in frames(12):
        told(host, as_text(frame), now=1.0)
    assert host._seats["a"].beat.slow(1.0)


def test_a_robot_whose_program_fails_ends_alone(host, monkeypatch, capsys):
    opened(host, "a")
    opened(host, "b", now=0.001)
    step = Session.step
    fails = host._seats["a"].session
    monkeypatch.setattr(Session, "step", lambda self, *how: 1 / 0 if self is fails else step(self, *how))
    out = _all_steps(host, 0.1)
    failed = [json.loads(o.text) for o in out if o.session == "a"]
    assert [(each["code"], each["fatal"]) for each in failed] == [("internal", True)]
    assert sum(o.session == "b" and o.kind == "state" for o in out) == 5
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_commands_are_the_states_own_and_all_of_them(host):
    opened(host)
    out = _all_steps(host, 0.2)
    commands, states = ([json.loads(o.text) for o in out if o.kind == kind] for kind in ("command", "state"))
    assert [each["step"] for each in commands] == [each["step"] for each in states] == list(range(1, len(states) + 1))
    for command, state in zip(commands, states, strict=True):
        assert len(command["positions"]) == 26
        np.testing.assert_allclose(command["positions"], state["commanded"], atol=1e-4)


def test_a_source_that_takes_over_finds_the_robot_where_it_stands(host):
    opened(host)
    for frame in frames(25):
        told(host, as_text(frame), now=frame.time - 100.0)
        _all_steps(host, frame.time - 100.0)
    before = json.loads(host.step(1.0)[1].text)
    opened(host, layout="kinect_v2", now=1.0)
    after = json.loads(host.step(1.02)[1].text)
    assert after["step"] == before["step"] + 1
    assert after["light"]["reason"] == "waiting for the first frame"
    assert np.abs(np.subtract(after["commanded"], before["commanded"])).max() < 0.2
