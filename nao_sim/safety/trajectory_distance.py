"""Self-distance along a whole motion, on all cores where that is quicker."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import cache
from multiprocessing import get_context

import numpy as np

from nao_sim.processors import processors
from nao_sim.robot import Array
from nao_sim.safety.self_distance import HORIZON, SelfDistance

PIECE = 2000  # poses between two signs of progress
LONG = 20 * PIECE  # poses; fewer are done sooner than other processes have begun


def smallest_distances(
    poses: Array, horizon: float = HORIZON, progress: Callable[[int, int], None] | None = None
) -> Array:
    """Smallest distance (T,) m between parts of the robot at each of poses (T, 26), the horizon where all are farther.

    Args:
        poses: rad (hands 0..1), finite.
        horizon: m, up to which to look; the shorter, the quicker.
        progress: called now and then with the poses done and the poses in all.
    """
    distance = _distance(horizon)
    pieces = [(poses[i : i + PIECE], horizon) for i in range(0, len(poses), PIECE)]
    if len(poses) < LONG:
        return _collected((distance.smallest(piece) for piece, _ in pieces), len(poses), progress)
    # what is compiled is inherited; MuJoCo's calls for one pose are too short for threads to take turns at
    with forked(processors()) as pool:
        return _collected(pool.map(_piece, pieces), len(poses), progress)


@contextmanager
def forked(processes: int) -> Iterator[ProcessPoolExecutor]:
    """Copies of this process that work for it.

    They do not do what this one does when it is told to end: a copy that
    unwound the copied stack would remove files that it does not own.  So no
    signal reaches them before they have forgotten how this process takes it.
    """
    held = {signal.SIGTERM, signal.SIGINT}
    pool = ProcessPoolExecutor(processes, get_context("fork"), _die_alone, (held,))
    try:
        before = signal.pthread_sigmask(signal.SIG_BLOCK, held)
        try:
            pool.submit(os.getpid).result()  # the first task starts all of them
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)


def _die_alone(held: set[signal.Signals]) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all at once; the first process tells the others
    signal.pthread_sigmask(signal.SIG_UNBLOCK, held)


def _collected(parts: Iterable[Array], total: int, progress: Callable[[int, int], None] | None) -> Array:
    smallest, done = np.empty(total), 0
    for part in parts:
        smallest[done : done + len(part)] = part
        done += len(part)
        if progress:
            progress(done, total)
    return smallest


def _piece(task: tuple[Array, float]) -> Array:
    poses, horizon = task
    return _distance(horizon).smallest(poses)


@cache
def _distance(horizon: float) -> SelfDistance:
    return SelfDistance(horizon)
