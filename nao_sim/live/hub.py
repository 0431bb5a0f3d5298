"""Who is connected to which robot: the switchboard between clients, sources and robots."""

from __future__ import annotations

import secrets
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from nao_sim.live import outgoing
from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.host import Data, Inward, Outward
from nao_sim.live.outbox import Outbox
from nao_sim.live.person import layout_called
from nao_sim.live.pool import Robots
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import RATES, Hello
from nao_sim.robot import Robot

MAIN = "main"  # the robot of the server's own sources
KEPT = 30.0  # s that a robot waits for a person to come back
SILENT = 1.0  # s, after which another source may take the place of one of the server's own


@dataclass(frozen=True)
class Limits:
    """How much a server takes on.

    Attributes:
        clients: connections at once.
        robots: robots at once.
    """

    clients: int = 64
    robots: int = 16


@dataclass(eq=False)
class Client:
    """One connection.

    Attributes:
        hello: what it said first.
        outbox: what waits for it.
        session: which robot; None for whichever there is.
    """

    hello: Hello
    outbox: Outbox
    session: str | None = None


@dataclass
class _Line:
    """One robot as the hub knows it."""

    hello: Hello
    owner: object | None
    heard: float  # s, when its owner last said something, or left
    answers: Outbox | None = None
    watchers: list[Client] = field(default_factory=list)

    @property
    def boxes(self) -> list[Outbox]:
        """Where what concerns all goes, each once."""
        boxes = [client.outbox for client in self.watchers]
        return boxes if self.answers is None or self.answers in boxes else [*boxes, self.answers]


