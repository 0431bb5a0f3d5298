"""Where the robots are, as the server's loop sees it: in processes of their own, or in the loop itself."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Protocol

from nao_sim.errors import UsageError
from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.host import Host, Inward, Outward
from nao_sim.live.moment import World
from nao_sim.live.worker import Orders, Unpacker, packed

MOST_WAITING = 4 << 20  # bytes for a process that does not read; more is passed over
START_S, STOP_S = 120.0, 3.0
Listener = Callable[[Outward], None]
Lost = Callable[[str], None]


class Robots(Protocol):
    """Where robots are."""

    async def start(self, heard: Listener, lost: Lost) -> None:
        """Begin; what robots say goes to `heard`, the names of robots that ended by accident to `lost`."""

    def send(self, message: Inward) -> None:
        """Hand over a message."""

    async def stop(self) -> None:
        """End all robots."""


class Here:
    """Robots in the server's own loop: for tests, and where one robot is all there is.

    Args:
        world: what they share.
        clock: what time it is.
    """

    def __init__(self, world: World, clock: Clock = monotonic) -> None:
        self._host, self._clock = Host(world), clock
        self._inbox: list[Inward] = []

    async def start(self, heard: Listener, lost: Lost) -> None:
        """Begin."""
        self._heard = heard
        self._wake = asyncio.Event()
        self._task = asyncio.create_task(self._run())

    def send(self, message: Inward) -> None:
        """Hand over a message."""
        self._inbox.append(message)
        self._wake.set()

    async def _run(self) -> None:
        while True:
            self._wake.clear()
            inbox, self._inbox = self._inbox, []
            for message in self._host.take(inbox, self._clock()) + self._host.step(self._clock()):
                self._heard(message)
            due = self._host.due
            wait = None if due is None else max(due - self._clock(), 0.0)
            with suppress(TimeoutError):
                await asyncio.wait_for(self._wake.wait(), wait)

    async def stop(self) -> None:
        """End all robots."""
        self._task.cancel()
        with suppress(asyncio.CancelledError):
            await self._task
        self._host.close()


class _Process:
    """One process with robots."""

    def __init__(self, orders: Orders) -> None:
        self._orders = orders
        self.robots: set[str] = set()
        self.runs = False

    async def start(self) -> None:
        """Start it, and wait until it is ready.

        Raises:
            UsageError: it ended before.
        """
        environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        self._process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "nao_sim.live.worker", stdin=-1, stdout=-1, env=environment
        )
        assert self._process.stdin and self._process.stdout
        self._in, self._out, self._unpacker = self._process.stdin, self._process.stdout, Unpacker()
        self._in.write(packed([self._orders]))
        while data := await asyncio.wait_for(self._out.read(1 << 16), START_S):
            if "ready" in list(self._unpacker.take(data)):
                self.runs = True
                return
        raise UsageError("a process for robots ended before it was ready; expected it to start (see above)")

    async def listen(self, heard: Listener) -> None:
        """Hand on what its robots say, until it ends."""
        while data := await self._out.read(1 << 18):
            for message in self._unpacker.take(data):
                heard(message)

    def send(self, message: Inward) -> None:
        """Hand over a message, unless it does not read; then frames are passed over."""
        if message.what == "message" and self._in.transport.get_write_buffer_size() > MOST_WAITING:
            return
        self._in.write(packed([message]))

    async def stop(self) -> None:
        """End it, and wait for that."""
        with suppress(OSError):
            self._in.close()
        try:
            await asyncio.wait_for(self._process.wait(), STOP_S)
        except TimeoutError:
            self._process.kill()
            await self._process.wait()


class Processes:
    """Robots in some processes, each new one in that with the fewest; a process that ends is replaced.

    Args:
        orders: what each process is told.
        count: how many.
    """

    def __init__(self, orders: Orders, count: int) -> None:
        self._orders, self._count = orders, count
        self._where: dict[str, _Process] = {}

    async def start(self, heard: Listener, lost: Lost) -> None:
        """Begin.

        Raises:
            UsageError: the processes cannot start.
        """
        self._heard, self._lost, self._stopping = heard, lost, False
        self._processes = [_Process(self._orders) for _ in range(self._count)]
        await asyncio.gather(*(process.start() for process in self._processes))
        self._tasks = [asyncio.create_task(self._keep(place)) for place in range(self._count)]

    async def _keep(self, place: int) -> None:
        """Listen to a process; when it ends, say whom that concerns, and start another."""
        while True:
            process = self._processes[place]
            await process.listen(self._heard)
            if self._stopping:
                return
            process.runs = False
            for robot in tuple(process.robots):
                self._where.pop(robot, None)
                self._lost(robot)
            fresh = _Process(self._orders)
            await fresh.start()
            self._processes[place] = fresh

    def send(self, message: Inward) -> None:
        """Hand over a message."""
        process = self._where.get(message.session)
        if process is None:
            if message.what != "open":
                return
            running = [each for each in self._processes if each.runs]
            if not running:
                asyncio.get_running_loop().call_soon(self._lost, message.session)
                return
            process = min(running, key=lambda each: len(each.robots))
            self._where[message.session] = process
            process.robots.add(message.session)
        if message.what == "close":
            del self._where[message.session]
            process.robots.discard(message.session)
        process.send(message)

    async def stop(self) -> None:
        """End all robots."""
        self._stopping = True
        await asyncio.gather(*(process.stop() for process in self._processes))
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
