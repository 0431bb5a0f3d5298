"""A process that keeps robots: `Inward` messages on its standard input, `Outward` ones on its standard output.

A guard's step takes a millisecond or more and holds Python's lock; robots in
processes of their own leave the server's loop free for sockets.  The process
ends when its input does.
"""

from __future__ import annotations

import os
import pickle
import select
import signal
import struct
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.host import Host, Outward
from nao_sim.live.moment import World
from nao_sim.safety.rules import ALL, Rules

LENGTH = struct.Struct("<I")
IDLE = 1.0  # s to wait for input where there is no robot
_CHUNK = 1 << 18


@dataclass(frozen=True)
class Orders:
    """What a process is told first.

    Attributes:
        robot: `v4`, `v5` or `v6`.
        vocabulary: the file with the gestures; the built-in ones where None.
        rules: what the guard keeps.
    """

    robot: str = "v5"
    vocabulary: Path | None = None
    rules: Rules = ALL


def world_of(orders: Orders) -> World:
    """What the robots of a process share.

    Raises:
        UsageError: the vocabulary cannot be read.
    """
    from nao_sim.gestures.storage import vocabulary_of
    from nao_sim.robot import load_robot
    from nao_sim.simulation.scene import compile_scene

    robot = load_robot(orders.robot)
    return World(robot, compile_scene(robot.version), vocabulary_of(orders.vocabulary), orders.rules)


def packed(values: Iterable[Any]) -> bytes:
    """Values, each with its length before it; between processes of this program alone."""
    texts = [pickle.dumps(value, pickle.HIGHEST_PROTOCOL) for value in values]
    return b"".join(LENGTH.pack(len(text)) + text for text in texts)


class Unpacker:
    """Takes bytes as they come and gives whole values; it has a state."""

    def __init__(self) -> None:
        self._rest = bytearray()

    def take(self, data: bytes) -> Iterator[Any]:
        """The values that are whole with these bytes."""
        self._rest += data
        while len(self._rest) >= LENGTH.size:
            end = LENGTH.size + LENGTH.unpack_from(self._rest)[0]
            if len(self._rest) < end:
                return
            value = pickle.loads(bytes(self._rest[LENGTH.size : end]))
            del self._rest[:end]
            yield value


def serve(host: Host, source: int, sink: int, unpacker: Unpacker, clock: Clock = monotonic) -> None:
    """Keep the robots of a host until the input, a file descriptor, ends."""
    while True:
        due = host.due
        wait = IDLE if due is None else max(due - clock(), 0.0)
        came = []
        if select.select([source], [], [], wait)[0]:
            data = os.read(source, _CHUNK)
            if not data:
                return
            came = list(unpacker.take(data))
        if came:
            _tell(sink, host.take(came, clock()))
        _tell(sink, host.step(clock(), lambda command: _tell(sink, [command])))


def _tell(sink: int, out: list[Outward]) -> None:
    if out:
        _write(sink, packed(out))


def _write(sink: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(sink, view) :]


def _first(source: int, unpacker: Unpacker) -> Orders | None:
    """What comes first; None where nothing does."""
    while data := os.read(source, _CHUNK):
        for orders in unpacker.take(data):
            return orders
    return None


def main() -> None:
    """Keep robots until the server ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server says when to end
    source, sink = 0, os.dup(1)
    os.dup2(2, 1)  # whatever prints must not come between messages
    unpacker = Unpacker()
    orders = _first(source, unpacker)
    if orders is None:
        return
    host = Host(world_of(orders))
    try:
        _write(sink, packed(["ready"]))
        serve(host, source, sink, unpacker)
    except BrokenPipeError:
        pass
    finally:
        host.close()


if __name__ == "__main__":
    main()
    sys.exit(0)
