"""The server: a page and a status over HTTP, everything else over one WebSocket address.

GET  /        the page, and the files beside it that the package has; nothing else of this machine
GET  /health  how many clients and robots there are
WS   /live    the protocol
"""

from __future__ import annotations

import asyncio
import json
import mimetypes
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager, suppress
from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from nao_sim.live import outgoing
from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.hub import Client, Hub
from nao_sim.live.jobs import end
from nao_sim.live.outbox import Outbox
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import LARGEST, Hello, Message, parse
from nao_sim.live.security import Allowance, Gate

PAGE = Path(__file__).parent / "page"
HELLO_S = 10.0  # in which a client must say what it wants
EVERY = 1.0  # s between looks for robots nobody came back for
NORMAL, REFUSED, GOING = 1000, 1008, 1001
_HEADERS = {
    "Content-Security-Policy": "default-src 'self'; connect-src 'self' ws: wss:; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
}


def application(hub: Hub, gate: Gate, page: Path = PAGE, clock: Clock = monotonic) -> Starlette:
    """The server's application.

    Args:
        hub: whom to connect to what.
        gate: who may connect.
        page: the folder of the page, read once.
        clock: what time it is.
    """
    files = _files(page)

    async def get(request: Request) -> Response:
        """A file of the page, by its name alone: what is not in the table is not there."""
        try:
            gate.check_request(request.headers)
        except LiveError as problem:
            return PlainTextResponse(f"{problem}\n", 403)
        found = files.get(request.url.path)
        if found is None:
            return PlainTextResponse("there is no such page; expected /, /health or a WebSocket at /live\n", 404)
        return Response(found[0], media_type=found[1], headers=_HEADERS)

    async def health(request: Request) -> Response:
        try:
            gate.check_request(request.headers)
        except LiveError as problem:
            return PlainTextResponse(f"{problem}\n", 403)
        return JSONResponse({"status": "ok", **hub.counts}, headers=_HEADERS)

    async def live(socket: WebSocket) -> None:
        await _Connection(hub, gate, socket, clock).serve()

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        await hub.start()
        tidying = asyncio.create_task(_tidy(hub))
        yield
        tidying.cancel()
        hub.farewell()
        await hub.stop()

    routes = [Route("/health", health), WebSocketRoute("/live", live), Route("/{path:path}", get)]
    return Starlette(routes=routes, lifespan=lifespan)


async def _tidy(hub: Hub) -> None:
    while True:
        await asyncio.sleep(EVERY)
        hub.tidy()


def _files(folder: Path) -> Mapping[str, tuple[bytes, str]]:
    """What can be got, by the path of its address: the files in a folder as they are at the start."""
    found = {}
    for path in sorted(folder.rglob("*")) if folder.is_dir() else ():
        if path.is_file() and not path.is_symlink():
            kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
            found[f"/{path.relative_to(folder).as_posix()}"] = (path.read_bytes(), kind)
    if "/index.html" in found:
        found["/"] = found["/index.html"]
    return found


class _Connection:
    """One WebSocket, from its first message to its last."""

    def __init__(self, hub: Hub, gate: Gate, socket: WebSocket, clock: Clock) -> None:
        self._hub, self._gate, self._socket, self._clock = hub, gate, socket, clock
        self._outbox, self._allowance = Outbox(clock), Allowance(clock=clock)

    async def serve(self) -> None:
        """Let the client in, and serve it until either side has enough."""
        try:
            self._gate.check_request(self._socket.headers)
        except LiveError:
            await self._socket.close(REFUSED)  # before it is accepted: HTTP 403
            return
        await self._socket.accept()
        try:
            self._hub.enter()
        except LiveError as problem:
            await self._refuse(problem)
            return
        try:
            await self._talk()
        except LiveError as problem:
            await self._refuse(problem)
        except WebSocketDisconnect:
            pass
        finally:
            self._hub.leave()

    async def _refuse(self, problem: LiveError) -> None:
        with suppress(RuntimeError, WebSocketDisconnect):
            await self._socket.send_text(outgoing.error(problem, fatal=True))
            await self._socket.close(REFUSED, problem.code)

    async def _talk(self) -> None:
        hello = await self._hello()
        client = self._hub.join(hello, self._outbox)
        reading, writing, _ = jobs = [
            asyncio.create_task(job) for job in (self._read(client), self._write(), self._watch())
        ]
        try:
            done, _ = await asyncio.wait(jobs, return_when=asyncio.FIRST_COMPLETED)
            for job in done:
                job.result()
            if reading in done:  # it said goodbye: what waits is still sent
                self._outbox.end()
                await asyncio.wait([writing], timeout=EVERY)
        finally:
            self._hub.part(client)
            await end(jobs)

    async def _hello(self) -> Hello:
        try:
            message = parse(await asyncio.wait_for(self._receive(), HELLO_S))
        except TimeoutError:
            raise LiveError("no_hello", f"nothing for {HELLO_S:g} s; expected a hello message") from None
        if not isinstance(message, Hello):
            raise LiveError("no_hello", "another message first; expected a hello message")
        self._gate.check_token(message.token)
        return message

    async def _receive(self) -> str | bytes:
        message = await self._socket.receive()
        if message["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(message.get("code", NORMAL))
        data: str | bytes | None = message.get("text")
        return message.get("bytes") or b"" if data is None else data

    async def _read(self, client: Client) -> None:
        """Hand on what the client says; who only watches may say goodbye and ping."""
        while True:
            data = await self._receive()
            self._allowance.spend()
            if len(data) > LARGEST:
                raise LiveError("too_large", f"a message of {len(data)} bytes; expected at most {LARGEST}")
            if client.hello.role == "person" and client.session is not None:
                if _is_bye(data):
                    break
                self._hub.say(client.session, data)
            elif self._watcher_said(parse(data)):
                break

    def _watcher_said(self, message: Message) -> bool:
        """Answer somebody who only watches; whether that was the last."""
        what = getattr(message, "what", None)
        if what == "ping":
            self._outbox.answer(outgoing.text("pong", echo=getattr(message, "echo", None), server_time=self._clock()))
        elif what != "bye":
            problem = LiveError("read_only", "an observer's message; expected ping or bye: it may not move the robot")
            self._outbox.answer(outgoing.error(problem))
        return what == "bye"

    async def _write(self) -> None:
        while (text := await self._outbox.next()) is not None:
            await self._socket.send_text(text)
        with suppress(RuntimeError):
            await self._socket.close(GOING, "bye")

    async def _watch(self) -> None:
        """Let go of who takes nothing."""
        while not self._outbox.stuck:
            await asyncio.sleep(EVERY)


def _is_bye(data: str | bytes) -> bool:
    """Whether a message says goodbye, without reading every frame here, too."""
    if isinstance(data, bytes) or '"bye"' not in data:
        return False
    with suppress(ValueError, RecursionError):
        message = json.loads(data)
        return isinstance(message, dict) and message.get("type") == "bye"
    return False
