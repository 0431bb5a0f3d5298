"""What a recording asks for that the robot cannot or must not do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nao_sim.motion import JointTrajectory
from nao_sim.robot import Array, Robot
from nao_sim.safety.coupling import coupling_excess
from nao_sim.safety.position import limit_excess
from nao_sim.safety.trajectory_distance import smallest_distances

TOLERANCE = 1e-4  # rad: the documented limits are printed to four digits


@dataclass(frozen=True)
class Assessment:
    """Frames of the recording that ask for something forbidden.

    Attributes:
        limit_frames: a joint beyond its documented limit.
        coupling_frames: a joint beyond the limit that another joint sets.
        speed_frames: a joint faster, from the frame before, than its motor's no-load speed.
        self_collision_frames: parts of the robot in each other.
        nonfinite_frames: a given joint with a value that is not a number.
    """

    limit_frames: int
    coupling_frames: int
    speed_frames: int
    self_collision_frames: int
    nonfinite_frames: int


def assess(
    motion: JointTrajectory, robot: Robot, start: Array, progress: Callable[[int, int], None] | None = None
) -> Assessment:
    """Count the frames of a motion; what it does not ask for holds, from the `start` posture (26,) on.

    Args:
        motion: what is asked for.
        robot: whose limits count.
        start: (26,) the posture before the first frame.
        progress: called now and then with the frames done and the frames in all.
    """
    poses = held(motion.positions, start)
    speed = np.abs(np.diff(poses, axis=0)) / np.diff(motion.times)[:, None]
    couplings = [coupling_excess(coupling, poses) for coupling in robot.couplings]
    distances = smallest_distances(poses, horizon=0.0, progress=progress)  # only overlaps count
    return Assessment(
        limit_frames=int((limit_excess(robot, poses) > TOLERANCE).any(axis=1).sum()),
        coupling_frames=int((np.max(couplings, axis=0) > TOLERANCE).sum()),
        speed_frames=int((speed > robot.no_load_speed).any(axis=1).sum()),
        self_collision_frames=int((distances < 0.0).sum()),
        nonfinite_frames=int((~np.isfinite(motion.positions[:, motion.given])).any(axis=1).sum()),
    )


def held(positions: Array, start: Array) -> Array:
    """Positions (T, 26) with each value that is not finite replaced by the last finite one, or the start's (26,)."""
    rows = np.concatenate([start[None], positions])
    finite = np.isfinite(rows)
    latest = np.maximum.accumulate(np.where(finite, np.arange(len(rows))[:, None], 0), axis=0)
    return np.take_along_axis(rows, latest, axis=0)[1:]
