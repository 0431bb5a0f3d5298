"""The server's own sources and processes, with robots that are made up."""

from __future__ import annotations

import asyncio
import io
import itertools

import numpy as np
import pytest

from nao_sim.live import pool
from nao_sim.live.feeds import Datagrams, play_again, standard_input
from nao_sim.live.host import Inward
from nao_sim.live.hub import MAIN, Hub
from nao_sim.live.protocol import Angles, Frame, Hello
from nao_sim.live.security import Gate
from nao_sim.live.worker import Orders, Unpacker, packed
from nao_sim.motion import JointTrajectory, Skeleton
from tests.live.senders import as_text, frames
from tests.live.test_hub import Robots

TOKEN = "a-token-that-is-long"


@pytest.fixture
def robots():
    return Robots()


@pytest.fixture
def hub(robots, robot):
    return Hub(robots, robot)


def test_a_recording_is_played_in_a_loop_with_times_that_go_on(hub, robots):
    motion = Skeleton(np.array([5.0, 5.1, 5.3]), np.zeros((3, 1, 3)), ("head",))
    ticks = itertools.count(0.0, 0.4)

    async def play():
        task = asyncio.create_task(play_again(hub, motion, Hello(), True, lambda: next(ticks)))
        while len(robots.sent) < 8:
            await asyncio.sleep(0)
        task.cancel()

    asyncio.run(play())
    opened, *sent = robots.sent
    assert (opened.session, opened.what, opened.joints) == (MAIN, "open", ("head",))
    times = [each.data.time for each in sent[:6] if isinstance(each.data, Frame)]
    assert (np.diff(times) > 0.0).all()
    np.testing.assert_allclose(np.diff(times)[[0, 1, 3, 4]], [0.1, 0.2, 0.1, 0.2])


def test_a_recording_of_joint_angles_is_played_as_it_is(hub, robots):
    motion = JointTrajectory(np.array([0.0]), np.ones((1, 26)))
    asyncio.run(play_again(hub, motion, Hello(), False))
    assert isinstance(robots.sent[1].data, Angles)


def test_standard_input_is_taken_line_by_line_and_mistakes_are_told(hub, robots, capsys):
    lines = [
        '{"type": "hello", "layout": "no such"}',
        '{"type": "hello", "layout": "kinect_v2"}',
        "",
        as_text(frames(1)[0]),
    ]
    asyncio.run(standard_input(hub, Hello(), io.BytesIO("\n".join(lines).encode())))
    assert [each.what for each in robots.sent] == ["open", "message"]
    assert robots.sent[0].hello == Hello(layout="kinect_v2")
    assert "layout 'no such'; expected one of" in capsys.readouterr().err


@pytest.mark.parametrize("data", [b"", b"garbage", b"\xff\x00", b"[" * 5000, b'{"time": 1}', b'{"token": ["x"]}'])
def test_a_datagram_without_the_token_reaches_nobody_and_is_not_answered(hub, robots, data):
    told = []
    datagrams = Datagrams(hub, Gate(loopback=False, token=TOKEN), Hello())
    datagrams.connection_made(type("Transport", (), {"sendto": lambda _, *what: told.append(what)})())
    datagrams.datagram_received(data, ("10.0.0.1", 1))
    assert (robots.sent, told) == ([], [])
    datagrams.datagram_received(as_text(frames(1)[0], token=TOKEN).encode(), ("10.0.0.1", 1))
    assert [each.what for each in robots.sent] == ["open", "message"]


def test_values_come_whole_out_of_any_pieces():
    values = [Inward("a", "message", b"x" * size) for size in (0, 1, 1000)]
    data, unpacker = packed(values), Unpacker()
    assert [value for place in range(len(data)) for value in unpacker.take(data[place : place + 1])] == values


class _Mortal:
    """A process that ends when it is told to."""

    def __init__(self, orders):
        self.robots, self.runs, self.dead, self.sent = set(), False, asyncio.Event(), []

    async def start(self):
        self.runs = True

    async def listen(self, heard):
        await self.dead.wait()

    def send(self, message):
        self.sent.append(message)

    async def stop(self):
        self.dead.set()


def test_when_a_process_ends_its_robots_are_lost_and_others_and_new_ones_live_on(monkeypatch):
    monkeypatch.setattr(pool, "_Process", _Mortal)
    lost: list[str] = []

    async def end_one():
        processes = pool.Processes(Orders(), 2)
        await processes.start(lambda message: None, lost.append)
        for name in "abc":
            processes.send(Inward(name, "open", hello=Hello()))
        first = processes._where["a"]
        first.dead.set()
        for _ in range(5):
            await asyncio.sleep(0)
        assert processes._where["b"].sent, "b is elsewhere"
        processes.send(Inward("d", "open", hello=Hello()))
        assert processes._where["d"] is not first
        processes.send(Inward("a", "message", "{}"))
        await processes.stop()

    asyncio.run(end_one())
    assert sorted(lost) == ["a", "c"]
