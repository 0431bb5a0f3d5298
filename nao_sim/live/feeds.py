"""Sources that the server opens itself: a recording, the standard input, UDP. They move its own robot, `main`."""

from __future__ import annotations

import asyncio
import json
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import CancelledError
from contextlib import suppress
from dataclasses import replace
from typing import IO, Any

from nao_sim.errors import UsageError
from nao_sim.live import outgoing
from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.hub import MAIN, Hub
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import LARGEST, Angles, Frame, Hello, parse
from nao_sim.live.security import Allowance, Gate
from nao_sim.motion import JointTrajectory, Skeleton

Address = Any  # of a datagram: (host, port), or longer for IPv6
COMPLAINTS = 2.0  # datagrams a second that say what is wrong: nobody shall be flooded with them
WAITING = 8  # lines
PAUSE = 0.5  # s between two rounds of a recording


def frames_of(motion: Skeleton | JointTrajectory) -> Iterator[tuple[float, Frame | Angles]]:
    """The frames of a recording, and when (s) each is due from its first on."""
    for row, time in enumerate((motion.times - motion.times[0]).tolist()):
        if isinstance(motion, Skeleton):
            yield time, Frame(time, motion.positions[row], motion.confidence[row])
        else:
            yield time, Angles(time, motion.positions[row])


async def play_again(
    hub: Hub, motion: Skeleton | JointTrajectory, hello: Hello, loop: bool, clock: Clock = monotonic
) -> None:
    """Play a recording at the speed at which it was made, once or for ever."""
    joints = motion.joints if isinstance(motion, Skeleton) else ()
    began = clock()
    while True:
        hub.claim(MAIN, hello, "replay", joints)
        round_began = clock()
        for due, frame in frames_of(motion):
            await asyncio.sleep(round_began + due - clock())
            hub.say(MAIN, replace(frame, time=round_began - began + due))
        if not loop:
            return
        await asyncio.sleep(PAUSE)


async def standard_input(hub: Hub, hello: Hello, source: IO[bytes] | None = None) -> None:
    """Take lines from standard input, as fast as they come, until it ends."""
    lines: asyncio.Queue[bytes] = asyncio.Queue(WAITING)
    loop = asyncio.get_running_loop()
    # a thread that waits for a line must not keep the program from ending
    threading.Thread(target=_read, args=(source or sys.stdin.buffer, lines, loop), daemon=True).start()
    while line := await lines.get():
        try:
            hello = lines_hello(line) or hello
            hub.claim(MAIN, hello, "standard input")
            if line.strip() and lines_hello(line) is None:
                hub.say(MAIN, line.decode("utf-8", "replace"))
        except LiveError as problem:
            print(f"standard input: {problem}", file=sys.stderr)
    hub.release(MAIN, "standard input")


def _read(file: IO[bytes], lines: asyncio.Queue[bytes], loop: asyncio.AbstractEventLoop) -> None:
    """Put a file's lines, and an empty one at its end, into a queue of a loop in another thread."""
    line = b" "
    while line:
        line = file.readline(LARGEST)
        try:
            asyncio.run_coroutine_threadsafe(lines.put(line), loop).result()
        except (RuntimeError, CancelledError):  # the loop has ended
            return


def lines_hello(line: bytes) -> Hello | None:
    """The hello that a line is, if it is one.

    Raises:
        LiveError: it is a wrong one.
    """
    if b'"hello"' not in line:
        return None
    message = parse(line.decode("utf-8", "replace"))
    return message if isinstance(message, Hello) else None


class Datagrams(asyncio.DatagramProtocol):
    """Takes a frame, or a hello, from each UDP datagram.

    Args:
        hub: where the robot is.
        gate: who may; a server that is open to others wants its token in each datagram.
        hello: what frames are where nobody says it.
        clock: what time it is.
    """

    def __init__(self, hub: Hub, gate: Gate, hello: Hello, clock: Clock = monotonic) -> None:
        self._hub, self._gate, self._hello = hub, gate, hello
        self._told: dict[Address, Hello] = {}
        self._complaints, self._allowance = Allowance(COMPLAINTS, COMPLAINTS, clock), Allowance(clock=clock)

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Remember the socket."""
        self._transport = transport

    def datagram_received(self, data: bytes, addr: Address) -> None:
        """Hand it on, or say to its sender what is wrong with it; to strangers nothing."""
        try:
            self._allowance.spend()
            self._admit(data)
        except LiveError:
            return
        try:
            self._take(data, addr)
        except LiveError as problem:
            with suppress(LiveError):
                self._complaints.spend()
                self._transport.sendto(outgoing.error(problem).encode(), addr)  # type: ignore[attr-defined]

    def _admit(self, data: bytes) -> None:
        if self._gate.token is None:
            return
        try:
            told = json.loads(data)
        except (ValueError, RecursionError):
            told = None
        self._gate.check_token(str(told.get("token", "")) if isinstance(told, dict) else None)

    def _take(self, data: bytes, addr: Address) -> None:
        hello = lines_hello(data)
        if hello:
            self._told = {addr: hello}  # one source at a time: nobody else's need be kept
        sender = ("udp", addr)
        self._hub.claim(MAIN, hello or self._told.get(addr, self._hello), sender)
        if hello is None:
            self._hub.say(MAIN, data if data[:1] == b"N" else data.decode("utf-8", "replace"))


async def listen_udp(hub: Hub, gate: Gate, hello: Hello, host: str, port: int) -> asyncio.DatagramTransport:
    """Take datagrams at an address.

    Raises:
        UsageError: it is taken, or not this machine's.
    """
    loop = asyncio.get_running_loop()
    try:
        transport, _ = await loop.create_datagram_endpoint(lambda: Datagrams(hub, gate, hello), local_addr=(host, port))
    except OSError as error:
        raise UsageError(f"--udp {port} at {host}: {error.strerror or error}; expected a free port") from None
    return transport
