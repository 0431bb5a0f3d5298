"""Who is connected to which robot, with robots that are made up and a clock that a test turns."""

from __future__ import annotations

import asyncio
import json

import pytest

from nao_sim.live.host import Inward, Outward
from nao_sim.live.hub import KEPT, MAIN, SILENT, Hub, Limits
from nao_sim.live.outbox import COMMANDS, MOST, STUCK, Outbox
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import Hello


class Robots:
    """Notes what it is sent."""

    def __init__(self) -> None:
        self.sent: list[Inward] = []

    async def start(self, heard, lost):
        """Begin."""

    def send(self, message):
        """Note it."""
        self.sent.append(message)

    async def stop(self):
        """End."""


class Watch:
    """A clock that stands until it is turned."""

    now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def watch():
    return Watch()


@pytest.fixture
def robots():
    return Robots()


@pytest.fixture
def hub(robots, watch, robot):
    return Hub(robots, robot, Limits(clients=3, robots=2), clock=watch)


def _read(outbox: Outbox) -> list[dict]:
    """All that waits for a client."""
    outbox.end()

    async def read():
        found = []
        while (text := await outbox.next()) is not None:
            found.append(json.loads(text))
        return found

    return asyncio.run(read())


def test_each_person_gets_a_robot_of_its_own_until_there_are_too_many(hub):
    first, second = (hub.join(Hello(), Outbox()) for _ in range(2))
    assert first.session != second.session
    with pytest.raises(LiveError, match="2 robots run; expected fewer"):
        hub.join(Hello(), Outbox())
    for _ in range(3):
        hub.enter()
    with pytest.raises(LiveError, match="3 clients are connected"):
        hub.enter()


def test_who_comes_back_in_time_finds_the_robot_and_who_does_not_finds_none(hub, robots, watch):
    client = hub.join(Hello(), Outbox())
    with pytest.raises(LiveError, match="another source moves this robot"):
        hub.join(Hello(session=client.session), Outbox())
    hub.part(client)
    watch.now += KEPT - 1
    hub.tidy()
    again = hub.join(Hello(session=client.session), Outbox())
    assert again.session == client.session
    hub.part(again)
    watch.now += KEPT + 1
    hub.tidy()
    assert robots.sent[-1] == Inward(client.session, "close")
    with pytest.raises(LiveError, match="expected one that waits"):
        hub.join(Hello(session=client.session), Outbox())


def test_a_second_source_is_told_that_the_robot_is_taken_until_the_first_is_silent(hub, watch):
    hub.claim(MAIN, Hello(), "one")
    hub.say(MAIN, "{}")
    with pytest.raises(LiveError) as refusal:
        hub.claim(MAIN, Hello(), "two")
    assert refusal.value.code == "taken"
    watch.now += SILENT + 0.1
    hub.claim(MAIN, Hello(), "two")
    hub.release(MAIN, "two")
    hub.claim(MAIN, Hello(), "three")


def test_states_go_to_who_watches_commands_to_robots_and_answers_to_the_person_alone(hub):
    boxes = {role: Outbox() for role in ("person", "observer", "robot", "seldom")}
    person = hub.join(Hello(), boxes["person"])
    hub.join(Hello(role="observer", session=person.session), boxes["observer"])
    hub.join(Hello(role="robot"), boxes["robot"])
    hub.join(Hello(role="observer", rate=25), boxes["seldom"])
    for kind in ("reply", "command", "state"):
        hub.heard(Outward(person.session, kind, json.dumps({"type": kind}), step=3))
    got = {role: [each["type"] for each in _read(box)] for role, box in boxes.items()}
    assert got == {
        "person": ["welcome", "reply", "state"],
        "observer": ["welcome", "state"],
        "robot": ["welcome", "command"],
        "seldom": ["welcome"],
    }


def test_a_robot_that_is_no_more_is_told_to_all_who_watch_it(hub):
    boxes = [Outbox(), Outbox()]
    person = hub.join(Hello(), boxes[0])
    hub.join(Hello(role="observer", session=person.session), boxes[1])
    hub.lost(person.session)
    assert [_read(box)[-1]["code"] for box in boxes] == ["lost", "lost"]
    with pytest.raises(LiveError, match="this robot is no more"):
        hub.say(person.session, "{}")


def test_who_does_not_read_gets_the_newest_state_and_keeps_nobody_waiting(watch):
    box = Outbox(watch)
    for i in range(1000):
        box.state(json.dumps({"state": i}))
        box.command(json.dumps({"command": i}))
    assert not box.stuck
    watch.now += STUCK + 0.1
    assert box.stuck
    waiting = _read(box)
    assert waiting == [*({"command": i} for i in range(1000 - COMMANDS, 1000)), {"state": 999}]
    assert box.skipped == 999 + 1000 - COMMANDS


def test_answers_that_nobody_takes_end_at_a_limit(watch):
    box = Outbox(watch)
    with pytest.raises(LiveError, match="answers are not read"):
        for _ in range(100):
            box.answer("x" * (MOST // 50))
