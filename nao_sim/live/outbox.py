"""What waits to be sent to one client: whoever reads slowly gets fewer states, and keeps nobody waiting."""

from __future__ import annotations

import asyncio
from collections import deque

from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.problem import LiveError

MOST = 48 << 20  # characters of answers that wait; a recording is one
STUCK = 10.0  # s, after which a client that takes nothing is let go
COMMANDS = 5  # that wait for a robot; older ones say nothing any more


class Outbox:
    """Messages to one client; it has a state.

    Answers are all kept, in order.  Of states only the newest is, of commands the newest few.

    Args:
        clock: what time it is.

    Attributes:
        skipped: states and commands that were overtaken by newer ones.
    """

    def __init__(self, clock: Clock = monotonic) -> None:
        self._clock, self._since, self.skipped = clock, clock(), 0
        self._answers: deque[str] = deque()
        self._states: deque[str] = deque(maxlen=1)
        self._commands: deque[str] = deque(maxlen=COMMANDS)
        self._size, self._filled, self._ended = 0, asyncio.Event(), False

    def answer(self, text: str) -> None:
        """Send this for sure.

        Raises:
            LiveError: the client takes nothing.
        """
        self._size += len(text)
        if self._size > MOST:
            raise LiveError("not_reading", "answers are not read; expected them to be")
        self._put(self._answers, text)

    def state(self, text: str) -> None:
        """Send this unless a newer one comes before."""
        self._put(self._states, text)

    def command(self, text: str) -> None:
        """Send this unless several newer ones come before."""
        self._put(self._commands, text)

    def _put(self, queue: deque[str], text: str) -> None:
        if not self._filled.is_set():
            self._since = self._clock()
        self.skipped += queue.maxlen is not None and len(queue) == queue.maxlen
        queue.append(text)
        self._filled.set()

    def end(self) -> None:
        """Send what waits, and nothing after that."""
        self._ended = True
        self._filled.set()

    @property
    def stuck(self) -> bool:
        """Whether something has waited for too long."""
        return self._filled.is_set() and self._clock() - self._since > STUCK

    async def next(self) -> str | None:
        """The next message; None at the end."""
        while True:
            for queue in (self._answers, self._commands, self._states):
                if queue:
                    text = queue.popleft()
                    self._size -= len(text) if queue is self._answers else 0
                    self._since = self._clock()
                    return text
            if self._ended:
                return None
            self._filled.clear()
            await self._filled.wait()
