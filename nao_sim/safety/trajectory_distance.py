"""Self-distance along a whole motion, on all cores where that is quicker."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from functools import cache
from multiprocessing import get_context

import numpy as np

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
    with get_context("fork").Pool(len(os.sched_getaffinity(0))) as pool:
        return _collected(pool.imap(_piece, pieces), len(poses), progress)


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
