"""A rendering process: reads slot numbers from stdin, paints each slot's row into its pixels, answers with the number.

A row is what `Panels` paints: poses, what cameras that turn need, and what a `Tint` needs where there is one.
Slots lie in memory shared with the parent: first their rows (float64), then their pixels (height, width, 3) uint8.
Answers are JSON lines on what was stdout: `{"ready": pid}` once, `{"done": slot}` for each, `{"error": text}` last.
The process ends when stdin does, so it never outlives its parent.
"""

from __future__ import annotations

import json
import mmap
import os
import signal
import sys
import tempfile
from dataclasses import asdict, dataclass
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from nao_sim.errors import NaoSimError
from nao_sim.rendering.arrangements import View
from nao_sim.rendering.preset_kinds import Quality, Shadow
from nao_sim.rendering.tint import Tint


@dataclass(frozen=True)
class Order:
    """What a worker is started with.

    Attributes:
        model: path of the compiled model (.mjb).
        fd: descriptor of the shared memory.
        slots: number of slots in it.
        row: length of a row.
        size: (width, height) in pixels of a slot's picture.
        views: the parts of the picture, later ones over earlier ones.
        quality: what is drawn.
        shadow: the square that has shadows.
        tint: what may take colour, if anything.
    """

    model: str
    fd: int
    slots: int
    row: int
    size: tuple[int, int]
    views: tuple[View, ...]
    quality: Quality
    shadow: Shadow
    tint: Tint | None = None

    def to_json(self) -> str:
        """The order as a line of text."""
        return json.dumps(asdict(self))  # of which `from_json` of views and tint reads its parts

    @staticmethod
    def from_json(text: str) -> Order:
        """The order that `to_json` wrote."""
        row: dict[str, Any] = json.loads(text)
        return Order(
            **row
            | {
                "size": tuple(row["size"]),
                "views": tuple(map(View.from_json, row["views"])),
                "quality": Quality(**row["quality"]),
                "shadow": Shadow(**row["shadow"]),
                "tint": Tint.from_json(row["tint"]) if row["tint"] else None,
            }
        )


class Slots:
    """The shared memory, seen as rows and pictures.

    Attributes:
        rows: (slots, row) float64.
        pictures: (slots, height, width, 3) uint8.
    """

    def __init__(self, fd: int, slots: int, row: int, size: tuple[int, int]) -> None:
        self.rows: NDArray[np.float64]
        self.pictures: NDArray[np.uint8]
        memory = mmap.mmap(fd, self.length(slots, row, size))
        self.rows = np.frombuffer(memory, np.float64, slots * row).reshape(slots, row)
        width, height = size
        pixels = np.frombuffer(memory, np.uint8, slots * width * height * 3, offset=self.rows.nbytes)
        self.pictures = pixels.reshape(slots, height, width, 3)

    @staticmethod
    def length(slots: int, row: int, size: tuple[int, int]) -> int:
        """Bytes that the slots take."""
        return slots * (row * 8 + size[0] * size[1] * 3)


def shared_memory(length: int) -> int:
    """A descriptor of memory that vanishes with the last process that holds it."""
    if hasattr(os, "memfd_create"):
        fd = os.memfd_create("nao_sim")
    else:
        with tempfile.TemporaryFile() as file:
            fd = os.dup(file.fileno())
    os.ftruncate(fd, length)
    return fd


def serve(order: Order, requests: TextIO, answers: TextIO) -> None:
    """Paint every slot that `requests` names until it ends."""
    from nao_sim.rendering.panels import Panels

    slots = Slots(order.fd, order.slots, order.row, order.size)
    panels = Panels(order.model, order.size, order.views, order.quality, order.shadow, order.tint)
    _answer(answers, ready=os.getpid())
    for line in requests:
        slot = int(line)
        panels.paint(slots.rows[slot], slots.pictures[slot])
        _answer(answers, done=slot)


def main() -> None:
    """Serve the order in the last argument; see the module's docstring."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides what an interrupt means
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what a driver prints is no answer
    status = 0
    try:
        serve(Order.from_json(sys.argv[-1]), sys.stdin, answers)
    except BrokenPipeError:
        status = 1
    except Exception as error:
        status = 1
        text = str(error) if isinstance(error, NaoSimError) else f"{type(error).__name__}: {error}"
        _answer(answers, error=text, usage=isinstance(error, NaoSimError))
    os._exit(status)  # some drivers crash in their exit handlers


def _answer(answers: TextIO, **message: Any) -> None:
    answers.write(json.dumps(message) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()
