"""A real server at a real port: what only sockets and processes can show."""

from __future__ import annotations

import asyncio
import json
import signal
import socket
import subprocess
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from nao_sim.errors import UsageError
from nao_sim.live import outbox
from nao_sim.live.hub import Limits
from nao_sim.live.pool import Here
from nao_sim.live.run import Settings, serve
from nao_sim.paths import TRAJECTORIES
from nao_sim.recordings import load
from tests.live.senders import as_text, frames

PERSON = TRAJECTORIES / "person_wave.csv"
HELLO = json.dumps({"type": "hello"})
PATIENCE = 60.0  # s, until something is wrong


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _served(world, use: Callable[[str], Awaitable[None]], **settings: object) -> list[str]:
    """Run a server while something is done with it; what it said."""

    async def run() -> list[str]:
        said, stop = list[str](), asyncio.Event()
        serving = asyncio.create_task(serve(Settings(port=0, **settings), said.append, stop, Here(world)))  # type: ignore[arg-type]
        while not said and not serving.done():
            await asyncio.sleep(0.005)
        try:
            if not serving.done():
                await asyncio.wait_for(use(said[0].split("WebSocket ")[1].rstrip(")")), PATIENCE)
        finally:
            stop.set()
            await serving
        return said

    return asyncio.run(run())


async def _next(client, *kinds: str) -> dict:
    while True:
        message = json.loads(await client.recv())
        if message["type"] in kinds:
            return message


def test_a_message_of_100_mb_ends_its_own_connection_and_no_other(world):
    async def use(url: str) -> None:
        async with connect(url) as good, connect(url) as bad:
            await good.send(HELLO)
            await bad.send(HELLO)
            before = await _next(good, "state")
            with pytest.raises(ConnectionClosed) as end:
                await bad.send("x" * 100_000_000)
                while True:
                    await bad.recv()
            assert end.value.rcvd is None or end.value.rcvd.code == 1009
            assert (await _next(good, "state"))["step"] > before["step"]

    _served(world, use)


def test_fifty_idle_clients_and_one_that_never_reads_leave_a_person_every_step(world, monkeypatch):
    monkeypatch.setattr(outbox, "STUCK", 0.5)

    async def use(url: str) -> None:
        idle = [await connect(url) for _ in range(50)]
        deaf = await connect(url, max_queue=1)
        await deaf.send(json.dumps({"type": "hello", "role": "observer"}))
        async with connect(url) as person:
            await person.send(HELLO)
            steps = [(await _next(person, "state"))["step"] for _ in range(40)]
        assert steps[-1] - steps[0] <= 3 * len(steps), "states of other steps are left out, if any, by a slow machine"
        for client in [*idle, deaf]:
            client.transport.abort()

    _served(world, use, limits=Limits(clients=60, robots=4))


def test_programs_move_watch_and_are_the_robot_by_lines_and_datagrams(world, tmp_path):
    tcp, commands, udp = _free_port(), _free_port(), _free_port()

    async def use(_: str) -> None:
        await _by_datagram(udp)
        reader, writer = await asyncio.open_connection("127.0.0.1", tcp)
        writer.write(as_text(frames(1)[0]).encode() + b"\n")
        assert json.loads(await reader.readline())["type"] == "welcome"
        second, other = await asyncio.open_connection("127.0.0.1", tcp)
        other.write(as_text(frames(1)[0]).encode() + b"\n")
        assert json.loads(await second.readline())["code"] == "taken"
        for line in (b"garbage\n", b'{"time": 1, "points": [[0, 0, 0]]}\n'):
            writer.write(line)
        assert [json.loads(await reader.readline())["code"] for _ in range(2)] == ["bad_json", "wrong_size"]
        answers = []
        for frame in frames(12):  # each when the one before was taken
            writer.write(as_text(frame).encode() + b'\n{"type": "ping"}\n')
            while (answer := json.loads(await reader.readline())["type"]) != "pong":
                answers.append(answer)
        assert answers == ["understood"]
        robot, _ = await asyncio.open_connection("127.0.0.1", commands)
        assert json.loads(await robot.readline())["role"] == "robot"
        steps = [json.loads(await robot.readline()) for _ in range(5)]
        assert [each["step"] - steps[0]["step"] for each in steps] == list(range(5))
        assert all(len(each["positions"]) == 26 for each in steps)
        writer.close()
        await writer.wait_closed()

    said = _served(world, use, tcp=tcp, commands=commands, udp=udp, record=tmp_path / "kept.csv")
    assert [line.split()[0] for line in said] == ["serving", "udp", "tcp", "commands", "recording", "ends"]
    assert len(load(tmp_path / "kept.csv").motion) == 12


async def _by_datagram(port: int) -> None:
    """What is wrong is told to who sent it by UDP."""
    loop = asyncio.get_running_loop()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.setblocking(False)
        sender.connect(("127.0.0.1", port))
        await loop.sock_sendall(sender, b'{"type": "hello", "layout": "no such"}')
        assert json.loads(await loop.sock_recv(sender, 4096))["code"] == "unknown_layout"


def test_a_taken_port_is_said_in_one_line(world):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(UsageError, match=f"port {port}.*; expected a free"):
            asyncio.run(serve(Settings(port=port), print, None, Here(world)))

        async def nothing(_: str) -> None:
            raise AssertionError("served all the same")

        with pytest.raises(UsageError, match=f"TCP port {port} .*; expected a free one"):
            _served(world, nothing, tcp=port)


def test_the_command_plays_a_recording_to_observers_and_ends_with_status_0_when_told(tmp_path):
    kept = tmp_path / "kept.csv"
    words = ["live", "--port", "0", "--replay", str(PERSON), "--loop", "--record", str(kept)]
    environment = {
        "PYTHONPATH": str(Path(__file__).resolve().parents[2]),
        "PATH": "/usr/bin:/bin",
        "PYTHONUNBUFFERED": "1",
    }
    with subprocess.Popen(
        [sys.executable, "-m", "nao_sim.cli", *words], stdout=subprocess.PIPE, env=environment, text=True
    ) as server:
        assert server.stdout is not None
        url = server.stdout.readline().split("WebSocket ")[1].rstrip(")\n")
        ends = asyncio.run(_watched(url, server))
        assert server.wait(PATIENCE) == 0
    assert ends == "bye"
    rows = kept.read_text(encoding="utf-8").splitlines()
    assert len(rows) > 10
    assert all(row.count(",") == rows[0].count(",") for row in rows)


async def _watched(url: str, server: subprocess.Popen) -> str:
    """Watch until the robot has moved, end the server, and say how that was told."""
    async with connect(url) as observer:
        await observer.send(json.dumps({"type": "hello", "role": "observer"}))
        state = await _next(observer, "state")
        while state["frames"]["received"] < 12:
            state = await _next(observer, "state")
        assert state["light"]["colour"] != "red"
        server.send_signal(signal.SIGTERM)
        return str((await _next(observer, "bye"))["type"])
