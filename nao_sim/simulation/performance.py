"""A recording performed: every control step through the guard and the physics."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from nao_sim.motion import JointTrajectory
from nao_sim.robot import LEGS, STANDING_ACCELERATION, STANDING_SPEED, START_POSTURE, Array, load_robot
from nao_sim.safety.assessment import held
from nao_sim.safety.change import Intervention
from nao_sim.safety.guard import Guard
from nao_sim.safety.rules import ALL, Rules
from nao_sim.simulation.rollout import Rollout
from nao_sim.simulation.simulator import CONTROL_STEP, Simulator, State
from nao_sim.smooth_step import PEAK_ACCELERATION, PEAK_SPEED, minimum_jerk

APPROACH_SPEED = 1.0  # rad/s, of the fastest joint on its way to the recording's first pose
SHORTEST_APPROACH = 0.5  # s
SETTLE = 0.5  # s at the end, for the robot to arrive
Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class Performance:
    """A finished performance of T control steps.

    Attributes:
        rollout: what was asked, commanded and done.
        interventions: what the guard changed, (T,).
        states: what the robot did, (T,).
        safety_s: wall clock seconds in the guard.
        simulate_s: wall clock seconds in the physics.
    """

    rollout: Rollout
    interventions: list[Intervention]
    states: list[State]
    safety_s: float
    simulate_s: float

    @property
    def approach(self) -> float:
        """Seconds before the recording's first frame, spent on the way to it."""
        return self.rollout.motion_start


def perform(
    motion: JointTrajectory,
    simulator: Simulator,
    progress: Progress | None = None,
    *,
    rules: Rules = ALL,
) -> Performance:
    """Let the simulated robot perform a motion from its start posture.

    Args:
        motion: what to perform.
        simulator: a robot in its start posture.
        progress: called with the steps done and the steps in all.
        rules: which rules the guard keeps.
    """
    start = simulator.robot.postures[START_POSTURE]
    guard = Guard(simulator.robot, start, standing=simulator.map.free, rules=rules)
    approach, requested = timeline(motion, start)
    commands: list[Array] = []
    interventions: list[Intervention] = []
    states: list[State] = []
    safety_s = simulate_s = 0.0
    for step, request in enumerate(requested, 1):
        began = perf_counter()
        command, intervention = guard.step(request, CONTROL_STEP)
        guarded = perf_counter()
        states.append(simulator.step(command))
        safety_s, simulate_s = safety_s + guarded - began, simulate_s + perf_counter() - guarded
        commands.append(command)
        interventions.append(intervention)
        if progress:
            progress(step, len(requested))
    time = CONTROL_STEP * np.arange(1.0, len(requested) + 1.0)
    rollout = Rollout.of(time, requested, commands, states, motion_start=approach)
    return Performance(rollout, interventions, states, safety_s, simulate_s)


def timeline(motion: JointTrajectory, start: Array) -> tuple[float, Array]:
    """Requests (T, 26) at the control rate, with a smooth approach before and a rest after the motion.

    Returns:
        The approach's length (s) and the requests; not finite where nothing is asked.
    """
    first = held(motion.positions[:1], start)[0]
    approach = np.ceil(_approach(np.abs(first - start)) / CONTROL_STEP) * CONTROL_STEP
    steps = np.ceil((approach + motion.duration + SETTLE) / CONTROL_STEP - 1e-9)
    times = CONTROL_STEP * np.arange(1, int(steps) + 1) - approach
    requested = motion.sample(motion.times[0] + np.clip(times, 0.0, motion.duration))
    before = times < 0.0
    share = minimum_jerk(1.0 + times[before] / approach)[:, None]
    requested[before] = np.where(motion.given, start + share * (first - start), np.nan)
    return float(approach), requested


def _approach(way: Array) -> float:
    """Seconds for a way (26,) to the first pose; legs, on which the robot may stand, go it within their limits."""
    leg = float(way[load_robot().joints_of(*LEGS)].max())
    gently = max(PEAK_SPEED * leg / STANDING_SPEED, float(np.sqrt(PEAK_ACCELERATION * leg / STANDING_ACCELERATION)))
    return max(float(way.max()) / APPROACH_SPEED, gently, SHORTEST_APPROACH)
