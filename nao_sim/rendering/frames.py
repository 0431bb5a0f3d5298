"""Rows in, pictures out, in order: worker processes paint into shared memory while the parent uses the pictures."""

from __future__ import annotations

import json
import os
import selectors
import subprocess
import sys
import tempfile
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nao_sim.errors import RenderingError, UsageError
from nao_sim.processors import processors
from nao_sim.rendering.arrangements import View
from nao_sim.rendering.backend import Backend, exit_reason, gl_environment, last_line
from nao_sim.rendering.presets import load_camera, load_quality, load_shadow
from nao_sim.rendering.worker import Order, Slots, shared_memory

if TYPE_CHECKING:
    import mujoco

    from nao_sim.rendering.tint import Tint

MAX_WORKERS = 8
_QUEUE = 2  # rows that wait or are painted at one worker
_TIMEOUT_S = 120.0  # a worker that says nothing for so long hangs
_BOOT = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from nao_sim.rendering.worker import main; main()"


class Window:
    """Which slot holds which job: jobs start in order, finish in any order, and are delivered in order.

    Args:
        slots: how many jobs may be under way or undelivered at a time.
    """

    def __init__(self, slots: int) -> None:
        self._free = deque(range(slots))
        self._line: deque[int] = deque()
        self._finished: set[int] = set()

    def is_full(self) -> bool:
        """True while no slot is free."""
        return not self._free

    def start(self) -> int:
        """The slot for the next job; one must be free."""
        self._line.append(self._free.popleft())
        return self._line[-1]

    def finish(self, slot: int) -> None:
        """The job in `slot` is done."""
        self._finished.add(slot)

    def head(self) -> int | None:
        """The slot of the oldest undelivered job, or None while it is not done."""
        return self._line[0] if self._line and self._line[0] in self._finished else None

    def deliver(self) -> None:
        """The job at the head was used; its slot is free again."""
        slot = self._line.popleft()
        self._finished.remove(slot)
        self._free.append(slot)


@dataclass
class _Worker:
    """A worker process as the parent sees it."""

    process: subprocess.Popen[bytes]
    complaints: IO[bytes]
    waiting: int = 0
    ready: bool = False
    unread: bytes = b""

    def ask(self, slot: int) -> None:
        assert self.process.stdin is not None
        try:
            self.process.stdin.write(b"%d\n" % slot)
            self.process.stdin.flush()
        except BrokenPipeError:
            raise self.obituary() from None
        self.waiting += 1

    @property
    def answers_fd(self) -> int:
        """The descriptor on which it answers."""
        assert self.process.stdout is not None
        return self.process.stdout.fileno()

    def answers(self) -> list[dict[str, Any]]:
        """What it said since the last call; blocks until it says something."""
        chunk = os.read(self.answers_fd, 65536)
        if not chunk:
            raise self.obituary()
        *lines, self.unread = (self.unread + chunk).split(b"\n")
        return [json.loads(line) for line in lines]

    def obituary(self) -> RenderingError:
        """Why it died, in one line."""
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(2.0)
        status = self.process.returncode
        self.complaints.seek(0)
        said = last_line(self.complaints.read().decode(errors="replace"))
        return RenderingError(f"a rendering process died ({exit_reason(status)}){': ' + said if said else ''}")

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout, self.complaints):
            with suppress(BrokenPipeError):  # a request it never read
                if pipe is not None:
                    pipe.close()


