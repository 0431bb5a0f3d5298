"""Single moments of a performance: which ones are worth a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nao_sim.errors import UsageError
from nao_sim.robot import Array

if TYPE_CHECKING:
    from nao_sim.simulation.rollout import Rollout


@dataclass(frozen=True)
class Moments:
    """Of what there are pictures instead of a film; exactly one of both is given.

    Attributes:
        at: s of the recording.
        key_poses: how many of the poses that differ most.
    """

    at: tuple[float, ...] = ()
    key_poses: int = 0

    def times(self, rollout: Rollout) -> Array:
        """Where in a rollout (N,) s they are, in the recording's order.

        Raises:
            UsageError: there is nothing of the recording at a moment.
        """
        moving = np.flatnonzero(rollout.time >= rollout.motion_start)
        if self.key_poses:
            return rollout.time[moving[key_poses(rollout.joint_positions[moving], self.key_poses)]]
        lasts = float(rollout.time[-1] - rollout.motion_start) * rollout.speed
        if late := [at for at in self.at if at > lasts + 1e-9]:
            raise UsageError(f"--at {late[0]:g}: after the end of the recording; expected 0 to {lasts:.2f} s")
        return rollout.motion_start + np.array(self.at) / rollout.speed


def key_poses(positions: Array, count: int) -> NDArray[np.int_]:
    """Which of poses (T, 26) differ most, in their order: each the farthest from those chosen before (Gonzalez 1985).

    The first is the one farthest from the pose in the middle of all; there are
    at most `count` and at most as many as there are different poses.
    """
    apart = np.linalg.norm(positions - np.median(positions, axis=0), axis=1)
    chosen = [int(apart.argmax())]
    nearest = np.linalg.norm(positions - positions[chosen[0]], axis=1)
    while len(chosen) < count and nearest.max() > 0.0:
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, np.linalg.norm(positions - positions[chosen[-1]], axis=1))
    return np.sort(chosen)
