"""The server from start to stop: sockets, sources and robots, until somebody ends it."""

from __future__ import annotations

import asyncio
import contextlib
import signal
import socket
import sys
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import uvicorn

from nao_sim.errors import UsageError
from nao_sim.live import feeds, lines
from nao_sim.live.hub import Hub, Limits
from nao_sim.live.pool import Here, Processes, Robots
from nao_sim.live.protocol import LARGEST, Hello, Role
from nao_sim.live.security import Gate, gate_for
from nao_sim.live.server import application
from nao_sim.live.worker import Orders, world_of
from nao_sim.motion import JointTrajectory, Skeleton
from nao_sim.robot import load_robot

FAREWELL_S = 0.2  # in which clients may hear that it ends
GRACE_S = 3  # in which connections may end by themselves
QUEUE = 32  # messages of one client that wait to be read


@dataclass(frozen=True)
class Settings:
    """Everything that a server can be told.

    Attributes:
        host: the address to listen at.
        port: where browsers connect; 0 for any free one.
        token: what clients must know; None for none on loopback, one of chance elsewhere.
        origins: web pages' origins that are let in besides the server's own.
        hello: what frames of the server's own sources are, and what is wanted of them.
        replay: a recording to play.
        loop: whether to begin it again at its end.
        stdin: whether to take frames from standard input.
        udp: port for frames by UDP, if any.
        tcp: port for the protocol by lines, if any.
        commands: port for the robot's commands by lines, if any.
        record: a file for what is received, if any.
        workers: processes for robots; 0 keeps them in the server's own.
        limits: how many clients and robots there may be.
        orders: which robot, gestures and rules.
    """

    host: str = "127.0.0.1"
    port: int = 8765
    token: str | None = None
    origins: tuple[str, ...] = ()
    hello: Hello = field(default_factory=Hello)
    replay: Skeleton | JointTrajectory | None = None
    loop: bool = False
    stdin: bool = False
    udp: int | None = None
    tcp: int | None = None
    commands: int | None = None
    record: Path | None = None
    workers: int = 1
    limits: Limits = field(default_factory=Limits)
    orders: Orders = field(default_factory=Orders)


Say = Callable[[str], None]


def run(settings: Settings, say: Say) -> None:
    """Serve until SIGINT or SIGTERM.

    Args:
        settings: what to serve.
        say: told what a user should know, line by line.

    Raises:
        UsageError: an address is taken, or a process cannot start.
    """
    asyncio.run(serve(settings, say))


async def serve(settings: Settings, say: Say, stop: asyncio.Event | None = None, robots: Robots | None = None) -> None:
    """Serve until SIGINT or SIGTERM, or until `stop` is set.

    Args:
        settings: what to serve.
        say: told what a user should know, line by line.
        stop: ends it, too.
        robots: where the robots are; as the settings say where None.

    Raises:
        UsageError: as `run`.
    """
    gate = gate_for(settings.host, settings.token, settings.origins)
    hub = Hub(robots or _robots(settings), load_robot(settings.orders.robot), settings.limits, settings.record)
    listener = _bound(settings.host, settings.port)
    try:
        await hub.start()
        await _serve(settings, gate, hub, listener, say, stop)
    finally:
        listener.close()
        await hub.stop()


def _robots(settings: Settings) -> Robots:
    return Processes(settings.orders, settings.workers) if settings.workers else Here(world_of(settings.orders))


async def _serve(
    settings: Settings, gate: Gate, hub: Hub, listener: socket.socket, say: Say, stop: asyncio.Event | None
) -> None:
    server = uvicorn.Server(
        uvicorn.Config(
            application(hub, gate),
            ws="websockets-sansio",
            ws_max_size=LARGEST,
            ws_max_queue=QUEUE,
            ws_per_message_deflate=False,
            log_level="error",
            access_log=False,
            server_header=False,
            proxy_headers=False,
            timeout_graceful_shutdown=GRACE_S,
        )
    )
    vars(server)["capture_signals"] = _not_at_all  # signals are handled here
    with _ended_by_signals(server, hub, stop):
        serving = asyncio.create_task(server.serve([listener]))
        while not server.started and not serving.done():
            await asyncio.sleep(0.01)
        try:
            async with _sources(settings, hub, gate):
                _announce(settings, gate, listener.getsockname()[1], say)
                await asyncio.wait([serving])
        finally:
            server.should_exit = True
            await serving


def _bound(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host, port))
    except (OSError, OverflowError) as error:
        listener.close()
        raise UsageError(f"--host {host} --port {port}: {error}; expected a free port of this machine") from None
    return listener


@contextlib.contextmanager
def _not_at_all() -> Iterator[None]:
    yield


@contextlib.contextmanager
def _ended_by_signals(server: uvicorn.Server, hub: Hub, stop: asyncio.Event | None) -> Iterator[None]:
    """Ctrl-C and SIGTERM end the server as it should; a second one at once."""
    loop, ended = asyncio.get_running_loop(), asyncio.Event()

    def leave() -> None:
        server.should_exit = True

    def end() -> None:
        hub.farewell()
        server.force_exit = ended.is_set()
        ended.set()
        loop.call_later(FAREWELL_S, leave)

    async def wait(event: asyncio.Event) -> None:
        await event.wait()
        end()

    waiting = asyncio.create_task(wait(stop)) if stop else None
    handled = []
    for number in (signal.SIGINT, signal.SIGTERM):
        with contextlib.suppress(ValueError, RuntimeError):  # not in the main thread
            loop.add_signal_handler(number, end)
            handled.append(number)
    try:
        yield
    finally:
        for number in handled:
            loop.remove_signal_handler(number)
        if waiting:
            waiting.cancel()


@contextlib.asynccontextmanager
async def _sources(settings: Settings, hub: Hub, gate: Gate) -> AsyncIterator[None]:
    """Everything that listens or plays besides the web server."""
    hello, host = settings.hello, settings.host
    jobs: list[Coroutine[Any, Any, None]] = []
    if settings.replay is not None:
        jobs.append(feeds.play_again(hub, settings.replay, hello, settings.loop))
    if settings.stdin:
        jobs.append(feeds.standard_input(hub, hello))
    open_ends: list[Any] = []
    if settings.udp is not None:
        open_ends.append(await feeds.listen_udp(hub, gate, hello, host, settings.udp))
    ports: tuple[tuple[int | None, Role], ...] = ((settings.tcp, "person"), (settings.commands, "robot"))
    for port, role in ports:
        if port is not None:
            open_ends.append(await lines.listen_tcp(hub, gate, replace(hello, role=role), host, port))
    tasks = [asyncio.create_task(job) for job in jobs]
    try:
        yield
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        for end in open_ends:
            end.close()


def _announce(settings: Settings, gate: Gate, port: int, say: Say) -> None:
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    say(f"serving   http://{host}:{port}/ (WebSocket ws://{host}:{port}/live)")
    for name, number, what in (
        ("udp", settings.udp, "a frame a datagram"),
        ("tcp", settings.tcp, "the protocol, a JSON text a line"),
        ("commands", settings.commands, "26 joint commands at 50 Hz, a JSON text a line"),
    ):
        if number is not None:
            say(f"{name:<9} {host}:{number} ({what})")
    if settings.record:
        more = f"{settings.record.stem}-2{settings.record.suffix}"
        say(f"recording {settings.record} ({more} and so on, where that is there, and for further robots)")
    if gate.token:
        name = socket.gethostname() if settings.host in {"0.0.0.0", "::"} else host
        say(f"token     {gate.token} (page: http://{name}:{port}/#token={gate.token})")
    say("ends      with Ctrl-C")
    sys.stdout.flush()