class Hub:
    """Keeps the lines; it has a state.

    Args:
        robots: where the robots are.
        robot: which version they are.
        limits: how many there may be.
        record: a file for what is received.
        clock: what time it is.
    """

    def __init__(
        self,
        robots: Robots,
        robot: Robot,
        limits: Limits | None = None,
        record: Path | None = None,
        clock: Clock = monotonic,
    ) -> None:
        self._robots, self._robot, self._limits = robots, robot, limits or Limits()
        self._record, self._clock = record, clock
        self._lines: dict[str, _Line] = {}
        self._anywhere: list[Client] = []  # who watches whichever robot there is
        self._connected, self._runs = 0, False

    @property
    def counts(self) -> dict[str, int]:
        """How many there are, for the status."""
        return {"clients": self._connected, "robots": len(self._lines)}

    async def start(self) -> None:
        """Begin, unless begun.

        Raises:
            UsageError: the robots' processes cannot start.
        """
        if not self._runs:
            await self._robots.start(self.heard, self.lost)
            self._runs = True

    def farewell(self) -> None:
        """Say goodbye to all."""
        boxes = [client.outbox for client in self._anywhere]
        for line in self._lines.values():
            boxes += line.boxes
        for outbox in boxes:
            self._answer(outbox, outgoing.text("bye", reason="the server ends"))
            outbox.end()

    async def stop(self) -> None:
        """End all robots, unless they have been."""
        if self._runs:
            self._runs = False
            await self._robots.stop()

    def enter(self) -> None:
        """Count a connection.

        Raises:
            LiveError: there are too many.
        """
        if self._connected >= self._limits.clients:
            raise LiveError("full", f"{self._limits.clients} clients are connected; expected fewer, try again later")
        self._connected += 1

    def leave(self) -> None:
        """Count a connection no more."""
        self._connected -= 1

    def join(self, hello: Hello, outbox: Outbox) -> Client:
        """Connect a client to a robot, a new one for a person who names none.

        Raises:
            LiveError: there is no such robot or layout, the robot has a source already, or there are too many.
        """
        client = Client(hello, outbox, hello.session)
        if hello.role == "person":
            client.session = self._take_place(client, hello)
        elif hello.session is not None and hello.session not in self._lines:
            raise LiveError("no_session", f"session {hello.session[:40]!a}; expected one that runs")
        watched = self._anywhere if client.session is None else self._lines[client.session].watchers
        watched.append(client)
        outbox.answer(outgoing.welcome(client.session or self.default, hello, self._robot))
        return client

    def _take_place(self, client: Client, hello: Hello) -> str:
        """The robot of a person, who comes anew or back."""
        if hello.session is None:
            name = secrets.token_hex(8)
            self.open(name, hello, client, client.outbox)
            return name
        line = self._lines.get(hello.session)
        if line is None or hello.session == MAIN:
            raise LiveError("no_session", f"session {hello.session[:40]!a} is over; expected one that waits, or none")
        if line.owner is not None:
            raise LiveError("taken", "another source moves this robot; expected it to have left")
        self.open(hello.session, hello, client, client.outbox)
        return hello.session

    def open(
        self,
        name: str,
        hello: Hello,
        owner: object,
        answers: Outbox | None = None,
        joints: tuple[str, ...] | None = None,
    ) -> None:
        """Get a robot, or give one another source.

        Raises:
            LiveError: there are too many, or no such layout.
        """
        layout_called(hello.layout)
        line = self._lines.get(name)
        if line is None:
            if len(self._lines) >= self._limits.robots:
                raise LiveError("full", f"{self._limits.robots} robots run; expected fewer, try again later")
            line = self._lines[name] = _Line(hello, owner, self._clock())
        line.hello, line.owner, line.heard, line.answers = hello, owner, self._clock(), answers
        self._robots.send(Inward(name, "open", came=self._clock(), hello=hello, record=self._record, joints=joints))

    def say(self, name: str, data: Data) -> None:
        """Hand a message to a robot."""
        line = self._lines.get(name)
        if line is None:
            raise LiveError("no_session", "this robot is no more; expected a new connection")
        line.heard = self._clock()
        self._robots.send(Inward(name, "message", data, line.heard))

    def part(self, client: Client) -> None:
        """Disconnect a client; a person's robot waits for a while."""
        if client in self._anywhere:
            self._anywhere.remove(client)
        line = self._lines.get(client.session or "")
        if line and client in line.watchers:
            line.watchers.remove(client)
        if line and line.owner is client:
            line.owner, line.answers, line.heard = None, None, self._clock()

    def claim(self, name: str, hello: Hello, owner: object, joints: tuple[str, ...] | None = None) -> None:
        """Make one of several sources that of a robot: the first, until it has been silent for a while.

        Raises:
            LiveError: another one is.
        """
        line = self._lines.get(name)
        if line is not None and line.owner == owner and line.hello == hello:
            return
        if line is not None and line.owner not in {None, owner} and self._clock() - line.heard <= SILENT:
            raise LiveError("taken", "another source moves this robot; expected it to have left")
        self.open(name, hello, owner, line.answers if line else None, joints)

    def release(self, name: str, owner: object) -> None:
        """A source has ended: another may take its place at once."""
        line = self._lines.get(name)
        if line is not None and line.owner == owner:
            line.owner, line.answers = None, None

    def welcome(self, name: str, hello: Hello) -> str:
        """What a source is told first."""
        return outgoing.welcome(name, hello, self._robot)

    def listen(self, name: str, answers: Outbox) -> None:
        """Send a robot's answers there, too."""
        if name in self._lines:
            self._lines[name].answers = answers

    @property
    def default(self) -> str | None:
        """The robot of who names none: the server's own, else the one that has run longest."""
        return MAIN if MAIN in self._lines else next(iter(self._lines), None)

    def heard(self, message: Outward) -> None:
        """Pass on what a robot says."""
        line = self._lines.get(message.session)
        if line is None:
            return
        if message.kind == "end":
            self._end(message.session, message.text)
        elif message.kind == "reply":
            if line.answers:
                self._answer(line.answers, message.text)
        else:
            self._show(message, line)

    def _show(self, message: Outward, line: _Line) -> None:
        for client in self._watching(message.session, line):
            if message.kind == "command" and client.hello.role == "robot":
                client.outbox.command(message.text)
            elif message.kind == "state" and client.hello.role != "robot" and _is_due(client.hello, message.step):
                client.outbox.state(message.text)

    def _watching(self, name: str, line: _Line) -> Sequence[Client]:
        return [*line.watchers, *self._anywhere] if self._anywhere and name == self.default else line.watchers

    @staticmethod
    def _answer(outbox: Outbox, text: str) -> None:
        try:
            outbox.answer(text)
        except LiveError:
            outbox.end()

    def lost(self, name: str) -> None:
        """A robot's process ended by accident: say so to all who watch it."""
        problem = LiveError("lost", "the process of this robot ended; expected it to run on: connect again")
        self._end(name, outgoing.error(problem, fatal=True))

    def _end(self, name: str, text: str) -> None:
        """A robot is no more: say so to all who watch it."""
        line = self._lines.pop(name, None)
        if line is None:
            return
        self._robots.send(Inward(name, "close"))
        for outbox in line.boxes:
            self._answer(outbox, text)
            outbox.end()

    def tidy(self) -> None:
        """Now and then: end robots for which nobody came back."""
        now = self._clock()
        for name in [name for name, line in self._lines.items() if _is_over(name, line, now)]:
            self._end(name, outgoing.text("bye", reason="the person has left"))


def _is_over(name: str, line: _Line, now: float) -> bool:
    return name != MAIN and line.owner is None and now - line.heard > KEPT


def _is_due(hello: Hello, step: int) -> bool:
    """Whether a client that wants fewer states wants that of a step."""
    return step % (RATES[0] // hello.rate) == 0
