"""Several robots in one process, each stepped when its time has come; no socket and no clock in here, either."""

from __future__ import annotations

import traceback
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from nao_sim.errors import UsageError
from nao_sim.live import outgoing
from nao_sim.live.clock import Beat
from nao_sim.live.moment import Command, World
from nao_sim.live.problem import LiveError
from nao_sim.live.protocol import Angles, Frame, Hello, Order, parse
from nao_sim.live.session import Session

BACKLOG = 4  # frames of one person that wait for their turn; the oldest are passed over
Kind = Literal["state", "command", "reply", "end"]
Data = str | bytes | Frame | Angles


@dataclass(frozen=True)
class Inward:
    """Something for a robot.

    Attributes:
        session: which robot.
        what: `open`, `message` or `close`.
        data: the message.
        came: s, when.
        hello: for `open`, what is wanted.
        record: for `open`, a file for what is received.
        joints: for `open`, what the points are, where they come from a recording that was read already.
    """

    session: str
    what: Literal["open", "message", "close"]
    data: Data = ""
    came: float = 0.0
    hello: Hello | None = None
    record: Path | None = None
    joints: tuple[str, ...] | None = None


@dataclass(frozen=True)
class Outward:
    """Something from a robot.

    Attributes:
        session: which robot.
        kind: `state` and `command` are for all who want them, `reply` for the person alone, `end` the last of a robot.
        text: the message.
        step: of which control step, for states.
    """

    session: str
    kind: Kind
    text: str
    step: int = 0


@dataclass
class _Seat:
    """A robot, its beat, and what waits for it."""

    session: Session
    beat: Beat
    waiting: deque[tuple[Data, float]] = field(default_factory=deque)
    told: bool = False  # whether the person knows how the numbers are taken


class Host:
    """Keeps several robots; it has a state.

    Args:
        world: what they share.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._seats: dict[str, _Seat] = {}

    def __len__(self) -> int:
        return len(self._seats)

    @property
    def due(self) -> float | None:
        """When (s) the next step is; None without robots."""
        return min((seat.beat.due for seat in self._seats.values()), default=None)

    def take(self, messages: Iterable[Inward], now: float) -> list[Outward]:
        """Take what came since the last call, and answer."""
        out: list[Outward] = []
        for message in messages:
            if message.what == "open":
                out += self._open(message, now)
            elif message.session in self._seats and message.what == "close":
                self._seats.pop(message.session).session.close()
            elif message.session in self._seats:
                self._seats[message.session].waiting.append((message.data, message.came))
        for name, seat in self._seats.items():
            out += self._read(name, seat)
        return out

    def _open(self, message: Inward, now: float) -> list[Outward]:
        """A new robot; or another source for one that is there, which goes on from where it stands."""
        assert message.hello is not None
        seat = self._seats.get(message.session)
        try:
            if seat is None:
                session = Session(self._world, message.hello, message.record, message.joints)
                self._seats[message.session] = _Seat(session, Beat(now))
            else:
                seat.session.adopt(message.hello, message.joints)
                seat.told = False
        except (LiveError, UsageError) as problem:
            told = problem if isinstance(problem, LiveError) else LiveError("cannot_record", str(problem))
            self._seats.pop(message.session, None)
            return [Outward(message.session, "end", outgoing.error(told, fatal=True))]
        return []

    def _read(self, name: str, seat: _Seat) -> Iterator[Outward]:
        """Hand over what waits; frames that newer ones have overtaken are passed over."""
        surplus = sum(_is_frame(data) for data, _ in seat.waiting) - BACKLOG
        while seat.waiting:
            data, came = seat.waiting.popleft()
            overtaken = surplus > 0 and _is_frame(data)
            surplus -= overtaken
            try:
                for reply in self._obey(seat, data, came, overtaken):
                    yield Outward(name, "reply", reply)
            except LiveError as problem:
                yield Outward(name, "reply", outgoing.error(problem))
            except Exception as failure:  # as in `step`
                traceback.print_exception(failure)
                seat.session.forget()
                yield Outward(name, "reply", outgoing.error(_internal(failure)))

    def _obey(self, seat: _Seat, data: Data, came: float, overtaken: bool) -> list[str]:
        message, session = parse(data) if isinstance(data, str | bytes) else data, seat.session
        if isinstance(message, Angles):
            session.receive_angles(message, came)
            return []
        if isinstance(message, Frame):
            session.pass_over(message) if overtaken else session.receive(message, came)
            return self._understood(seat)
        if isinstance(message, Hello):
            raise LiveError("twice", "a second hello; expected frames, or a config message")
        return self._order(session, message, came)

    @staticmethod
    def _understood(seat: _Seat) -> list[str]:
        if seat.told or seat.session.reader.understood is None:
            return []
        seat.told = True
        return [outgoing.text("understood", reason=seat.session.reader.understood)]

    @staticmethod
    def _order(session: Session, order: Order, now: float) -> list[str]:
        if order.what == "ping":
            return [outgoing.text("pong", echo=order.echo, server_time=now)]
        if order.what == "download":
            return outgoing.recording(*session.recording())
        if order.what == "config":
            session.configure(order.mode, order.mirror)
        elif order.what == "pause":
            session.pause(order.on)
        elif order.what == "record":
            session.record(order.on)
        elif order.what == "replay":
            session.replay(order.on, now)
        elif order.what == "reset":
            session.reset()
        return [outgoing.text("done", what=order.what, on=order.on)]

    def step(self, now: float, at_once: Callable[[Outward], None] | None = None) -> list[Outward]:
        """Step the robot that is most overdue, if any is due; others come next, after what came meanwhile.

        Args:
            now: s.
            at_once: told the command before the physics; it is the first of what is returned where None.
        """
        name = min(self._seats, key=lambda each: self._seats[each].beat.due, default=None)
        if name is None or not self._seats[name].beat.take(now):
            return []
        out: list[Outward] = []
        try:
            self._step_seat(name, self._seats[name], now, at_once or out.append, out)
        except Exception as failure:  # whatever it is, it must not end the other robots of this process
            traceback.print_exception(failure)
            self._seats.pop(name).session.close()
            out.append(Outward(name, "end", outgoing.error(_internal(failure), fatal=True)))
        return out

    def _step_seat(
        self, name: str, seat: _Seat, now: float, at_once: Callable[[Outward], None], out: list[Outward]
    ) -> None:
        def command(told: Command) -> None:
            at_once(Outward(name, "command", outgoing.command(told), told.step))

        seat.session.behind(seat.beat.slow(now))
        moment = seat.session.step(now, command)
        noticed = seat.session.noticed(moment)
        out.append(Outward(name, "state", outgoing.state(moment, noticed, self._world.robot), moment.step))

    def close(self) -> None:
        """End all robots."""
        for seat in self._seats.values():
            seat.session.close()
        self._seats.clear()


def _is_frame(data: Data) -> bool:
    """Whether a message is about to be a frame, without reading it."""
    return not isinstance(data, str) or '"points"' in data


def _internal(failure: Exception) -> LiveError:
    return LiveError("internal", f"this robot's program failed: {failure!r}; expected it to go on")
