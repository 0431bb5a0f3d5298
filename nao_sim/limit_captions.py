"""Which joints are at their limits, written into the film."""

from __future__ import annotations

import numpy as np

from nao_sim.fading import shown
from nao_sim.rendering.arrangements import load_limits
from nao_sim.rendering.captions import Label
from nao_sim.robot import START_POSTURE, Array, Coupling, Mask, Robot
from nao_sim.safety.coupling import MARGIN_RAD as COUPLING_MARGIN_RAD
from nao_sim.safety.position import command_bounds

_RESTS = 0.01  # rad; a joint that moves less in a whole run was never told to


class LimitCaptions:
    """Tells which joints of a run are at their limits, and when: commands end a little inside the documented limit.

    Hands are left out, which close and open fully as a matter of course, and joints that nobody moves.  A limit that
    another joint sets counts where it is the nearer one.

    Args:
        robot: whose limits count.

    Attributes:
        labels: every caption that may occur.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot, self._looks = robot, load_limits()
        words = at_limits(robot, robot.postures[START_POSTURE][None], 0.0)
        self.labels = tuple(Label(word, self._looks.dot) for word in words)

    def at(self, times: Array, commands: Array, step_times: Array) -> Array:
        """Opacities (N, labels), 0 or 1; at most as many captions at a time as the table allows.

        Args:
            times: (N,) s, of the frames.
            commands: (T, 26) rad, what the guard let through.
            step_times: (T,) s, when.
        """
        active = np.stack(list(at_limits(self._robot, commands, np.radians(self._looks.within_deg)).values()), axis=1)
        seen = shown(active.astype(np.float64), times, step_times, self._looks.hold, 0.0) > 0.0
        return (seen & (np.cumsum(seen, axis=1) <= self._looks.most)).astype(np.float64)


def at_limits(robot: Robot, commands: Array, within: float) -> dict[str, Mask]:
    """In which steps (T,) each joint is at each of its limits, by what is said of it.

    Args:
        robot: whose limits count.
        commands: (T, 26) rad.
        within: rad; nearer than this to where commands end is at the limit.
    """
    moves = np.ptp(commands, axis=0) > _RESTS
    lowest, highest = command_bounds(robot)
    found: dict[str, Mask] = {}
    for joint in np.flatnonzero(~robot.is_hand):
        name, angles = robot.joint_names[joint], commands[:, joint]
        low, high = angles <= lowest[joint] + within, angles >= highest[joint] - within
        found[f"{name} at its limit {_degrees(robot.lower[joint])}"] = low & moves[joint]
        found[f"{name} at its limit {_degrees(robot.upper[joint])}"] = high & moves[joint]
    for coupling in robot.couplings:
        words = f"{robot.joint_names[coupling.joint]} at the limit that {robot.joint_names[coupling.by]} sets"
        found[words] = _at_coupling(coupling, robot, commands, within) & moves[coupling.joint]
    return found


def _at_coupling(coupling: Coupling, robot: Robot, commands: Array, within: float) -> Mask:
    """In which steps (T,) a joint is at a limit that is narrower than its own because of another joint."""
    lower, upper = coupling.bounds(commands[:, coupling.by])
    angles, joint = commands[:, coupling.joint], coupling.joint
    within += COUPLING_MARGIN_RAD
    low = (lower > robot.lower[joint] + within) & (angles <= lower + within)
    return np.asarray(low | (upper < robot.upper[joint] - within) & (angles >= upper - within))


def _degrees(limit: float) -> str:
    return f"{np.degrees(limit):.1f}°"