def default_workers(backend: Backend, frames: int) -> int:
    """How many processes to render with: one a processor with software OpenGL, one with a GPU."""
    most = min(processors(), MAX_WORKERS) if backend.is_software else 1
    return max(1, min(most, frames // 8))  # starting one takes as long as painting about eight frames


class Pool:
    """Worker processes that paint one model; use it in a `with` block.

    Args:
        model: any model; the workers get copies.
        size: (width, height) in pixels of the finished picture.
        camera: name of a camera preset, or the parts of the picture.
        quality: name of a quality preset.
        backend: what renders.
        workers: number of processes.
        tint: what may take colour, if anything.

    Attributes:
        backend: what renders.
        workers: number of processes.
        views: the parts of the picture, later ones over earlier ones.
        quality: the quality.
        nq: numbers of a pose.
        painted_size: (width, height) in pixels of the pictures that `paint` gives, supersampled.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        size: tuple[int, int],
        camera: str | tuple[View, ...],
        quality: str,
        backend: Backend,
        workers: int,
        tint: Tint | None = None,
    ) -> None:
        self.backend, self.workers = backend, workers
        self.views = (View(load_camera(camera)),) if isinstance(camera, str) else camera
        self.quality, self.nq = load_quality(quality), model.nq
        width, height = size
        self.painted_size = round(width * self.quality.supersample), round(height * self.quality.supersample)
        self._window = Window(workers * _QUEUE + 2)
        self._selector = selectors.DefaultSelector()
        self._workers: list[_Worker] = []
        self._folder = tempfile.TemporaryDirectory(prefix="nao_sim-")
        try:
            self._start(model, backend, workers, tint)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Pool:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the workers and remove what they shared."""
        self._selector.close()
        for worker in self._workers:
            worker.end()
        self._folder.cleanup()

    def paint(self, rows: Iterable[NDArray[np.float64]]) -> Iterator[NDArray[np.uint8]]:
        """Paint rows: a pose (nq,) for each view, then the numbers of each view's camera, then those of the tint.

        Gives pictures (height, width, 3) in the rows' order, each valid until the next.

        Raises:
            RenderingError: a worker died, failed or hangs.
            UsageError: the camera is not in the model.
        """
        todo = iter(rows)
        exhausted, under_way = False, 0
        while True:
            while not exhausted and (idle := self._idle()) and (slot := self._start_job(todo)) is not None:
                exhausted = slot < 0
                if not exhausted:
                    idle.ask(slot)
                    under_way += 1
            if not under_way:
                return
            head = self._window.head()
            if head is None:
                self._listen(_TIMEOUT_S)
                continue
            self._listen(0.0)
            yield self._slots.pictures[head]
            self._window.deliver()
            under_way -= 1

    def _start_job(self, todo: Iterator[NDArray[np.float64]]) -> int | None:
        """Put the next row into a slot: its number, -1 at the end of the rows, None while no slot is free."""
        if self._window.is_full():
            return None
        row = next(todo, None)
        if row is None:
            return -1
        slot = self._window.start()
        self._slots.rows[slot] = row
        return slot

    def _idle(self) -> _Worker | None:
        """The worker with the least to do, or None where all have enough."""
        worker = min(self._workers, key=lambda worker: worker.waiting)
        return worker if worker.waiting < _QUEUE else None

    def _listen(self, timeout: float) -> None:
        """Take in the workers' answers."""
        ready = self._selector.select(timeout)
        if timeout and not ready:
            raise RenderingError(f"the rendering processes said nothing for {timeout:.0f} s")
        for key, _ in ready:
            for answer in key.data.answers():
                self._take(key.data, answer)

    def _take(self, worker: _Worker, answer: dict[str, Any]) -> None:
        if "error" in answer:
            raise (UsageError if answer["usage"] else RenderingError)(answer["error"])
        if "ready" in answer:
            worker.ready = True
            if all(each.ready for each in self._workers):
                self._folder.cleanup()  # all have read the model
        if "done" in answer:
            worker.waiting -= 1
            self._window.finish(answer["done"])

    def _start(self, model: mujoco.MjModel, backend: Backend, workers: int, tint: Tint | None) -> None:
        import mujoco

        path = Path(self._folder.name) / "model.mjb"
        mujoco.mj_saveModel(model, str(path), None)
        slots, size = workers * _QUEUE + 2, self.painted_size
        row = sum(self.nq + view.camera.width for view in self.views) + (tint.width if tint else 0)
        fd = shared_memory(Slots.length(slots, row, size))
        try:
            self._slots = Slots(fd, slots, row, size)
            order = Order(str(path), fd, slots, row, size, self.views, self.quality, load_shadow(), tint)
            for _ in range(workers):
                worker = _spawn(order, backend)
                self._workers.append(worker)
                self._selector.register(worker.answers_fd, selectors.EVENT_READ, worker)
        finally:
            os.close(fd)


def _spawn(order: Order, backend: Backend) -> _Worker:
    complaints = tempfile.TemporaryFile()  # noqa: SIM115  # lives as long as the worker
    process = subprocess.Popen(
        [sys.executable, "-c", _BOOT, json.dumps(sys.path), order.to_json()],
        env=gl_environment(backend.name, LP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1"),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=complaints,
        pass_fds=(order.fd,),
    )
    return _Worker(process, complaints)
