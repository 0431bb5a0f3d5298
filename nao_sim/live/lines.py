"""The protocol over TCP, a JSON text a line: for programs that move the robot, watch it, or are it."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from dataclasses import replace

from nao_sim.errors import UsageError
from nao_sim.live import outgoing
from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.feeds import lines_hello
from nao_sim.live.hub import MAIN, Client, Hub
from nao_sim.live.jobs import end
from nao_sim.live.outbox import Outbox
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import LARGEST, Hello
from nao_sim.live.security import Allowance, Gate

HELLO_S, EVERY = 10.0, 1.0  # s


class LineConnection:
    """One TCP connection.

    Args:
        hub: where robots are.
        gate: who may connect.
        hello: what a client is that begins without a hello.
        reader: what it says.
        writer: what it is told.
        clock: what time it is.
    """

    def __init__(  # two ends and whom they lead to
        self,
        hub: Hub,
        gate: Gate,
        hello: Hello,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
        clock: Clock = monotonic,
    ) -> None:
        self._hub, self._gate, self._hello, self._reader, self._writer = hub, gate, hello, reader, writer
        self._outbox, self._allowance = Outbox(clock), Allowance(clock=clock)
        self._name = ("tcp", writer.get_extra_info("peername"))
        self._client: Client | None = None

    async def serve(self) -> None:
        """Serve it until either side has enough."""
        try:
            self._hub.enter()
        except LiveError as problem:
            await self._last(problem)
            return
        try:
            await self._talk()
        except LiveError as problem:
            await self._last(problem)
        except OSError:
            pass
        finally:
            if self._client:
                self._hub.part(self._client)
            self._hub.release(MAIN, self._name)
            self._hub.leave()
            self._writer.close()

    async def _last(self, problem: LiveError) -> None:
        with suppress(OSError):
            self._writer.write(outgoing.error(problem, fatal=True).encode() + b"\n")
            await asyncio.wait_for(self._writer.drain(), EVERY)
        self._writer.close()

    async def _talk(self) -> None:
        line = b"" if self._hello.role == "robot" and self._gate.token is None else await self._first()
        hello = lines_hello(line) or self._hello
        if self._hello.role == "robot":  # where commands go out, nobody comes in
            hello = replace(hello, role="robot")
        self._gate.check_token(hello.token)
        self._begin(replace(hello, token=None))
        if line and lines_hello(line) is None:
            self._take(line)
        jobs = [asyncio.create_task(job) for job in (self._read(), self._write(), self._watch())]
        try:
            done, _ = await asyncio.wait(jobs, return_when=asyncio.FIRST_COMPLETED)
            for job in done:
                job.result()
        finally:
            await end(jobs)

    async def _first(self) -> bytes:
        try:
            return await asyncio.wait_for(self._line(), HELLO_S)
        except TimeoutError:
            raise LiveError("no_hello", f"nothing for {HELLO_S:g} s; expected a hello, or a frame") from None

    async def _line(self) -> bytes:
        try:
            return await self._reader.readline()
        except ValueError:
            raise LiveError("too_large", f"a line of more than {LARGEST} bytes; expected shorter ones") from None

    def _begin(self, hello: Hello) -> None:
        self._hello = hello
        if hello.role != "person":
            self._client = self._hub.join(hello, self._outbox)
            return
        self._hub.claim(MAIN, hello, self._name)
        self._hub.listen(MAIN, self._outbox)
        self._outbox.answer(self._hub.welcome(MAIN, hello))

    async def _read(self) -> None:
        while line := await self._line():
            self._allowance.spend()
            if not line.strip():
                continue
            try:
                self._take(line)
            except LiveError as problem:
                self._outbox.answer(outgoing.error(problem))

    def _take(self, line: bytes) -> None:
        if self._hello.role != "person":
            raise LiveError("read_only", "an observer's message; expected none: it may not move the robot")
        hello = lines_hello(line)
        if hello:
            self._gate.check_token(hello.token)
            self._begin(replace(hello, token=None))
            return
        self._hub.claim(MAIN, self._hello, self._name)
        self._hub.listen(MAIN, self._outbox)
        self._hub.say(MAIN, line.decode("utf-8", "replace"))

    async def _write(self) -> None:
        while (text := await self._outbox.next()) is not None:
            self._writer.write(text.encode() + b"\n")
            await self._writer.drain()

    async def _watch(self) -> None:
        while not self._outbox.stuck:
            await asyncio.sleep(EVERY)


async def listen_tcp(hub: Hub, gate: Gate, hello: Hello, host: str, port: int) -> asyncio.Server:
    """Serve lines at an address.

    Raises:
        UsageError: it is taken, or not this machine's.
    """

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with suppress(asyncio.CancelledError):  # the server ends; what is raised here would be told as a failure
            await LineConnection(hub, gate, hello, reader, writer).serve()

    try:
        return await asyncio.start_server(serve, host, port, limit=LARGEST)
    except OSError as error:
        raise UsageError(f"TCP port {port} at {host}: {error.strerror or error}; expected a free one") from None
